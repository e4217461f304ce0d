# SPDX-License-Identifier: GPL-3.0-or-later
"""A garden corner in low sun: pickets, a diagonal trellis with a vine, pots and grass. Many fine holes."""
import math
import random

import plants
import shapes as s
from shapes import place, transform

COLORS = {
    "plaster": (0.80, 0.73, 0.60), "plinth": (0.40, 0.37, 0.34), "soil": (0.16, 0.11, 0.07), "lawn": (0.16, 0.24, 0.07),
    "grass": (0.20, 0.34, 0.08), "slab": (0.52, 0.48, 0.42), "fence": (0.82, 0.82, 0.78), "trellis": (0.34, 0.22, 0.12),
    "vine": (0.11, 0.24, 0.06), "stem": (0.17, 0.11, 0.05), "pot": (0.58, 0.24, 0.12), "bush": (0.22, 0.36, 0.14),
    "can": (0.20, 0.33, 0.38), "shutter": (0.16, 0.30, 0.30), "glass": (0.10, 0.13, 0.15), "flower": (0.72, 0.16, 0.22),
}


def mat(key):
    return s.material(key, COLORS[key])


def ground(rng):
    lawn = s.grid_mesh("lawn", (9, 7), (60, 50), mat("lawn"),
                       lambda x, y: -0.02 + 0.012 * math.sin(3.1 * x + 1) * math.cos(2.7 * y))
    place("Lawn", lawn, transform((0, -1.5, 0)))
    slab = s.box_mesh("slab", (0.62, 0.46, 0.05), mat("slab"), 0.012)
    for row in range(2):
        for k in range(-4, 6):
            x = k * 0.66 + 0.33 * row + rng.uniform(-0.01, 0.01)
            place("Slab", slab, transform((x, -0.62 - 0.50 * row, -0.02), (0, 0, rng.uniform(-1.5, 1.5))))
    tile = plants.grass_mesh("grass", rng, 0.5, 150, 0.07, mat("grass"))
    for i in range(-7, 8):
        for j in range(6):
            if j or i % 2 == 0:
                place("Grass", tile, transform((i * 0.45, -1.68 - j * 0.42, -0.02), (0, 0, 90 * rng.randrange(4))))


def house():
    place("Wall", s.box_mesh("wall", (7, 0.2, 3.2), mat("plaster")), transform((0, 0.30, 0)))
    place("Plinth", s.box_mesh("plinth", (7, 0.26, 0.22), mat("plinth"), 0.015), transform((0, 0.30, 0)))
    x, z = 1.25, 0.95
    place("Pane", s.box_mesh("pane", (0.8, 0.02, 1.0), mat("glass")), transform((x, 0.195, z)))
    upright = s.box_mesh("upright", (0.05, 0.07, 1.06), mat("fence"))
    rail = s.box_mesh("rail", (0.86, 0.064, 0.05), mat("fence"))
    for dx in (-0.4, 0.0, 0.4):
        place("Frame", upright, transform((x + dx, 0.18, z - 0.03)))
    for dz in (-0.03, 0.5, 1.0):
        place("Frame", rail, transform((x, 0.18, z + dz)))
    place("Sill", s.box_mesh("sill", (1.0, 0.18, 0.04), mat("plinth"), 0.008), transform((x, 0.14, z - 0.07)))
    slat = s.box_mesh("slat", (0.34, 0.012, 0.045), mat("shutter"), 0.003)
    stile = s.box_mesh("stile", (0.035, 0.03, 1.04), mat("shutter"), 0.004)
    for side in (-1, 1):
        hinge = transform((x + side * 0.45, 0.185, z - 0.02), (0, 0, -side * 25))
        for k in range(18):
            place("Slat", slat, hinge @ transform((side * 0.19, 0, 0.04 + k * 0.055), (35, 0, 0)))
        for edge in (0.01, 0.37):
            place("Stile", stile, hinge @ transform((side * edge, 0, 0)))


def trellis(rng, x, width, height):
    """Diagonal laths in two layers, framed, standing off the wall, with a vine."""
    lath_length, spacing, y = 0.026, 0.20, 0.04
    for layer, slope in ((0, 1), (1, -1)):
        count = int((width + height) / spacing)
        for k in range(count):
            # A lath runs at 45 degrees and is cut to the frame.
            start = -height + (k + 0.5) * (width + height) / count
            low, high = max(0.0, start), min(width, start + height)
            if high - low < 0.05:
                continue
            a = s.Vector((low, 0, low - start)), s.Vector((high, 0, high - start))
            ends = [s.Vector((p.x if slope > 0 else width - p.x, y - 0.014 * layer, p.z)) for p in a]
            length = (ends[1] - ends[0]).length
            lath = s.box_mesh("lath", (lath_length, 0.012, length), mat("trellis"))
            place("Lath", lath, transform(ends[0] + s.Vector((x, 0, 0.1)), (0, 45 * slope, 0)))
    for dx in (0, width):
        place("Post", s.box_mesh("post", (0.05, 0.05, height + 0.2), mat("trellis"), 0.004), transform((x + dx, y, 0)))
    for dz in (0.1, height + 0.1):
        rail = s.box_mesh("rail", (width, 0.04, 0.04), mat("trellis"), 0.004)
        place("Rail", rail, transform((x + width / 2, y, dz - 0.02)))
    leaf = s.leaf_mesh("vine leaf", 0.11, 0.085, mat("vine"), 0.3, 0.35, 5)
    for k in range(7):
        dx, points = width * (k + 0.5) / 7, []
        for step in range(6):
            z = 0.02 + step * height * rng.uniform(0.16, 0.215)
            points.append((x + dx + rng.gauss(0, 0.09), y - 0.05 + rng.uniform(-0.02, 0.02), z))
        plants.vine("Vine", rng, points, leaf, mat("stem"), 0.008, 0.045)


