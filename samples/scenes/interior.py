# SPDX-License-Identifier: GPL-3.0-or-later
"""A sitting room at the end of the day, lit by every kind of light: sun through blinds and seven lamps."""
import math
import random

import plants
import shapes as s
from shapes import place, transform

COLORS = {
    "floor": (0.42, 0.27, 0.16), "wall": (0.74, 0.70, 0.62), "accent": (0.28, 0.38, 0.38),
    "ceiling": (0.82, 0.81, 0.78), "trim": (0.78, 0.76, 0.72), "blind": (0.70, 0.60, 0.46),
    "rug": (0.42, 0.15, 0.12), "rug edge": (0.70, 0.62, 0.48), "sofa": (0.20, 0.30, 0.42),
    "cushion": (0.74, 0.48, 0.16), "wood": (0.38, 0.21, 0.10), "dark wood": (0.16, 0.10, 0.07),
    "shade": (0.82, 0.74, 0.58), "metal": (0.18, 0.17, 0.16), "leaf": (0.12, 0.27, 0.09), "stem": (0.17, 0.11, 0.05),
    "pot": (0.66, 0.62, 0.56), "paper": (0.80, 0.77, 0.70), "picture": (0.34, 0.42, 0.46), "fruit": (0.62, 0.16, 0.08),
}
WIDTH, DEPTH, HEIGHT = 4.6, 3.8, 2.6


def mat(key):
    return s.material(key, COLORS[key])


def box(name, size, key, at, turn=0.0, bevel=0.0):
    return place(name, s.box_mesh(name.lower(), size, mat(key), bevel), transform(at, (0, 0, turn)))


def boards(u, v):
    row = int(v * 14)
    shift = (row * 0.37) % 1
    plank = int((u + shift) * 3) + 31 * row
    shade = 0.80 + 0.13 * math.sin(plank * 12.9898) + 0.05 * math.sin(260 * v + 4 * math.sin(11 * u + plank))
    if (v * 14) % 1 < 0.04 or ((u + shift) * 3) % 1 < 0.006:
        shade *= 0.55
    return min(1, 0.80 * shade), min(1, 0.58 * shade), min(1, 0.40 * shade)


def shell():
    """Floor, walls with a window opening in the left one, ceiling and skirting."""
    w, d, h, t = WIDTH, DEPTH, HEIGHT, 0.15
    floor = s.grid_mesh("floor", (w, d + 1.5), (1, 1), s.image_material("boards", 512, 512, boards))
    place("Floor", floor, transform((0, -0.75, 0)))
    box("Ceiling", (w + 2 * t, d + 1.5, t), "ceiling", (0, -0.75, h))
    box("Back wall", (w + 2 * t, t, h), "accent", (0, d / 2 + t / 2, 0))
    box("Right wall", (t, d + 1.5, h), "wall", (w / 2 + t / 2, -0.75, 0))
    x, low, high, y0, y1 = -w / 2 - t / 2, 0.75, 2.15, -0.55, 1.25
    box("Left wall below", (t, d + 1.5, low), "wall", (x, -0.75, 0))
    box("Left wall above", (t, d + 1.5, h - high), "wall", (x, -0.75, high))
    box("Left wall back", (t, d / 2 - y1, high - low), "wall", (x, (y1 + d / 2) / 2, low))
    box("Left wall front", (t, y0 + d / 2 + 1.5, high - low), "wall", (x, (y0 - d / 2 - 1.5) / 2, low))
    box("Sill", (0.30, y1 - y0 + 0.12, 0.035), "trim", (x + 0.08, (y0 + y1) / 2, low - 0.035), 0, 0.006)
    box("Skirting back", (w, 0.018, 0.10), "trim", (0, d / 2 - 0.009, 0))
    box("Skirting right", (0.018, d, 0.10), "trim", (w / 2 - 0.009, 0, 0))
    for z in (low, (low + high) / 2 - 0.02, high - 0.05):
        box("Casement", (0.05, y1 - y0, 0.05), "trim", (x, (y0 + y1) / 2, z))
    for y in (y0 + 0.025, (y0 + y1) / 2, y1 - 0.025):
        box("Casement", (0.045, 0.05, high - low), "trim", (x, y, low))
    blinds(x + 0.12, y0, y1, high, 0.95)


