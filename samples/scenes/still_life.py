# SPDX-License-Identifier: GPL-3.0-or-later
"""A laid table under one large window light: occluders at many heights, from a book to a hanging mobile."""
import math
import random

import shapes as s
from shapes import place, transform

LINEN = (0.62, 0.57, 0.48)
COLORS = {
    "wall": (0.42, 0.47, 0.46), "bowl": (0.16, 0.27, 0.36), "apple": (0.52, 0.06, 0.04), "lemon": (0.80, 0.58, 0.07),
    "pear": (0.46, 0.50, 0.10), "orange": (0.78, 0.28, 0.04), "stem": (0.10, 0.06, 0.03), "bottle": (0.05, 0.16, 0.10),
    "label": (0.75, 0.70, 0.58), "goblet": (0.70, 0.52, 0.25), "vase": (0.66, 0.62, 0.56), "paper": (0.80, 0.76, 0.66),
    "leaf": (0.20, 0.33, 0.12), "thread": (0.15, 0.14, 0.13), "brass": (0.62, 0.42, 0.16), "candle": (0.82, 0.78, 0.68),
}


def mat(key):
    return s.material(key, COLORS[key])


def wood(u, v):
    """Planks along u with wavy grain."""
    plank = int(v * 6)
    shade = 0.72 + 0.12 * math.sin(plank * 12.9898)
    grain = math.sin(95 * v + 3 * math.sin(5 * u + plank * 2.1) + 0.9 * math.sin(17 * u + plank))
    fine = math.sin(420 * v + 6 * math.sin(9 * u + plank))
    seam = 0.45 if (v * 6) % 1 < 0.03 else 1.0
    k = seam * (shade + 0.07 * grain + 0.03 * fine)
    return min(1, 0.70 * k), min(1, 0.49 * k), min(1, 0.31 * k)


def ground():
    table = s.image_material("table", 512, 512, wood)
    place("Table", s.grid_mesh("table", (2.6, 1.5), (1, 1), table))
    wall = s.grid_mesh("wall", (3.2, 1.7), (1, 1), mat("wall"))
    place("Wall", wall, transform((0.2, 0.75, 0.75), (90, 0, 0)))
    cloth = s.material("cloth", LINEN)
    fold = s.grid_mesh("cloth", (0.9, 0.62), (60, 40), cloth,
                       lambda x, y: 0.002 + 0.003 * (1 + math.sin(9 * x + 4 * y)) * (0.3 + abs(x) + abs(y)) ** 2)
    place("Cloth", fold, transform((-0.08, -0.08, 0), (0, 0, 9)))


def fruit_mesh(name, key, width, height, dent, segments=32):
    """A round fruit; `dent` pulls in its poles."""
    steps = 16
    profile = []
    for i in range(steps + 1):
        t = math.pi * i / steps
        z = -math.cos(t) * (1 - dent * math.exp(-((math.sin(t) / 0.35) ** 2)))
        profile.append((0 if i in (0, steps) else width * math.sin(t), height * (z + 1)))
    return s.lathe_mesh(name, profile, mat(key), segments, 180)


def pear_mesh():
    outline = s.spline([(0.001, 0, 0.004), (0.026, 0, 0.0), (0.042, 0, 0.03), (0.036, 0, 0.06), (0.020, 0, 0.09),
                        (0.014, 0, 0.108), (0.001, 0, 0.114)], 4)
    profile = [(0, 0.004)] + [(max(p.x, 0.001), p.z) for p in outline] + [(0, 0.114)]
    return s.lathe_mesh("pear", profile, mat("pear"), 32, 180)


def fruit_bowl(x, y):
    outline = s.spline([(0.055, 0, 0.0), (0.05, 0, 0.018), (0.10, 0, 0.045), (0.155, 0, 0.085), (0.178, 0, 0.118),
                        (0.170, 0, 0.118), (0.145, 0, 0.088), (0.09, 0, 0.052), (0.04, 0, 0.04)], 5)
    profile = [(0, 0)] + [(p.x, p.z) for p in outline] + [(0, 0.04)]
    place("Bowl", s.lathe_mesh("bowl", profile, mat("bowl"), 72), transform((x, y, 0.012)))
    apple = fruit_mesh("apple", "apple", 0.043, 0.038, 0.28)
    lemon = fruit_mesh("lemon", "lemon", 0.031, 0.042, -0.12)
    orange = fruit_mesh("orange", "orange", 0.042, 0.040, 0.05)
    path = s.spline([(0, 0, 0.06), (0.003, 0, 0.075), (0.012, 0.002, 0.092)], 3)
    stem = s.tube_mesh("stem", path, 0.002, mat("stem"), 6)
    heap = [(apple, -0.075, -0.03, 0.062, 8), (orange, 0.02, -0.075, 0.062, 0), (apple, 0.078, 0.01, 0.064, -14),
            (orange, -0.02, 0.07, 0.062, 0), (lemon, 0.0, -0.005, 0.10, 75), (apple, -0.035, -0.02, 0.125, 20)]
    for i, (mesh, dx, dy, z, tilt) in enumerate(heap):
        matrix = transform((x + dx, y + dy, z), (tilt, tilt / 2, 50 * i))
        place(f"Fruit {i}", mesh, matrix)
        if mesh is apple:
            place(f"Stem {i}", stem, matrix)
    pear = pear_mesh()
    stem_high = s.tube_mesh("pear stem", [(0, 0, 0.11), (0.002, 0, 0.125), (0.009, 0, 0.14)], 0.0018, mat("stem"), 6)
    for name, matrix in (("Pear", transform((x + 0.04, y + 0.02, 0.118), (12, -28, 30))),
                         ("Pear on table", transform((x + 0.23, y - 0.19, 0.052), (0, 82, 205)))):
        place(name, pear, matrix)
        place(f"{name} stem", stem_high, matrix)
    place("Lemon on table", lemon, transform((x - 0.05, y - 0.27, 0.044), (88, 0, 40)))


