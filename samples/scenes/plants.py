# SPDX-License-Identifier: GPL-3.0-or-later
"""Plants that several sample scenes share: instances of few leaf meshes on grown stems."""
import math

import shapes as s
from shapes import place, transform


def stand_leaf(mesh, at, heading, pitch, scale):
    """Places a leaf at `at`, turned by `heading` about Z and raised by `pitch`, both in degrees."""
    place("Leaf", mesh, transform(at, (0, -pitch, heading), scale))


def vine(name, rng, path, leaf, stem_material, radius=0.006, spacing=0.05, scale=1.0, outward=(0, -1)):
    """A climbing stem along `path` with leaves that lean towards `outward` in the ground plane."""
    points = s.spline(path, 6)
    place(name, s.tube_mesh(name, points, radius, stem_material, 6, radius * 0.4))
    base = math.degrees(math.atan2(outward[1], outward[0]))
    travelled = 0.0
    for a, b in zip(points, points[1:]):
        travelled += (b - a).length
        while travelled > spacing:
            travelled -= spacing
            offset = s.Vector([rng.gauss(0, 0.012) for _ in range(3)])
            heading, pitch = base + rng.uniform(-75, 75), rng.uniform(-35, 45)
            stand_leaf(leaf, b + offset, heading, pitch, scale * rng.uniform(0.6, 1.2))


def bush(name, rng, at, leaf, stem_material, radius, height, count, scale=1.0, petal=None):
    """Bent stems that rise from one point, leaves along each, a flower of `petal` on every other tip."""
    for k in range(count):
        turn, lean = 2 * math.pi * (k + rng.random()) / count, radius * math.sqrt(rng.random())
        top = s.Vector((lean * math.cos(turn), lean * math.sin(turn), height * rng.uniform(0.7, 1.1)))
        bend = s.Vector((top.x * 0.25, top.y * 0.25, top.z * 0.55))
        points = s.spline([s.Vector(at), s.Vector(at) + bend, s.Vector(at) + top], 7)
        place(name, s.tube_mesh(name, points, 0.005, stem_material, 5, 0.0015))
        for i in range(3, len(points)):
            for _ in range(2):
                heading = math.degrees(turn) + rng.uniform(-110, 110)
                stand_leaf(leaf, points[i], heading, rng.uniform(-20, 55), scale * rng.uniform(0.6, 1.15))
        for i in range(6 if petal and k % 2 == 0 else 0):
            stand_leaf(petal, points[-1], 60 * i, 25, 1.2 * scale)


def grass_mesh(name, rng, size, count, height, mat):
    """A tile of blades, each three quads and a tip."""
    bm = s.bmesh.new()
    for _ in range(count):
        x, y, turn = rng.uniform(-size, size) / 2, rng.uniform(-size, size) / 2, rng.uniform(0, 2 * math.pi)
        tall, bend, half = height * rng.uniform(0.5, 1.2), rng.uniform(0.2, 0.7), 0.004
        c, d = math.cos(turn), math.sin(turn)
        rows = []
        for i in range(3):
            t = i / 3
            out, up, w = bend * tall * t * t, tall * t, half * (1 - 0.6 * t)
            rows.append([bm.verts.new((x + out * c - k * w * d, y + out * d + k * w * c, up)) for k in (-1, 1)])
        tip = bm.verts.new((x + bend * tall * c, y + bend * tall * d, tall))
        for low, high in zip(rows, rows[1:]):
            bm.faces.new((low[0], low[1], high[1], high[0]))
        bm.faces.new((rows[-1][0], rows[-1][1], tip))
    mesh = s.bpy.data.meshes.new(name)
    bm.to_mesh(mesh)
    bm.free()
    mesh.materials.append(mat)
    return mesh
