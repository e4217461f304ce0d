# SPDX-License-Identifier: GPL-3.0-or-later
"""Several windows, each with a scene and a viewport of its own."""

import bpy

from harness import add_cube
from window import ViewportTest

from penumbra import viewport


class Windows(ViewportTest):
    def setUp(self):
        super().setUp()
        self.earlier = list(viewport._viewports)    # of other tests, which Blender has not freed yet
        self.still_life()
        self.look()
        self.other = bpy.data.scenes.new("Other")
        self.other.render.engine = 'PENUMBRA'

    def frames(self, count):
        for _ in range(count):
            for window in bpy.context.window_manager.windows:
                for area in window.screen.areas:
                    area.tag_redraw()
            yield 'draw'

    def shown(self):
        """Number of objects in each viewport, all of which show a picture of them and nothing wrong."""
        viewports = [each for each in viewport._viewports if each not in self.earlier]
        for each in viewports:
            self.assertEqual(each._error, '')
            self.assertIsNotNone(each._picture)
            self.assertEqual(each._wanted.version, each._version)
        return sorted(each._exported.scene.instance_count for each in viewports)

    def test_two_scenes(self):
        yield from self.settle()
        before = self.shown()
        manager = bpy.context.window_manager
        with self.window():     # a full-screen viewport opens no window
            bpy.ops.screen.back_to_previous()
            yield from self.frames(3)
        with bpy.context.temp_override(window=manager.windows[0], area=self.area()):
            bpy.ops.wm.window_new_main()
        yield from self.frames(5)
        manager.windows[1].scene = self.other
        for area in manager.windows[1].screen.areas:
            if area.type == 'VIEW_3D':
                area.spaces.active.shading.type = 'RENDERED'
        yield from self.frames(5)
        yield from self.settle()
        self.assertEqual(self.shown(), [0] + before)
        cube = add_cube("Guest", location=(0, 0, 1), half=0.2)
        yield from self.frames(2)
        yield from self.settle()
        self.assertEqual(self.shown(), [0, before[0] + 1])
        self.scene.collection.objects.unlink(cube)
        self.other.collection.objects.link(cube)
        yield from self.frames(2)
        yield from self.settle()
        self.assertEqual(self.shown(), [1] + before)
        with bpy.context.temp_override(window=manager.windows[1]):
            bpy.ops.wm.window_close()
        yield from self.frames(3)
        yield from self.settle()
        self.assertEqual(self.shown(), before)
