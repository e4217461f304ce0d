# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender (CONTRIBUTING.md says how): does what a long day does, and looks at the memory of the process. An
argument of 0.1 does a tenth of it."""

import os
import random
import sys
import threading
import time

import addon_utils
import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from harness import ADDON, add_camera, add_cube, add_light, add_plane, output, white_material  # noqa: E402

# Memory of the first rounds goes to caches; from then on it may grow by so much.
WARM_UP, GROWTH = 0.2, 0.02


def resident_bytes():
    with open('/proc/self/statm', encoding='ascii') as file:
        return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE')


def build():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.engine = 'PENUMBRA'
    scene.render.resolution_x, scene.render.resolution_y = 160, 90
    scene.penumbra.samples = 2
    material = white_material()
    add_plane().data.materials.append(material)
    for number in range(10):
        add_cube(f"Cube {number}", location=(number - 5, 0, 0.5), half=0.3).data.materials.append(material)
    add_light("Key", 'AREA', size=0.5)
    add_light("Sun", 'SUN', energy=1, rotation=(0.5, 0.2, 0))
    add_camera(location=(0, 0, 9))
    return scene


def toggle(_number):
    addon_utils.disable(ADDON)
    if addon_utils.enable(ADDON) is None:
        raise RuntimeError("the add-on cannot be enabled again")


def render(_number):
    bpy.ops.render.render()


def reload(_number):
    bpy.ops.wm.open_mainfile(filepath=output("soak.blend"))
    bpy.ops.render.render()


_numbers = random.Random(1)


_latencies = []


def cancel(_number):
    """Ends a render, which would take a minute, at a random moment: the test answers for the user."""
    engine = sys.modules[ADDON].engine.PenumbraEngine
    before, moment = engine.is_cancelled, time.monotonic() + _numbers.random() * 0.4
    engine.is_cancelled = lambda _self: time.monotonic() > moment
    bpy.context.scene.penumbra.samples = 4096
    try:
        bpy.ops.render.render()
    finally:
        engine.is_cancelled = before
        bpy.context.scene.penumbra.samples = 2
    _latencies.append(1000.0 * (time.monotonic() - moment))
    if _latencies[-1] > 2000.0:
        raise RuntimeError(f"a render was cancelled after {_latencies[-1]:.0f} ms")


def repeat(name, count, action):
    """Growth of the memory after the warm-up, as a share."""
    start, before = time.perf_counter(), 0
    for number in range(count):
        action(number)
        if number == int(count * WARM_UP):
            before = resident_bytes()
    growth = resident_bytes() / before - 1.0
    verdict = 'ok    ' if growth <= GROWTH else 'FAILED'
    print(f"SOAK {verdict} {name}: {count} times, memory {growth:+.2%} of {before / 2 ** 20:.0f} MiB, "
          f"{threading.active_count()} threads, {time.perf_counter() - start:.0f} s", flush=True)
    return growth <= GROWTH


def main():
    arguments = sys.argv[sys.argv.index('--') + 1:]
    scale = float(arguments[0]) if arguments else 1.0
    if addon_utils.enable(ADDON, default_set=True) is None:
        sys.exit("the add-on cannot be enabled")
    build()
    bpy.ops.wm.save_as_mainfile(filepath=output("soak.blend"))
    rounds = (("disable and enable", 50, toggle), ("F12", 200, render), ("reload and F12", 100, reload),
              ("cancel", 50, cancel))
    results = [repeat(name, max(int(count * scale), 10), action) for name, count, action in rounds]
    _latencies.sort()
    median, longest = _latencies[len(_latencies) // 2], _latencies[-1]
    print(f"SOAK        from cancel to end: median {median:.0f} ms, longest {longest:.0f} ms")
    print(f"{sum(results)} passed, {len(results) - sum(results)} failed", flush=True)
    sys.exit(not all(results))


main()
