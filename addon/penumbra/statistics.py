# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last finished render cost: per pass, in memory, and by which OpenGL."""

from ctypes import byref
from typing import NamedTuple

from . import capi


class Pass(NamedTuple):
    name: str
    count: int
    gpu_ms: float
    cpu_ms: float
    megabytes: float


class Statistics(NamedTuple):
    what: str           # "Viewport" or "Still", and its technique
    size: tuple
    samples: int
    triangles: int
    lights: int
    passes: tuple
    renderer: str       # OpenGL's name, and by which backend

    def megabytes(self):
        return sum(item.megabytes for item in self.passes)

    def milliseconds(self):
        return sum(item.gpu_ms for item in self.passes)


last = None     # Statistics, or None before the first render


def record(what, exported, values, timings, context):
    global last
    info = capi.ContextInfo()
    capi.library().context_get_info(context, byref(info))
    passes = tuple(Pass(timing.name.decode(errors='replace'), timing.count, timing.gpu_ms, timing.cpu_ms,
                        timing.bytes / 2 ** 20) for timing in timings)
    last = Statistics(f"{what}, {values.technique.decode()}", tuple(values.crop[2:]), values.samples,
                      exported.triangle_count, exported.scene.light_count, passes,
                      f"{info.renderer.decode(errors='replace')} by {info.backend.decode()}")
