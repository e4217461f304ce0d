# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender (CONTRIBUTING.md says how): times of exports of large scenes, medians of five, and the memory
they take. Compare them with others of the same machine only."""

import cProfile
import os
import pstats
import statistics
import sys
import time

import addon_utils
import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from harness import ADDON, add_camera, add_light, add_object, add_plane, white_material  # noqa: E402

OBJECTS, SIDE, INSTANCES, LIGHTS = 200, 57, 10000, 64      # 2 x 57 x 57 x 200 = 1.3 million triangles


def milliseconds(action, count=5):
    times = []
    for _ in range(count):
        start = time.perf_counter()
        action()
        times.append(1000.0 * (time.perf_counter() - start))
    return statistics.median(times)


def resident_bytes():
    with open('/proc/self/statm', encoding='ascii') as file:
        return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE')


def grid(name, side):
    """A rolling surface of side x side quads with a UV map."""
    mesh = bpy.data.meshes.new(name)
    points = [(x / side, y / side, 0.1 * ((x * y + len(name)) % 7) / side)
              for y in range(side + 1) for x in range(side + 1)]
    row = side + 1
    corners = (y * row + x for y in range(side) for x in range(side))
    faces = [(i, i + 1, i + row + 1, i + row) for i in corners]
    mesh.from_pydata(points, [], faces)
    mesh.uv_layers.new()
    mesh.materials.append(bpy.data.materials[0])
    return mesh


def new_scene():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.engine = 'PENUMBRA'
    scene.render.resolution_x, scene.render.resolution_y = 320, 180
    scene.penumbra.samples = 1
    white_material()
    add_light("Key", 'SUN', energy=2, rotation=(0.4, 0.3, 0))
    add_camera(location=(7, 5, 30))
    return scene


RESULTS = []


def report(text, value, unit, limit):
    RESULTS.append(value <= limit)
    verdict = 'ok    ' if value <= limit else 'MISSED'
    print(f"SCALE {verdict} {text}: {value:.1f} {unit} (limit {limit} {unit})", flush=True)


def export_ms(addon, kept=None):
    """Makes and ends an export."""
    def action():
        depsgraph = bpy.context.evaluated_depsgraph_get()
        if kept:
            kept.begin(addon.geometry.changed_data(depsgraph))
        addon.export.SceneExport(depsgraph, kept=kept).close()
        if kept:
            kept.end()
    return action


def many_triangles(addon):
    new_scene()
    for number in range(OBJECTS):
        add_object(f"Grid {number}", grid(f"Grid {number}", SIDE), location=(number % 20 * 1.1, number // 20 * 1.1, 0))
    bpy.context.evaluated_depsgraph_get()
    before = resident_bytes()
    start = time.perf_counter()
    first = addon.export.SceneExport(bpy.context.evaluated_depsgraph_get())
    report("1.3 million triangles in 200 objects, first export", 1000.0 * (time.perf_counter() - start), "ms", 1500)
    data = sum(12 * len(mesh.vertices) + len(mesh.loops) * (4 + 8 + 12) + 12 * 2 * len(mesh.polygons)
               for mesh in bpy.data.meshes)     # positions, corners, UV, normals, triangles
    report("memory of the library's meshes over that of the mesh data", (resident_bytes() - before) / data, "times", 3)
    first.close()
    profile = cProfile.Profile()
    profile.runcall(export_ms(addon))
    print("Where the time of an export goes:")
    pstats.Stats(profile, stream=sys.stdout).strip_dirs().sort_stats('tottime').print_stats(6)
    moved_object(addon)


def moved_object(addon):
    """As a viewport does it: with what was kept of the export before."""
    kept = addon.geometry.Kept()
    times = []
    for number in range(6):
        bpy.data.objects["Grid 7"].location.z = number
        depsgraph = bpy.context.evaluated_depsgraph_get()
        start = time.perf_counter()
        kept.begin(None if number == 0 else set())   # a move changes no geometry
        addon.export.SceneExport(depsgraph, kept=kept).close()
        kept.end()
        times.append(1000.0 * (time.perf_counter() - start))
    kept.close()
    report("the same with one object moved", statistics.median(times[1:]), "ms", 20)


def many_instances(addon):
    new_scene()
    source = add_object("Source", grid("Leaf", 4))
    parent = add_plane("Cloud", half=50)
    parent.data.clear_geometry()
    parent.data.from_pydata([(x % 100, x // 100, 0) for x in range(INSTANCES)], [], [])
    parent.instance_type, source.parent = 'VERTS', parent
    bpy.context.evaluated_depsgraph_get()
    report("10,000 instances of one mesh", milliseconds(export_ms(addon)), "ms", 100)


def many_lights(addon):
    scene = new_scene()
    add_plane(half=20).data.materials.append(bpy.data.materials[0])
    for number in range(LIGHTS - 1):
        add_light(f"Lamp {number}", 'POINT', location=(number % 8, number // 8, 1), energy=5)
    report("64 lights, export", milliseconds(export_ms(addon)), "ms", 20)
    start = time.perf_counter()
    bpy.ops.render.render(scene=scene.name)
    print(f"SCALE        64 lights, F12 of 320 x 180: {time.perf_counter() - start:.2f} s")


def main():
    if addon_utils.enable(ADDON, default_set=True) is None:
        sys.exit("the add-on cannot be enabled")
    addon = sys.modules[ADDON]
    for measure in (many_triangles, many_instances, many_lights):
        measure(addon)
    print(f"{sum(RESULTS)} passed, {len(RESULTS) - sum(RESULTS)} failed", flush=True)
    sys.exit(not all(RESULTS))


main()