def blinds(x, y0, y1, top, bottom):
    """Venetian slats on cords."""
    slat = s.box_mesh("blind slat", (0.072, y1 - y0 + 0.06, 0.003), mat("blind"))
    middle = (y0 + y1) / 2
    count = int((top - bottom) / 0.08)
    for k in range(count):
        place("Blind slat", slat, transform((x, middle, top - 0.06 - 0.08 * k), (0, 4, 0)))
    box("Blind head", (0.06, y1 - y0 + 0.08, 0.05), "blind", (x, middle, top - 0.03))
    for y in (y0 + 0.2, middle, y1 - 0.2):
        place("Cord", s.tube_mesh("cord", [(x, y, bottom - 0.03), (x, y, top)], 0.003, mat("trim"), 6))


def sofa(x, y, turn):
    frame = transform((x, y, 0), (0, 0, turn))
    parts = [("Sofa base", (1.75, 0.78, 0.22), (0, 0, 0.14), 0.04),
             ("Sofa back", (1.75, 0.20, 0.62), (0, 0.34, 0.22), 0.06),
             ("Sofa arm", (0.20, 0.80, 0.46), (-0.87, 0, 0.14), 0.06),
             ("Sofa arm", (0.20, 0.80, 0.46), (0.87, 0, 0.14), 0.06),
             ("Seat", (0.76, 0.62, 0.16), (-0.385, -0.06, 0.35), 0.05),
             ("Seat", (0.76, 0.62, 0.16), (0.385, -0.06, 0.35), 0.05)]
    for name, size, at, bevel in parts:
        place(name, s.box_mesh(name.lower(), size, mat("sofa"), bevel), frame @ transform(at))
    for dx in (-0.75, 0.75):
        for dy in (-0.32, 0.34):
            place("Foot", s.box_mesh("foot", (0.06, 0.06, 0.15), mat("dark wood")), frame @ transform((dx, dy, 0)))
    for at, spin in (((-0.52, 0.12, 0.50), -14), ((0.55, 0.13, 0.50), 18)):
        cushion = s.box_mesh("cushion", (0.40, 0.12, 0.38), mat("cushion"), 0.055)
        place("Cushion", cushion, frame @ transform(at, (-22, 0, spin)))


def coffee_table(x, y):
    """A slatted top, so that the floor shows stripes of light, with a bowl and books."""
    for k in range(9):
        box("Top slat", (1.0, 0.042, 0.022), "wood", (x, y - 0.24 + 0.06 * k, 0.38), 0, 0.004)
    for dx in (-0.42, 0.42):
        box("Bearer", (0.05, 0.52, 0.04), "wood", (x + dx, y, 0.34))
        for dy in (-0.22, 0.22):
            leg = s.tube_mesh("leg", [(0, 0, 0), (-dx * 0.1, -dy * 0.2, 0.36)], 0.014, mat("dark wood"), 12, 0.022)
            place("Leg", leg, transform((x + dx * 1.08, y + dy * 1.1, 0)))
    outline = s.spline([(0.05, 0, 0), (0.11, 0, 0.03), (0.15, 0, 0.075), (0.142, 0, 0.075), (0.10, 0, 0.036)], 4)
    bowl = s.lathe_mesh("bowl", [(0, 0)] + [(p.x, p.z) for p in outline] + [(0, 0.02)], mat("pot"), 48)
    place("Bowl", bowl, transform((x - 0.2, y + 0.02, 0.402)))
    profile = [(0.038 * math.sin(a), -0.036 * math.cos(a)) if 0 < i < 12 else (0, -0.036 * math.cos(a))
               for i, a in enumerate(math.pi * k / 12 for k in range(13))]
    ball = s.lathe_mesh("fruit", profile, mat("fruit"), 24, 180)
    for k in range(4):
        a = 1.6 * k
        place("Fruit", ball, transform((x - 0.2 + 0.055 * math.cos(a), y + 0.02 + 0.055 * math.sin(a), 0.47)))
    box("Book", (0.24, 0.17, 0.025), "accent", (x + 0.22, y - 0.04, 0.402), 20, 0.002)
    box("Book", (0.20, 0.14, 0.022), "cushion", (x + 0.22, y - 0.04, 0.427), 5, 0.002)


