# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the open truth scene with one engine, shadowed and unshadowed.

    blender -b NAME.blend --python-exit-code 1 --python render.py -- ENGINE SAMPLES PREFIX

ENGINE is CYCLES, EEVEE or PENUMBRA. SAMPLES is per pixel, for PENUMBRA the N of N x N light samples. Writes
PREFIX.shadowed.exr, PREFIX.unshadowed.exr (PENUMBRA: PREFIX.passes.exr with a Shadow pass, and PREFIX.pnb)
and PREFIX.json with the wall time in seconds of the shadowed render, the second of two so that nothing is compiled or
loaded in it."""
import json
import os
import sys
import time

import bpy

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
import cycles_settings  # noqa: E402


def set_up_output(scene, layers):
    """Uncompressed 32-bit floats: what exr.py reads."""
    settings = scene.render.image_settings
    if layers and hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format = "OPEN_EXR_MULTILAYER" if layers else "OPEN_EXR"
    settings.color_depth, settings.exr_codec = "32", "NONE"
    if not layers:
        settings.color_mode = "RGB"
    scene.render.use_file_extension = False


def set_up_cycles(scene, samples):
    scene.render.engine = "CYCLES"
    for name, value in {**cycles_settings.SETTINGS, "samples": samples}.items():
        if hasattr(scene.cycles, name):
            setattr(scene.cycles, name, value)
    for light in bpy.data.lights:
        light.cycles.use_multiple_importance_sampling = cycles_settings.USE_MULTIPLE_IMPORTANCE_SAMPLING


def set_up_eevee(scene, samples):
    """EEVEE's best shadow settings; names that a version lacks are its own affair."""
    engines = [e.identifier for e in scene.render.bl_rna.properties["engine"].enum_items]
    scene.render.engine = "BLENDER_EEVEE_NEXT" if "BLENDER_EEVEE_NEXT" in engines else "BLENDER_EEVEE"
    scene.render.filter_size = 0.01
    settings = {"taa_render_samples": samples, "use_soft_shadows": True, "use_shadow_high_bitdepth": True,
                "light_threshold": 0.0001, "shadow_cube_size": "4096", "shadow_cascade_size": "4096"}
    for name, value in settings.items():
        if hasattr(scene.eevee, name):
            setattr(scene.eevee, name, value)
    for light in bpy.data.lights:
        if hasattr(light, "shadow_cascade_max_distance"):
            light.shadow_cascade_max_distance = 25.0  # the scenes' extent, instead of 200 m


def set_up_penumbra(scene, samples):
    scene.render.engine = "PENUMBRA"
    scene.penumbra.technique, scene.penumbra.samples, scene.penumbra.light_samples = "REFERENCE", 1, samples
    bpy.context.view_layer.use_pass_shadow = True


def cast_shadows(on):
    for light in bpy.data.lights:
        light.use_shadow = on
        if hasattr(light.cycles, "cast_shadow"):
            light.cycles.cast_shadow = on


def render(scene, path):
    scene.render.filepath = path
    start = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    return time.perf_counter() - start


def main():
    engine, samples, prefix = sys.argv[sys.argv.index("--") + 1:]
    scene = bpy.context.scene
    set_up = {"CYCLES": set_up_cycles, "EEVEE": set_up_eevee, "PENUMBRA": set_up_penumbra}[engine]
    set_up(scene, int(samples))
    set_up_output(scene, engine == "PENUMBRA")
    if engine == "PENUMBRA":
        os.environ["PENUMBRA_CAPTURE"] = prefix + ".pnb"
        render(scene, prefix + ".passes.exr")
        del os.environ["PENUMBRA_CAPTURE"]
        seconds = render(scene, prefix + ".passes.exr")
    else:
        cast_shadows(False)
        render(scene, prefix + ".unshadowed.exr")
        cast_shadows(True)
        if engine == "EEVEE":
            render(scene, prefix + ".shadowed.exr")
        seconds = render(scene, prefix + ".shadowed.exr")
    with open(prefix + ".json", "w", encoding="ascii") as file:
        json.dump({"seconds": seconds}, file)


if __name__ == "__main__":
    main()
