# SPDX-License-Identifier: GPL-3.0-or-later
"""How fast a viewport of 960 x 540 follows input: 100,000 triangles, an area light, PCSS. Per engine the time from a
moved lamp to the changed display, pictures per second while the view orbits, the longest time that Blender's event loop
did not run, and what share of the region's width the first picture has. Times are only comparable within one run, so it
is no part of the tests; in all versions with tests/blender/matrix.sh build --window latency:

    sh tests/blender/run.sh build --window latency
    LATENCY_ENGINES="PENUMBRA NOTHING" LATENCY_MS=100 sh tests/blender/run.sh build --window latency
"""

import math
import mmap
import os
import statistics
import threading
import time
from math import cos, pi, sin

import bpy
import gpu
from mathutils import Quaternion

from window import ViewportTest

from penumbra import viewport

BALLS, RINGS = 10, 71            # each ball has 2 * RINGS * (RINGS - 1) triangles
MOVES, ORBIT_SECONDS, QUIET = 15, 6.0, 0.7
# From the side, a little above: where a new file looks from.
VIEW = 0.716, 0.439, 0.291, 0.459
# With first pictures of all pixels; as small as the user's latency asks for; one colour: what Blender itself takes.
ENGINES = {'PENUMBRA': 'PENUMBRA', 'TARGET': 'PENUMBRA', 'EEVEE': None, 'CYCLES': 'CYCLES',
           'NOTHING': 'LATENCY_NOTHING'}
CHOSEN = os.environ.get('LATENCY_ENGINES', 'PENUMBRA TARGET EEVEE NOTHING').split()
# Performance > Latency of TARGET, milliseconds.
TARGET_MS = int(os.environ.get('LATENCY_MS', 150))


class Nothing(bpy.types.RenderEngine):
    """One colour, another at every drawing: what Blender itself takes to show what an engine drew."""
    bl_idname = 'LATENCY_NOTHING'
    bl_label = "Nothing"
    count = 0

    def view_update(self, _context, _depsgraph):
        pass

    def view_draw(self, _context, _depsgraph):
        Nothing.count += 1
        gpu.state.active_framebuffer_get().clear(color=(0.1 * (Nothing.count % 10), 0.5, 0.5, 1.0))


class Display(threading.Thread):
    """Looks every 2 ms at some rows in the middle of the display."""

    def __init__(self):
        super().__init__(daemon=True)
        file = open(os.path.join(os.environ['TEST_DISPLAY'], 'Xvfb_screen0'), 'rb')
        self._memory = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
        size = len(self._memory)
        self._rows = [slice(int(size * share), int(size * share) + 960 * 4) for share in (0.4, 0.5, 0.55, 0.6, 0.65)]
        self.changes = []
        self.start()

    def run(self):
        before = None
        while True:
            now = [self._memory[row] for row in self._rows]
            if now != before:
                self.changes.append(time.perf_counter())
                before = now
            time.sleep(0.002)


def ball(number):
    vertices, faces = [], []
    for ring in range(RINGS + 1):
        for step in range(RINGS):
            across = sin(pi * ring / RINGS)
            vertices.append((across * cos(2 * pi * step / RINGS), across * sin(2 * pi * step / RINGS),
                             cos(pi * ring / RINGS)))
    for ring in range(RINGS):
        for step in range(RINGS):
            corners = [ring * RINGS + step, (ring + 1) * RINGS + step, (ring + 1) * RINGS + (step + 1) % RINGS,
                       ring * RINGS + (step + 1) % RINGS]
            faces.append(corners[1:] if ring == 0 else corners[:3] if ring == RINGS - 1 else corners)
    mesh = bpy.data.meshes.new(f"Ball {number}")
    mesh.from_pydata(vertices, [], faces)
    return mesh


def add(data, location=(0, 0, 0), scale=(1, 1, 1), rotation=(0, 0, 0)):
    ob = bpy.data.objects.new(data.name, data)
    ob.location, ob.scale, ob.rotation_euler = location, scale, rotation
    bpy.context.scene.collection.objects.link(ob)
    return ob


