# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes for ground truth: one white room corner each, every light type and shape, varied occluders.

    blender -b --factory-startup --python tests/quality/truth/scenes.py -- FOLDER [NAME ...]

writes FOLDER/NAME.blend and FOLDER/NAME.key, a hash of all that the picture depends on."""
import hashlib
import math
import os
import sys

import bmesh
import bpy
from mathutils import Matrix

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), *[os.pardir] * 3, "samples", "scenes"))
import shapes as s  # noqa: E402
from shapes import place, transform  # noqa: E402


def white():
    """A Lambertian white: the ratio of two renders is then the visibility itself."""
    mat = bpy.data.materials.get("white")
    if mat is None:
        mat = bpy.data.materials.new("white")
        mat.use_nodes = True
        nodes = mat.node_tree.nodes
        nodes.remove(nodes["Principled BSDF"])
        diffuse = nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
        mat.node_tree.links.new(diffuse.outputs[0], nodes["Material Output"].inputs["Surface"])
    return mat


def corner(size=10.0, wall=2.0):
    """Floor, and a wall at y = `wall`."""
    place("Floor", s.grid_mesh("floor", (size, size), (1, 1), white()))
    place("Wall", s.grid_mesh("wall", (size, size / 2), (1, 1), white()), transform((0, wall, size / 4), (90, 0, 0)))


def box(size, at, turn=(0, 0, 0)):
    place("Box", s.box_mesh("box", size, white()), transform(at, turn))


def rod(a, b, radius, segments=24):
    place("Rod", s.tube_mesh("rod", [a, b], radius, white(), segments))


def torus(at, turn, large=0.5, small=0.14, steps=(96, 32)):
    bm = bmesh.new()
    rings = []
    for i in range(steps[0]):
        u = 2 * math.pi * i / steps[0]
        rings.append([])
        for k in range(steps[1]):
            v = 2 * math.pi * k / steps[1]
            r = large + small * math.cos(v)
            rings[-1].append(bm.verts.new((r * math.cos(u), r * math.sin(u), small * math.sin(v))))
    for i, ring in enumerate(rings):
        other = rings[(i + 1) % len(rings)]
        for k in range(steps[1]):
            j = (k + 1) % steps[1]
            bm.faces.new((ring[k], other[k], other[j], ring[j]))
    place("Torus", s.finish(bm, "torus", white(), 180), transform(at, turn))


def ball(at, radius):
    profile = [(0 if i in (0, 48) else radius * math.sin(a), -radius * math.cos(a))
               for i, a in enumerate(math.pi * k / 48 for k in range(49))]
    place("Ball", s.lathe_mesh("ball", profile, white(), 96, 180), transform(at))


def suzanne(at, turn, scale):
    bm = bmesh.new()
    bmesh.ops.create_monkey(bm)
    bmesh.ops.subdivide_edges(bm, edges=bm.edges[:], cuts=2, use_grid_fill=True, smooth=0.6)
    mesh = bpy.data.meshes.new("suzanne")
    bm.to_mesh(mesh)
    bm.free()
    mesh.materials.append(white())
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    place("Suzanne", mesh, transform(at, turn, scale))


def lattice(at, turn, size, count, bar):
    """Crossed bars with square holes. The second set is thinner: faces in one plane would shadow each other."""
    frame = transform(at, turn)
    for k in range(count + 1):
        offset = (k / count - 0.5) * size
        for length, shift in (((size, bar, bar), (0, offset, 0)), ((bar, size, 0.8 * bar), (offset, 0, 0.1 * bar))):
            place("Bar", s.box_mesh("bar", length, white()), frame @ transform(shift))


def stairs(at, turn, steps, width, tread, rise):
    frame = transform(at, turn)
    for k in range(steps):
        place("Step", s.box_mesh("step", (width, tread, rise * (k + 1)), white()), frame @ transform((0, tread * k, 0)))


def area_square():
    corner()
    torus((-0.8, 0.3, 0.75), (65, 0, 25))
    ball((0.7, -0.2, 0.35), 0.35)
    rod((0.1, 0.9, 0), (0.1, 0.9, 1.5), 0.06)
    box((0.5, 0.5, 0.5), (1.6, 0.8, 0), (0, 0, 30))
    s.area_light("Light", s.aim((-1.6, -2.0, 3.4), (0, 0.3, 0)), 300, 0.9, "SQUARE")
    s.camera((0.6, -5.2, 2.4), (0.1, 0.3, 0.6), 40)


def area_rectangle():
    corner()
    lattice((-0.3, 0.1, 1.15), (12, -8, 20), 1.5, 6, 0.05)
    box((0.35, 0.35, 1.0), (1.3, 0.2, 0), (0, 0, 15))
    ball((-1.4, 0.6, 0.3), 0.3)
    box((0.9, 0.06, 0.7), (0.2, -1.0, 0), (0, 0, -12))
    s.area_light("Light", s.aim((1.4, -1.6, 3.2), (0, 0.2, 0), 25), 280, (1.4, 0.35), "RECTANGLE")
    s.camera((-0.7, -5.0, 2.8), (0.0, 0.2, 0.5), 40)


def area_disk():
    corner()
    suzanne((-0.2, 0.1, 0.85), (0, 0, 15), 0.75)
    for k in range(7):
        cone = s.lathe_mesh("cone", [(0, 0), (0.16, 0), (0, 0.7)], white(), 48)
        place("Cone", cone, transform((-1.9 + 0.62 * k, 1.1 - 0.2 * (k % 3), 0)))
    s.area_light("Light", s.aim((1.9, -1.9, 2.9), (-0.2, 0.3, 0.4)), 250, 0.8, "DISK")
    s.camera((-0.4, -5.0, 2.2), (0.0, 0.3, 0.7), 40)


def area_ellipse():
    corner()
    stairs((0.7, -0.3, 0), (0, 0, -20), 6, 1.3, 0.28, 0.16)
    torus((-1.0, 0.2, 0.5), (0, 90, 35), 0.42, 0.08)
    for k in range(6):
        rod((-0.25 + 0.02 * k, -0.9 + 0.3 * k, 0), (-0.25 + 0.02 * k, -0.9 + 0.3 * k, 0.9), 0.03)
    s.area_light("Light", s.aim((-2.3, -1.3, 2.6), (0.2, 0.2, 0.2), 40), 260, (1.3, 0.5), "ELLIPSE")
    s.camera((0.3, -5.2, 2.6), (0.0, 0.2, 0.5), 40)


def area_scaled():
    """The size comes from the object's own uneven scale; the camera is orthographic."""
    corner()
    for i in range(3):
        for k in range(3):
            box((0.3, 0.3, 0.15 + 0.28 * ((2 * i + k) % 4)), (-1.2 + 0.9 * i, -0.7 + 0.8 * k, 0), (0, 0, 13 * (i + k)))
    place("Shelf", s.box_mesh("shelf", (1.4, 0.5, 0.04), white()), transform((0.3, 0.9, 1.3), (0, 10, 0)))
    light = s.area_light("Light", s.aim((-1.2, -2.4, 3.0), (0, 0.2, 0), -30), 320, 0.5, "SQUARE")
    light.matrix_world = light.matrix_world @ Matrix.Diagonal((2.4, 0.8, 1.0, 1.0))
    s.camera((2.2, -5.0, 3.4), (0.0, 0.3, 0.5))
    bpy.context.scene.camera.data.type = "ORTHO"
    bpy.context.scene.camera.data.ortho_scale = 5.0