def fence(y):
    """Pointed pickets on two rails; a gap shows the path."""
    bm = s.bmesh.new()
    outline = [(-0.035, 0), (0.035, 0), (0.035, 0.72), (0, 0.80), (-0.035, 0.72)]
    front, back = ([bm.verts.new((x, dy, z)) for x, z in outline] for dy in (-0.01, 0.01))
    bm.faces.new(front)
    bm.faces.new(list(reversed(back)))
    for i in range(5):
        j = (i + 1) % 5
        bm.faces.new((front[i], back[i], back[j], front[j]))
    picket = s.finish(bm, "picket", mat("fence"))
    rail = s.box_mesh("fence rail", (4.6, 0.03, 0.06), mat("fence"))
    post = s.box_mesh("fence post", (0.09, 0.09, 0.86), mat("fence"), 0.008)
    profile = [(0, 0), (0.05, 0), (0.05, 0.012), (0.03, 0.02), (0.04, 0.05), (0.025, 0.085), (0, 0.09)]
    cap = s.lathe_mesh("cap", profile, mat("fence"), 20)
    for start in (-4.75, 0.85):
        for k in range(36):
            place("Picket", picket, transform((start + 0.08 + 0.125 * k, y - 0.03, 0.04)))
        for z in (0.2, 0.56):
            place("Fence rail", rail, transform((start + 2.3, y, z)))
        for x in (start, start + 4.6):
            place("Fence post", post, transform((x, y, 0)))
            place("Cap", cap, transform((x, y, 0.86)))


def pots(rng):
    outline = s.spline([(0.10, 0, 0), (0.15, 0, 0.22), (0.165, 0, 0.225), (0.165, 0, 0.27), (0.145, 0, 0.27),
                        (0.135, 0, 0.2)], 4)
    pot = s.lathe_mesh("pot", [(0, 0)] + [(p.x, p.z) for p in outline] + [(0, 0.2)], mat("pot"), 48)
    leaf = s.leaf_mesh("bush leaf", 0.13, 0.035, mat("bush"), 0.4, 0.3)
    round_leaf = s.leaf_mesh("round leaf", 0.10, 0.075, mat("vine"), 0.2, 0.3)
    petal = s.leaf_mesh("petal", 0.035, 0.028, mat("flower"), 0.3, -0.2, 4)
    for x, y, size, kind in ((0.46, -0.18, 1.0, leaf), (2.15, -0.15, 1.25, round_leaf), (-1.98, -0.3, 1.1, leaf),
                             (0.86, -0.33, 0.7, round_leaf)):
        place("Pot", pot, transform((x, y, 0.03), (0, 0, 0), size))
        plants.bush("Bush", rng, (x, y, 0.03 + 0.2 * size), kind, mat("stem"), 0.24 * size, 0.5 * size, 14, size,
                    petal if kind is leaf else None)


def watering_can(x, y):
    profile = [(0, 0), (0.105, 0), (0.11, 0.01), (0.10, 0.2), (0.09, 0.22), (0.085, 0.22), (0.095, 0.19), (0, 0.15)]
    body = s.lathe_mesh("can", profile, mat("can"), 40)
    frame = transform((x, y, 0.03), (0, 0, -155))
    path = s.spline([(0.09, 0, 0.05), (0.17, 0, 0.12), (0.24, 0, 0.27)], 5)
    spout = s.tube_mesh("spout", path, 0.024, mat("can"), 14, 0.011)
    rose = s.lathe_mesh("rose", [(0.011, 0), (0.04, 0.05), (0.04, 0.055), (0, 0.06)], mat("can"), 24)
    path = s.spline([(0.08, 0, 0.21), (0.02, 0, 0.33), (-0.12, 0, 0.30), (-0.17, 0, 0.17), (-0.105, 0, 0.06)], 6)
    grip = s.tube_mesh("grip", path, 0.008, mat("can"), 10)
    for name, mesh in (("Can", body), ("Spout", spout), ("Grip", grip)):
        place(name, mesh, frame)
    place("Rose", rose, frame @ transform((0.235, 0, 0.26), (0, 30, 0)))


def build():
    rng = random.Random(11)
    ground(rng)
    house()
    trellis(rng, -1.65, 1.75, 1.75)
    fence(-1.42)
    pots(rng)
    watering_can(-0.35, -0.62)
    s.sun_light("Sun", s.aim((-2.6, -3.0, 2.9), (0, 0, 0)), 3.4, 2.0, (1.0, 0.90, 0.74))
    s.world((0.06, 0.09, 0.14))
    s.camera((1.15, -4.9, 2.35), (0.12, -0.45, 0.66), 42)