def bottle(x, y):
    outline = s.spline([(0.036, 0, 0.0), (0.039, 0, 0.01), (0.039, 0, 0.17), (0.036, 0, 0.20), (0.018, 0, 0.235),
                        (0.0145, 0, 0.26), (0.014, 0, 0.31)], 5)
    lip = [(0.017, 0.31), (0.0175, 0.325), (0.012, 0.327), (0, 0.327)]
    profile = [(0, 0)] + [(p.x, p.z) for p in outline] + lip
    place("Bottle", s.lathe_mesh("bottle", profile, mat("bottle"), 56), transform((x, y, 0)))
    label = [(0.0395, 0.06), (0.0398, 0.06), (0.0398, 0.15), (0.0395, 0.15)]
    place("Label", s.lathe_mesh("label", label, mat("label"), 56), transform((x, y, 0)))


def goblet(x, y):
    outline = s.spline([(0.034, 0, 0.0), (0.030, 0, 0.006), (0.008, 0, 0.014), (0.0055, 0, 0.05), (0.009, 0, 0.082),
                        (0.033, 0, 0.105), (0.041, 0, 0.14), (0.036, 0, 0.182), (0.034, 0, 0.182), (0.038, 0, 0.14),
                        (0.028, 0, 0.108)], 5)
    profile = [(0, 0)] + [(p.x, p.z) for p in outline] + [(0, 0.095)]
    place("Goblet", s.lathe_mesh("goblet", profile, mat("goblet"), 56), transform((x, y, 0)))


def books(x, y):
    paper = mat("paper")
    covers = [((0.24, 0.17, 0.034), (0.34, 0.08, 0.06), 14), ((0.21, 0.15, 0.024), (0.10, 0.18, 0.26), -7),
              ((0.19, 0.13, 0.030), (0.55, 0.40, 0.16), 22)]
    z = 0.0
    for i, (size, color, turn) in enumerate(covers):
        cover = s.material(f"cover {i}", color)
        for part, dz, thickness in (("back", 0, 0.003), ("front", size[2] - 0.003, 0.003)):
            board = s.box_mesh(f"{part} {i}", (size[0], size[1], thickness), cover, 0.001)
            place(f"Book {i} {part}", board, transform((x, y, z + dz), (0, 0, turn)))
        pages = s.box_mesh(f"pages {i}", (size[0] - 0.010, size[1] - 0.012, size[2] - 0.006), paper)
        place(f"Book {i} pages", pages, transform((x, y, z + 0.003), (0, 0, turn)))
        spine = s.box_mesh(f"spine {i}", (size[0], 0.004, size[2]), cover, 0.0015)
        place(f"Book {i} spine", spine, transform((x, y, z), (0, 0, turn)) @ transform((0, -size[1] / 2, 0)))
        z += size[2]
    return z


def candlestick(x, y, z):
    profile = [(0, 0), (0.045, 0), (0.045, 0.006), (0.012, 0.014), (0.008, 0.03), (0.014, 0.045), (0.008, 0.06),
               (0.018, 0.075), (0.018, 0.08), (0, 0.08)]
    place("Candlestick", s.lathe_mesh("candlestick", profile, mat("brass"), 48), transform((x, y, z)))
    wax = [(0, 0.08), (0.010, 0.08), (0.010, 0.20), (0.007, 0.205), (0, 0.203)]
    place("Candle", s.lathe_mesh("candle", wax, mat("candle"), 32), transform((x, y, z)))
    wick = s.tube_mesh("wick", [(0, 0, 0.2), (0, 0, 0.212), (0.003, 0, 0.22)], 0.0009, mat("thread"), 6)
    place("Wick", wick, transform((x, y, z)))