def spot():
    corner()
    for i in range(6):
        for k in range(4):
            x, y = -1.5 + 0.6 * i + 0.1 * k, -0.6 + 0.55 * k
            rod((x, y, 0), (x, y, 0.25 + 0.14 * ((3 * i + k) % 5)), 0.09)
    s.spot_light("Light", s.aim((1.3, -2.2, 3.0), (0, 0.3, 0.1)), 900, 0.22, 55, 0.4)
    s.camera((-0.4, -5.0, 2.9), (0.0, 0.3, 0.4), 40)


def spot_shift():
    """A wide, hard-edged spot low above the floor; the camera is shifted."""
    corner()
    lattice((0.2, 1.0, 0.75), (90, 0, 0), 1.5, 8, 0.035)
    suzanne((-1.1, 0.3, 0.45), (-15, 0, 40), 0.45)
    stairs((1.4, 0.2, 0), (0, 0, 0), 4, 0.6, 0.22, 0.18)
    s.spot_light("Light", s.aim((-0.5, -2.6, 1.5), (0.1, 0.8, 0.5)), 700, 0.12, 95, 0.05)
    camera = s.camera((0.4, -5.0, 1.9), (0.4, 0.2, 1.9), 34)
    camera.data.shift_x, camera.data.shift_y = -0.07, -0.16