def make_scene():
    floor = bpy.data.meshes.new("Floor")
    floor.from_pydata([(-8, -8, 0), (8, -8, 0), (8, 8, 0), (-8, 8, 0)], [], [(0, 1, 2, 3)])
    add(floor)
    for number in range(BALLS):
        angle = 2 * pi * number / BALLS
        add(ball(number), (3 * cos(angle), 3 * sin(angle), 0.8), (0.7, 0.7, 0.7))
    light = bpy.data.lights.new("Lamp", 'AREA')
    light.energy, light.size = 500.0, 1.0
    bpy.context.scene.world = None
    return add(light, (0, 0, 5))


def wait(seconds):
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        yield 'soon'


def wait_quiet(display):
    """Until the display did not change for a while."""
    while not display.changes or time.perf_counter() - display.changes[-1] < QUIET:
        yield 'soon'


class Blocked:
    """The longest time that the event loop did not run."""

    def __init__(self):
        self.reset()

    def reset(self):
        self.longest, self._last = 0.0, time.perf_counter()

    def tick(self):
        now = time.perf_counter()
        self.longest, self._last = max(self.longest, now - self._last), now


def measure_moves(display, lamp, blocked):
    times, longest = [], []
    for number in range(MOVES):
        # After some moves at rest, some while samples are being added.
        yield from wait_quiet(display) if number % 3 else wait(0.3)
        count, start = len(display.changes), time.perf_counter()
        blocked.reset()
        lamp.location.x = 0.4 * math.sin(number + 1.0)
        while len(display.changes) == count:
            yield 'soon'
        times.append(display.changes[count] - start)
        longest.append(blocked.longest)
    return times[1:], longest[1:]


def measure_orbit(display, region_3d, blocked):
    start = region_3d.view_rotation.copy()
    yield from wait_quiet(display)
    count, begin = len(display.changes), time.perf_counter()
    blocked.reset()
    while time.perf_counter() - begin < ORBIT_SECONDS:
        angle = 0.5 * (time.perf_counter() - begin)
        region_3d.view_rotation = Quaternion((0, 0, 1), angle) @ start
        yield 'soon'
    return (len(display.changes) - count) / (time.perf_counter() - begin), blocked.longest


def first_scale(name):
    """Of the last first picture's width and height."""
    if ENGINES[name] != 'PENUMBRA':
        return ''
    return max((shown._speed._last or 0.0 for shown in viewport._viewports), default='')


def eevee():
    return 'BLENDER_EEVEE_NEXT' if (4, 2) <= bpy.app.version < (5, 0) else 'BLENDER_EEVEE'


class Latency(ViewportTest):
    def setUp(self):
        super().setUp()
        bpy.utils.register_class(Nothing)
        self.addCleanup(bpy.utils.unregister_class, Nothing)
        self.display, self.blocked = Display(), Blocked()
        self.lamp = make_scene()
        self.scene.penumbra.technique = 'PCSS'
        self.scene.penumbra.viewport_samples = 16
        self.scene.penumbra.property_unset('shadow_map_size')
        if hasattr(self.scene, 'eevee'):
            self.scene.eevee.taa_samples = 16
        self.look(distance=14.0, rotation=VIEW)

    def test_latency(self):
        print(f"{2 * RINGS * (RINGS - 1) * BALLS + 2} triangles, TARGET has a latency of {TARGET_MS} ms")
        print(f"{'engine':<10}{'lamp to pixels, ms: median':>28}{'worst':>8}{'orbit, 1/s':>12}"
              f"{'longest block, ms':>20}  scale")
        for name in CHOSEN:
            for _ in self.measure(name):
                self.blocked.tick()
                yield 'soon'

    def measure(self, name):
        self.scene.render.engine = ENGINES[name] or eevee()
        self.scene.penumbra.viewport_latency = TARGET_MS if name == 'TARGET' else 2000
        yield from wait(2.0)
        yield from wait_quiet(self.display)
        times, longest = yield from measure_moves(self.display, self.lamp, self.blocked)
        rate, block = yield from measure_orbit(self.display, self.region_3d(), self.blocked)
        print(f"{name:<10}{1000 * statistics.median(times):>28.0f}{1000 * max(times):>8.0f}{rate:>12.1f}"
              f"{1000 * max(block, *longest):>20.0f}  {first_scale(name)}", flush=True)
