# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds a sample scene: blender -b --factory-startup --python samples/scenes/build.py -- NAME OUT.blend"""
import importlib
import os
import sys

import bpy

FOLDER = os.path.dirname(os.path.abspath(__file__))
SCENES = ("still_life", "fence_garden", "interior")


def build(name):
    """Replaces the open file by the scene."""
    if name not in SCENES:
        raise SystemExit(f"unknown scene '{name}'; there are: {', '.join(SCENES)}")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.name = name
    scene.render.resolution_x, scene.render.resolution_y = 1280, 720
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    if FOLDER not in sys.path:
        sys.path.append(FOLDER)
    importlib.import_module(name).build()


def count_triangles():
    depsgraph = bpy.context.evaluated_depsgraph_get()
    total = 0
    for instance in depsgraph.object_instances:
        if instance.object.type == "MESH":
            mesh = instance.object.data
            mesh.calc_loop_triangles()
            total += len(mesh.loop_triangles)
    return total


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    if len(arguments) != 2:
        raise SystemExit(f"usage: ... -- NAME OUT.blend; scenes: {', '.join(SCENES)}")
    build(arguments[0])
    # A compressed file loads in the same time and is a tenth of the size.
    bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(arguments[1]), compress=True)
    print(f"{arguments[1]}: {len(bpy.data.objects)} objects, {count_triangles()} triangles")


if __name__ == "__main__":
    main()
