# SPDX-License-Identifier: GPL-3.0-or-later
"""Random edits of a scene that a viewport shows, with undo and F12 in between: no crash, no exception, no growth, and
in the end the picture of a new viewport. Takes minutes, so it is no part of the tests:

    sh tests/blender/run.sh build --window soak
    SOAK_EDITS=200 SOAK_SEED=7 sh tests/blender/run.sh build --window soak
"""

import ctypes
import os
import random

import bpy

from harness import add_cube, add_light, white_material
from window import ViewportTest

from penumbra import viewport

EDITS = int(os.environ.get('SOAK_EDITS', 2000))
SEED = int(os.environ.get('SOAK_SEED', 1))
# Edits after which memory must not grow: Blender's undo stack and all caches are full then.
WARM = min(600, EDITS // 2)
STILLS_EVERY = 100
MOST_OBJECTS = 12


def give_back_free_memory():
    """What Blender's allocator keeps of freed memory is no growth: TBB's (5.2) keeps up to 70 MiB of it."""
    process = ctypes.CDLL(None)
    if hasattr(process, 'mallctl'):         # jemalloc
        process.mallctl(b'arena.4096.purge', None, None, None, ctypes.c_size_t(0))
    elif hasattr(process, 'scalable_allocation_command'):
        process.scalable_allocation_command(0, None)
    else:
        process.malloc_trim(0)


def resident_megabytes():
    with open('/proc/self/statm', encoding='ascii') as file:
        return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE') / 2 ** 20


class Soak(ViewportTest):
    def setUp(self):
        super().setUp()
        self.scene.render.preview_pixel_size = '4'
        self.still_life()
        self.look()
        self.random = random.Random(SEED)
        self.failures = []
        original = viewport.Viewport._fail

        def fail(shown, error):
            self.failures.append(repr(error))
            original(shown, error)
        viewport.Viewport._fail = fail
        self.addCleanup(setattr, viewport.Viewport, '_fail', original)

    def scene_now(self):
        """Undo replaces the scene's data."""
        return bpy.context.window_manager.windows[0].scene

    def objects(self, kind):
        return [ob for ob in self.scene_now().objects if ob.type == kind]

    # ---- Edits ----

    def add_object(self):
        if len(self.scene_now().objects) > MOST_OBJECTS:
            self.delete()
        elif self.random.random() < 0.3:
            add_light("Light", self.random.choice(['AREA', 'POINT', 'SPOT', 'SUN']), self.place(3.0), energy=20.0)
        else:
            material = bpy.data.materials.get("White") or white_material()
            add_cube(location=self.place(0.5)).data.materials.append(material)

    def delete(self):
        objects = self.objects('MESH') + self.objects('LIGHT')
        if objects:
            ob = self.random.choice(objects)
            owner = bpy.data.meshes if ob.type == 'MESH' else bpy.data.lights
            owner.remove(ob.data)   # and the object with it: unused data would be memory that grows

    def move(self):
        for ob in self.objects('MESH')[:1] + self.objects('LIGHT')[:1]:
            ob.location = self.place(ob.location.z)

    def hide(self):
        objects = self.objects('MESH') + self.objects('LIGHT')
        if objects:
            ob = self.random.choice(objects)
            if self.random.random() < 0.5:
                ob.hide_viewport = not ob.hide_viewport
            else:
                ob.hide_set(not ob.hide_get())

    def resize(self):
        for ob in self.objects('LIGHT'):
            if ob.data.type == 'AREA':
                ob.data.size = self.random.uniform(0.1, 3.0)
        for ob in self.objects('MESH')[:1]:
            ob.data.vertices[0].co.x = self.random.uniform(-1.0, 0.0)
            ob.data.update()

    def orbit(self):
        self.region_3d().view_distance = self.random.uniform(5.0, 15.0)

    def switch_mode(self):
        meshes = [ob for ob in self.objects('MESH') if ob.visible_get()]
        with self.in_viewport():
            active = bpy.context.view_layer.objects.active
            if active and active.mode == 'EDIT':
                bpy.ops.object.mode_set(mode='OBJECT')
            elif meshes:
                bpy.context.view_layer.objects.active = self.random.choice(meshes)
                bpy.ops.object.mode_set(mode='EDIT')

    def switch_shading(self):
        shading = self.space().shading
        shading.type = 'SOLID' if shading.type == 'RENDERED' else 'RENDERED'

    def switch_technique(self):
        items = self.scene_now().penumbra.bl_rna.properties['technique'].enum_items
        self.scene_now().penumbra.technique = self.random.choice([item.identifier for item in items
                                                                  if item.identifier != 'REFERENCE'])

    def undo(self):
        with self.in_viewport():
            if bpy.ops.ed.undo.poll():
                bpy.ops.ed.undo()
            if self.scene_now().render.engine != 'PENUMBRA' and bpy.ops.ed.redo.poll():
                bpy.ops.ed.redo()       # that was the first of all edits, the making of this scene

    def redo(self):
        with self.in_viewport():
            if bpy.ops.ed.redo.poll():
                bpy.ops.ed.redo()

    def next_frame(self):
        scene = self.scene_now()
        scene.frame_set(scene.frame_current + 1)

    def place(self, z):
        return self.random.uniform(-2.0, 2.0), self.random.uniform(-2.0, 2.0), z

    def object_mode(self):
        with self.in_viewport():
            active = bpy.context.view_layer.objects.active
            if active and active.mode == 'EDIT':
                bpy.ops.object.mode_set(mode='OBJECT')

    def edit(self):
        action = self.random.choice([self.add_object, self.delete, self.move, self.move, self.hide, self.resize,
                                     self.orbit, self.switch_mode, self.switch_shading, self.switch_technique,
                                     self.undo, self.undo, self.redo, self.next_frame])
        if action in (self.delete, self.add_object):
            self.object_mode()
        action()
        if action not in (self.undo, self.redo, self.orbit):
            with self.in_viewport():
                bpy.ops.ed.undo_push(message=action.__name__)

    # ---- The test ----

    def fill_caches(self):
        """Shows the largest scene that edits can lead to by every technique: what stays afterwards is no growth."""
        for kind in ('AREA', 'POINT', 'SPOT', 'SUN'):
            add_light(kind, kind, self.place(3.0), energy=20.0)
        while len(self.scene.objects) <= MOST_OBJECTS:
            add_cube(location=self.place(0.5))
        for item in self.scene.penumbra.bl_rna.properties['technique'].enum_items:
            if item.identifier != 'REFERENCE':
                self.scene.penumbra.technique = item.identifier
                yield from self.settle()
                self.still("soak")

    def render(self):
        self.object_mode()
        self.scene = self.scene_now()
        if not self.scene.camera:       # undone
            self.still_life()
        self.scene.render.resolution_x, self.scene.render.resolution_y = 64, 48
        self.still("soak")
        yield from self.settle()

    def memory(self):
        """While the simplest technique is shown: what others hold for their pictures, up to 50 MiB of MULTILAYER's,
        is no growth."""
        options = self.scene_now().penumbra
        technique, options.technique = options.technique, 'HARD'
        self.space().shading.type = 'RENDERED'
        yield from self.render()
        give_back_free_memory()
        megabytes = resident_megabytes()
        self.scene.penumbra.technique = technique
        return megabytes

    def test_soak(self):
        warm = None
        yield from self.fill_caches()
        with self.in_viewport():
            bpy.ops.ed.undo_push(message="filled")
        print(f"filled: {resident_megabytes():.0f} MiB", flush=True)
        for number in range(EDITS):
            self.edit()
            # From several edits before a redraw to a picture at rest.
            for _ in range(self.random.choice([0, 0, 1, 2, 5])):
                yield 'draw'
            if number % STILLS_EVERY == STILLS_EVERY - 1:
                yield from self.render()
                print(f"{number + 1} edits, {resident_megabytes():.0f} MiB", flush=True)
            if number + 1 == WARM:
                warm = yield from self.memory()
        end = yield from self.memory()
        self.assertEqual(self.failures, [])
        self.assertEqual(self.scene_now().render.engine, 'PENUMBRA')
        self.space().shading.type = 'RENDERED'
        last = yield from self.shown("soak-last")
        yield from self.start_anew()
        self.assertTrue(last == (yield from self.shown("soak-fresh")))
        print(f"memory after {WARM} edits {warm:.0f} MiB, after {EDITS} {end:.0f} MiB")
        self.assertLessEqual(end, 1.05 * warm)