def point():
    """The light stands among the occluders, so that all directions matter."""
    corner(10, 1.6)
    place("Side", s.grid_mesh("side", (10, 5), (1, 1), white()), transform((-2.2, 0, 2.5), (90, 0, 90)))
    for k in range(14):
        a = 2 * math.pi * k / 14
        x, y = 0.95 * math.cos(a), 0.85 * math.sin(a)
        rod((x, y, 0), (x, y, 0.6 + 0.5 * (k % 3)), 0.05)
    torus((0, 0, 1.9), (10, 15, 0), 0.55, 0.05)
    box((0.4, 0.4, 0.4), (1.7, 0.6, 0), (0, 0, 20))
    s.point_light("Light", (0.05, -0.05, 1.15), 120, 0.12)
    s.camera((1.9, -4.6, 3.1), (-0.2, 0.1, 0.6), 34)


def sun():
    corner()
    stairs((-1.2, 0.2, 0), (0, 0, 25), 5, 1.0, 0.26, 0.2)
    lattice((0.7, 0.3, 1.0), (60, 0, 25), 1.3, 7, 0.045)
    rod((1.9, 0.6, 0), (1.7, 0.5, 2.2), 0.05)
    ball((0.1, -0.9, 0.55), 0.22)
    s.sun_light("Light", s.aim((-2.2, -2.6, 3.2), (0, 0, 0)), 3.0, 5.0)
    s.camera((0.5, -5.2, 2.6), (0.1, 0.2, 0.6), 40)


def sun_low():
    """A small sun near the horizon: long shadows under an orthographic camera from above."""
    corner(14, 4.0)
    for i in range(5):
        rod((-2.4 + 1.1 * i, -0.6 + 0.25 * (i % 2), 0), (-2.4 + 1.1 * i, -0.6 + 0.25 * (i % 2), 0.5 + 0.2 * i), 0.05)
    torus((-0.9, -1.4, 0.62), (0, 90, 60), 0.45, 0.1)
    suzanne((1.2, -1.5, 0.45), (0, 0, -40), 0.45)
    s.sun_light("Light", s.aim((2.0, -4.5, 2.1), (0, 0, 0)), 4.0, 2.0)
    s.camera((0.0, -3.0, 6.0), (0.0, 0.2, 0.0))
    bpy.context.scene.camera.data.type = "ORTHO"
    bpy.context.scene.camera.data.ortho_scale = 6.5


SCENES = (area_square, area_rectangle, area_disk, area_ellipse, area_scaled, spot, spot_shift, point, sun, sun_low)


def key():
    """A hash of geometry, light and camera, independent of names and of how they were made."""
    digest = hashlib.sha256()
    for item in bpy.context.scene.objects:
        data, parts = item.data, [tuple(round(x, 6) for row in item.matrix_world for x in row)]
        if item.type == "MESH":
            parts += [tuple(round(x, 6) for v in data.vertices for x in v.co),
                      [tuple(p.vertices) for p in data.polygons], [p.use_smooth for p in data.polygons]]
        else:
            wanted = ("type", "energy", "shape", "size", "size_y", "shadow_soft_size", "spot_size", "spot_blend",
                      "angle", "lens", "ortho_scale", "shift_x", "shift_y")
            parts += [(name, getattr(data, name)) for name in wanted if hasattr(data, name)]
        digest.update(repr(parts).encode())
    return digest.hexdigest()[:16]


def build(function):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    function()
    s.world((0, 0, 0))
    for item in scene.objects:
        if item.type == "LIGHT":
            item.visible_camera = False
    scene.camera.data.clip_end = 25.0  # EEVEE fits a sun's shadow map to it
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 480, 270, 100
    bpy.context.view_layer.update()


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:]
    folder, wanted = os.path.abspath(arguments[0]), arguments[1:]
    for function in SCENES:
        if not wanted or function.__name__ in wanted:
            build(function)
            path = os.path.join(folder, function.__name__)
            bpy.ops.wm.save_as_mainfile(filepath=path + ".blend", compress=True)
            with open(path + ".key", "w", encoding="ascii") as file:
                file.write(key())


if __name__ == "__main__":
    main()