def branch(rng, leaf, start, heading, length, radius, depth, name):
    """A twig with alternate leaves, and smaller twigs."""
    points, direction = [start], heading.normalized()
    for _ in range(5):
        bend = s.Vector((rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-0.4, 0.8)))
        direction = (direction + 0.28 * bend).normalized()
        points.append(points[-1] + direction * length / 5)
    path = s.spline(points, 3)
    place(name, s.tube_mesh(name, path, radius, mat("stem"), 6, radius * 0.35))
    for i in range(3, len(path), 2 if depth else 3):
        along = (path[i] - path[i - 1]).to_track_quat("X", "Z").to_matrix().to_4x4()
        spin = s.Matrix.Rotation(rng.uniform(0, 6.3), 4, "X") @ s.Matrix.Rotation(rng.uniform(-1.2, -0.5), 4, "Y")
        place("Leaf", leaf, s.Matrix.Translation(path[i]) @ along @ spin @ s.Matrix.Scale(rng.uniform(0.6, 1.1), 4))
    if depth < 2:
        for k, i in enumerate((5, 8, 11)):
            side = s.Vector((rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0.1, 0.9)))
            branch(rng, leaf, path[i], side, length * 0.5, radius * 0.55, depth + 1, f"{name}.{k}")


def vase_with_twigs(x, y):
    outline = s.spline([(0.04, 0, 0.0), (0.062, 0, 0.05), (0.066, 0, 0.10), (0.040, 0, 0.155), (0.026, 0, 0.185),
                        (0.034, 0, 0.205), (0.030, 0, 0.204), (0.022, 0, 0.185)], 5)
    profile = [(0, 0)] + [(p.x, p.z) for p in outline] + [(0, 0.16)]
    place("Vase", s.lathe_mesh("vase", profile, mat("vase"), 56), transform((x, y, 0)))
    rng = random.Random(7)
    leaf = s.leaf_mesh("leaf", 0.055, 0.022, mat("leaf"))
    for i, lean in enumerate(((-0.35, -0.1), (0.30, 0.05), (0.02, -0.32), (0.5, -0.3))):
        branch(rng, leaf, s.Vector((x, y, 0.17)), s.Vector((*lean, 1.0)), 0.42, 0.0045, 1 if i else 0, f"Twig {i}")


def mobile(x, y, z):
    """Thin bars, each hanging from the one above, with discs and birds' wings at their ends."""
    rod = s.tube_mesh("rod", [(-0.5, 0, 0), (0, 0, 0.03), (0.5, 0, 0)], 0.005, mat("thread"), 8)
    disc = s.lathe_mesh("disc", [(0, -0.0015), (0.034, -0.0015), (0.034, 0.0015), (0, 0.0015)], mat("brass"), 40)
    wing = s.leaf_mesh("wing", 0.12, 0.05, mat("goblet"), 0.5, 0.1, 8)
    bars = [((x, y, z), 0.46, 25), ((x - 0.208, y - 0.097, z - 0.09), 0.26, -40),
            ((x + 0.208, y + 0.097, z - 0.07), 0.22, 70)]
    for i, (centre, width, turn) in enumerate(bars):
        place(f"Rod {i}", rod, transform(centre, (0, 0, turn), (width, width * 0.7, width * 0.7)))
        for side in (-1, 1):
            if i == 0:
                continue
            tip = transform(centre, (0, 0, turn)) @ s.Vector((side * width / 2, 0, 0))
            thread = s.tube_mesh("thread", [tip, tip - s.Vector((0, 0, 0.07))], 0.0012, mat("thread"), 5)
            place("Thread", thread)
            if i == 1:
                place("Disc", disc, transform(tip - s.Vector((0, 0, 0.10)), (90, 0, turn + 60 * side)))
            else:
                for flip in (1, -1):
                    place("Wing", wing, transform(tip - s.Vector((0, 0, 0.07)), (0, -25, turn + 90 * flip), (1, 1, 1)))
    for i, (centre, _, _) in enumerate(bars):
        top = s.Vector(centre) + s.Vector((0, 0, 0.09 if i else 0.8))
        ends = [s.Vector(centre) + s.Vector((0, 0, 0.009)), top]
        place("Thread", s.tube_mesh("thread", ends, 0.0012, mat("thread"), 5))


def build():
    ground()
    fruit_bowl(-0.06, -0.05)
    bottle(-0.31, 0.20)
    goblet(-0.30, -0.08)
    candlestick(0.36, 0.07, books(0.34, 0.05))
    vase_with_twigs(0.10, 0.27)
    mobile(-0.30, -0.12, 0.66)
    through_window = s.aim((-1.90, -0.92, 1.18), (0.15, 0.1, 0.15))
    s.area_light("Window", through_window, 80, (0.64, 0.42), "RECTANGLE", (1.0, 0.93, 0.82))
    s.world((0.055, 0.065, 0.085))
    s.camera((0.14, -1.72, 0.86), (0.06, 0.0, 0.235), 42)
