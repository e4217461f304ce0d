# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene whose whole still is timed: blender -b --factory-startup --python scene.py -- OUT.blend

About 40,000 triangles, one rectangular area light, diffuse surfaces, no ambient light."""
import math
import os
import sys

import bpy

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), *[os.pardir] * 3, "samples", "scenes"))
import shapes as s  # noqa: E402
from shapes import place, transform  # noqa: E402


def diffuse(name, color):
    """A plain Diffuse BSDF: the cheapest surface of every engine."""
    mat = bpy.data.materials.new(name)
    mat.use_nodes = True
    nodes = mat.node_tree.nodes
    nodes.remove(nodes["Principled BSDF"])
    shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1)
    mat.node_tree.links.new(shader.outputs[0], nodes["Material Output"].inputs["Surface"])
    return mat


def knot(mat):
    """A trefoil."""
    points = []
    for i in range(241):
        t = 2 * math.pi * i / 240
        r = 2 + math.cos(3 * t)
        points.append((0.2 * r * math.cos(2 * t), 0.2 * r * math.sin(2 * t), 0.2 * math.sin(3 * t)))
    return s.tube_mesh("knot", points, 0.07, mat, 20)


def vase(mat):
    outline = s.spline([(0.16, 0, 0), (0.3, 0, 0.2), (0.32, 0, 0.45), (0.16, 0, 0.75), (0.12, 0, 0.9), (0.2, 0, 1.05)],
                       10)
    profile = [(0, 0)] + [(p.x, p.z) for p in outline]
    return s.lathe_mesh("vase", profile, mat, 72, 180, lambda turn, step: 1 + 0.05 * math.cos(9 * turn + 0.1 * step))


def ball(mat):
    steps = 40
    turns = [math.pi * i / steps for i in range(steps + 1)]
    profile = [(0 if t in (turns[0], turns[-1]) else math.sin(t), -math.cos(t)) for t in turns]
    return s.lathe_mesh("ball", profile, mat, 80, 180)


def build():
    white, red = diffuse("white", (0.8, 0.8, 0.8)), diffuse("red", (0.7, 0.2, 0.15))
    blue, ochre = diffuse("blue", (0.15, 0.3, 0.6)), diffuse("ochre", (0.75, 0.55, 0.2))
    place("Floor", s.grid_mesh("floor", (16, 16), (1, 1), white))
    place("Wall", s.grid_mesh("wall", (16, 8), (1, 1), white), transform((0, 2.4, 4), (90, 0, 0)))
    place("Knot", knot(red), transform((-1.7, -0.2, 0.75), (70, 10, 30)))
    place("High Knot", knot(blue), transform((0.7, 0.4, 1.9), (20, 30, 0), 0.8))
    place("Vase", vase(ochre), transform((1.3, -0.5, 0)))
    place("Low Ball", ball(blue), transform((-0.3, -1.1, 0.35), scale=0.35))
    place("High Ball", ball(red), transform((-0.8, 0.7, 1.9), scale=0.25))
    column = s.tube_mesh("column", [(0, 0, 0), (0, 0, 2.6)], 0.08, white, 24)
    for i in range(12):
        place("Column", column, transform((-3.3 + 0.6 * i, 1.7, 0)))
    box = s.box_mesh("box", (0.16, 0.16, 0.5), ochre)
    for i in range(30):
        place("Box", box, transform((-3.4 + 0.23 * i, -1.9 + 0.35 * math.sin(1.7 * i), 0), (0, 0, 37 * i)))
    s.area_light("Light", s.aim((2.2, -3.2, 4.6), (0, 0.2, 0.4)), 500, (1.2, 0.8))
    s.world((0, 0, 0))
    s.camera((0.3, -7.0, 3.0), (0, 0, 0.75), 38)


def main():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    build()
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = 1280, 720, 100
    bpy.ops.wm.save_as_mainfile(filepath=sys.argv[sys.argv.index("--") + 1], compress=True)


if __name__ == "__main__":
    main()