def chair(x, y, turn):
    """A spindle-back chair."""
    frame = transform((x, y, 0), (0, 0, turn))
    wood = mat("wood")
    place("Chair seat", s.box_mesh("chair seat", (0.44, 0.42, 0.035), wood, 0.012), frame @ transform((0, 0, 0.44)))
    for dx in (-0.18, 0.18):
        for dy in (-0.17, 0.17):
            leg = s.tube_mesh("chair leg", [(dx * 1.2, dy * 1.2, 0), (dx, dy, 0.45)], 0.013, wood, 10, 0.018)
            place("Chair leg", leg, frame)
    for k in range(7):
        dx = -0.18 + 0.06 * k
        spindle = s.tube_mesh("spindle", [(dx, 0.18, 0.46), (dx * 1.15, 0.25, 0.92)], 0.008, wood, 8)
        place("Spindle", spindle, frame)
    path = s.spline([(-0.25, 0.24, 0.91), (0, 0.27, 0.94), (0.25, 0.24, 0.91)], 6)
    rail = s.tube_mesh("top rail", path, 0.022, wood, 10)
    place("Top rail", rail, frame)


def shelf(x, y, rng):
    """Open shelves with books, standing against the back wall."""
    width, depth, height = 1.1, 0.28, 1.9
    for dx in (-width / 2, width / 2):
        box("Shelf side", (0.03, depth, height), "wood", (x + dx, y, 0))
    for k in range(6):
        z = 0.06 + k * (height - 0.1) / 5
        box("Shelf board", (width - 0.03, depth, 0.025), "wood", (x, y, z))
        at = x - width / 2 + 0.03
        end = x + width / 2 - (0.06 if k % 2 else 0.35)
        while k < 5 and at < end:
            thick, tall = rng.uniform(0.02, 0.045), rng.uniform(0.19, 0.28)
            color = rng.choice(("paper", "accent", "sofa", "rug", "cushion", "picture", "wood"))
            box("Volume", (thick * 0.94, 0.19, tall), color, (at + thick / 2, y - 0.02, z + 0.025))
            at += thick


def fan_palm(x, y, rng):
    outline = s.spline([(0.13, 0, 0), (0.18, 0, 0.16), (0.19, 0, 0.34), (0.175, 0, 0.34), (0.16, 0, 0.28)], 4)
    profile = [(0, 0)] + [(p.x, p.z) for p in outline] + [(0, 0.28)]
    place("Planter", s.lathe_mesh("planter", profile, mat("pot"), 48), transform((x, y, 0)))
    leaf = s.leaf_mesh("palm leaf", 0.42, 0.05, mat("leaf"), 0.4, 0.35, 8)
    for k in range(11):
        turn = 2.4 * k
        out, high = 0.12 + 0.32 * rng.random(), rng.uniform(0.65, 1.35)
        tip = s.Vector((x + out * math.cos(turn), y + out * math.sin(turn), 0.28 + high))
        bend = (x + 0.25 * out * math.cos(turn), y + 0.25 * out * math.sin(turn), 0.28 + 0.6 * high)
        stem = s.spline([(x, y, 0.28), bend, tip], 6)
        place("Palm stem", s.tube_mesh("palm stem", stem, 0.007, mat("stem"), 6, 0.004))
        for i in range(11):
            plants.stand_leaf(leaf, tip, math.degrees(turn) - 110 + 22 * i, 25 - 4 * abs(i - 5) + rng.uniform(-6, 6),
                              rng.uniform(0.8, 1.05))


def floor_lamp(x, y):
    """An open shade around a point light: a pool above and below."""
    foot = s.lathe_mesh("lamp foot", [(0, 0), (0.15, 0), (0.15, 0.015), (0.02, 0.03), (0, 0.03)], mat("metal"), 40)
    place("Lamp foot", foot, transform((x, y, 0)))
    place("Lamp pole", s.tube_mesh("lamp pole", [(x, y, 0.02), (x, y, 1.33)], 0.011, mat("metal"), 10))
    shade = s.lathe_mesh("lamp shade", [(0.22, 0), (0.14, 0.27), (0.137, 0.27), (0.217, 0)], mat("shade"), 56)
    place("Lamp shade", shade, transform((x, y, 1.36)))
    s.point_light("Floor lamp", (x, y, 1.50), 22, 0.045, (1.0, 0.78, 0.52))


