# SPDX-License-Identifier: GPL-3.0-or-later
"""Times whole stills of the open scene: blender -b FILE --python still.py -- ENGINE OUT.json

ENGINE is PENUMBRA, EEVEE or CYCLES. Each is set up as fast as it goes at its number of samples. Writes, in seconds, the
wall and processor time of bpy.ops.render.render(): `first` of a new process and `second` after it. EEVEE and Cycles
warm up with a single sample instead, which loads and compiles what the second needs."""
import json
import sys
import time

import bpy

SAMPLES = {"PENUMBRA": 4, "EEVEE": 64, "CYCLES": 16}
MAP_SIZE = 1024


def set_up_penumbra(scene):
    scene.render.engine = "PENUMBRA"
    scene.penumbra.technique, scene.penumbra.shadow_map_size = "PCSS", MAP_SIZE


def set_up_eevee(scene):
    engines = [item.identifier for item in scene.render.bl_rna.properties["engine"].enum_items]
    scene.render.engine = "BLENDER_EEVEE_NEXT" if "BLENDER_EEVEE_NEXT" in engines else "BLENDER_EEVEE"
    settings = {"use_soft_shadows": True, "shadow_cube_size": str(MAP_SIZE), "shadow_cascade_size": str(MAP_SIZE)}
    for name, value in settings.items():
        if hasattr(scene.eevee, name):
            setattr(scene.eevee, name, value)


def set_up_cycles(scene):
    """Direct light only, and nothing after it: no bounces, no adaptive sampling, no denoising."""
    scene.render.engine = "CYCLES"
    settings = {"device": "CPU", "max_bounces": 0, "use_adaptive_sampling": False, "use_denoising": False}
    for name, value in settings.items():
        setattr(scene.cycles, name, value)


def set_samples(scene, engine, samples):
    owner, name = {"PENUMBRA": ("penumbra", "samples"), "EEVEE": ("eevee", "taa_render_samples"),
                   "CYCLES": ("cycles", "samples")}[engine]
    setattr(getattr(scene, owner), name, samples)


class Stages:
    """Seconds spent in some functions of the add-on."""

    def __init__(self):
        engine = next(c for c in bpy.types.RenderEngine.__subclasses__() if c.bl_idname == "PENUMBRA")
        module = sys.modules[engine.__module__]
        self.seconds = {}
        self._watch("export", module.export.SceneExport, "__init__")
        self._watch("library", engine, "_wait")
        self._watch("result", module.passes, "fill_layer")

    def _watch(self, stage, owner, name):
        function = getattr(owner, name)

        def timed(*arguments):
            start = time.perf_counter()
            try:
                return function(*arguments)
            finally:
                self.seconds[stage] = self.seconds.get(stage, 0) + time.perf_counter() - start
        setattr(owner, name, timed)


def render():
    wall, processor = time.perf_counter(), time.process_time()
    if bpy.ops.render.render() != {"FINISHED"}:
        raise SystemExit("the render did not finish")
    return {"wall": time.perf_counter() - wall, "processor": time.process_time() - processor}


def main():
    engine, path = sys.argv[sys.argv.index("--") + 1:]
    scene = bpy.context.scene
    {"PENUMBRA": set_up_penumbra, "EEVEE": set_up_eevee, "CYCLES": set_up_cycles}[engine](scene)
    set_samples(scene, engine, SAMPLES[engine] if engine == "PENUMBRA" else 1)
    first = render()
    set_samples(scene, engine, SAMPLES[engine])
    stages = Stages() if engine == "PENUMBRA" else None
    result = {"second": render()}
    if stages:
        result.update(first=first, stages=stages.seconds)
    with open(path, "w", encoding="ascii") as file:
        json.dump(result, file)


main()