def pendant(x, y, z):
    """A disk light under a wide metal bowl that hangs on a wire."""
    profile = [(0.25, 0), (0.21, 0.09), (0.05, 0.15), (0.02, 0.22), (0.015, 0.22), (0.04, 0.14), (0.2, 0.085),
               (0.243, 0)]
    bowl = s.lathe_mesh("pendant", profile, mat("metal"), 56)
    place("Pendant", bowl, transform((x, y, z)))
    place("Wire", s.tube_mesh("wire", [(x, y, z + 0.2), (x, y, HEIGHT)], 0.006, mat("metal"), 8))
    s.area_light("Pendant", s.aim((x, y, z + 0.03), (x, y, 0)), 11, 0.34, "DISK", (1.0, 0.84, 0.62))


def spotlight(at, target):
    """A can on a ceiling track, ahead of it a spot light."""
    frame = s.aim(at, target)
    profile = [(0, 0.17), (0.045, 0.17), (0.05, 0.0), (0.046, 0.0), (0.04, 0.15), (0, 0.15)]
    can = s.lathe_mesh("spot can", profile, mat("metal"), 32)
    place("Spot can", can, frame @ transform((0, 0, 0.03)))
    ends = [frame @ s.Vector((0, 0, 0.19)), (at[0], at[1], HEIGHT)]
    place("Spot stem", s.tube_mesh("spot stem", ends, 0.008, mat("metal"), 8))
    s.spot_light("Track spot", frame, 130, 0.04, 52, 0.35, (1.0, 0.92, 0.80))


def lamps():
    floor_lamp(1.95, 1.2)
    pendant(-0.15, 0.05, 1.62)
    spotlight((0.95, -0.5, 2.38), (0.55, 1.9, 1.35))
    box("Ceiling panel", (0.66, 0.66, 0.03), "trim", (-1.35, -0.9, HEIGHT - 0.03))
    down = s.aim((-1.35, -0.9, HEIGHT - 0.035), (-1.35, -0.9, 0))
    s.area_light("Ceiling panel", down, 9, 0.6, "SQUARE", (0.86, 0.92, 1.0))
    # A wall washer: the light's own scale stretches it along the wall.
    along_wall = s.aim((WIDTH / 2 - 0.08, 0.1, 2.05), (WIDTH / 2 - 0.9, 0.1, 0.0))
    washer = s.area_light("Wall washer", along_wall, 7, (0.10, 0.40), "RECTANGLE", (1.0, 0.82, 0.6))
    washer.matrix_world = washer.matrix_world @ transform(scale=(1.0, 2.0, 1.0))
    into_room = s.aim((-1.55, DEPTH / 2 - 0.06, 1.75), (-1.1, -0.4, 0.2))
    s.area_light("Round mirror lamp", into_room, 8, (0.5, 0.2), "ELLIPSE", (1.0, 0.86, 0.7))
    s.sun_light("Evening sun", s.aim((-3.6, 0.9, 2.6), (0.2, 0.1, 0.2)), 13.0, 0.5, (1.0, 0.72, 0.42))


def build():
    rng = random.Random(5)
    shell()
    box("Rug", (2.3, 1.5, 0.012), "rug edge", (-0.1, 0.0, 0), 0, 0.005)
    box("Rug centre", (2.1, 1.3, 0.015), "rug", (-0.1, 0.0, 0), 0, 0.005)
    sofa(0.72, 1.18, -6)
    coffee_table(-0.15, 0.05)
    chair(1.18, -0.72, 148)
    chair(-1.55, -0.35, 62)
    shelf(-0.85, 1.74, rng)
    fan_palm(-1.85, 1.35, rng)
    box("Picture frame", (0.95, 0.03, 0.66), "dark wood", (0.85, DEPTH / 2 - 0.015, 1.28), 0, 0.008)
    box("Picture", (0.85, 0.034, 0.56), "picture", (0.85, DEPTH / 2 - 0.019, 1.33))
    lamps()
    s.world((0.05, 0.055, 0.07))
    s.camera((0.55, -3.35, 1.55), (-0.05, 0.5, 0.98), 24)
