# SPDX-License-Identifier: GPL-3.0-or-later
"""A window with one 3D viewport and nothing else, for tests that look at what it shows."""

import math
import time

import bpy

import display
from harness import SceneTest, output, read_byte_image

from penumbra import viewport

# Seconds that anything may take; a machine may be busy with other things.
PATIENCE = 600
# In camera view the camera's frame then is the whole region, if it has the region's shape.
CAMERA_ZOOM = 50.0 * (2.0 - math.sqrt(2.0))


def wait_until(condition, what):
    limit = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > limit:
            raise AssertionError(f"waited {PATIENCE} s for {what}")
        yield 'wait'


class ViewportTest(SceneTest):
    """Starts from an empty scene for PENUMBRA that is shown in a rendered viewport without overlays."""

    def setUp(self):
        super().setUp()
        self.scene.penumbra.viewport_samples = 2
        self.scene.penumbra.shadow_map_size = 128
        self.show()

    def show(self):
        """Lets a viewport without panels and overlays fill the window."""
        self.scene = bpy.context.window_manager.windows[0].scene
        with self.window():
            if not bpy.context.screen.show_fullscreen:
                with bpy.context.temp_override(area=self.area()):
                    bpy.ops.screen.screen_full_area(use_hide_panels=True)
        space = self.space()
        space.overlay.show_overlays = space.show_gizmo = False
        space.shading.type = 'RENDERED'

    # ---- Places ----

    def window(self):
        return bpy.context.temp_override(window=bpy.context.window_manager.windows[0])

    def area(self):
        screen = bpy.context.window_manager.windows[0].screen
        return max((area for area in screen.areas if area.type == 'VIEW_3D'), key=lambda area: area.width * area.height)

    def space(self):
        return self.area().spaces.active

    def region(self):
        return max((region for region in self.area().regions if region.type == 'WINDOW'),
                   key=lambda region: region.width * region.height)

    def region_3d(self):
        return self.space().region_3d

    def in_viewport(self):
        """Context for operators of the viewport."""
        return bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=self.area(),
                                         region=self.region())

    def look(self, distance=9.0, rotation=(0.8, 0.3, 0.35, 0.35)):
        region_3d = self.region_3d()
        region_3d.view_perspective = 'PERSP'
        region_3d.view_location = 0.0, 0.0, 0.0
        region_3d.view_rotation = rotation
        region_3d.view_distance = distance

    def look_through_camera(self):
        """The picture of the camera has the region's pixels."""
        render, region = self.scene.render, self.region()
        render.resolution_x, render.resolution_y = region.width, region.height
        region_3d = self.region_3d()
        region_3d.view_perspective = 'CAMERA'
        region_3d.view_camera_zoom = CAMERA_ZOOM
        region_3d.view_camera_offset = 0.0, 0.0

    # ---- Pictures ----

    def settle(self):
        """Until every viewport shows its last picture."""
        for _ in range(3):      # what was just changed reaches the viewport with the next drawing
            self.area().tag_redraw()
            yield 'draw'
        yield from wait_until(viewport.all_at_rest, "viewports to come to rest")
        before = None
        while before != display.dump():     # what was drawn last reaches the display later
            before = display.dump()
            for _ in range(5):
                yield 'draw'

    def screenshot(self, name, region=None):
        """The viewport's part of the display, or another region's; also kept as a file to look at."""
        region = region or self.region()
        picture = display.read().cut(region.x, region.y, region.width, region.height)
        picture.save(output(name + '.ppm'))
        return picture

    def shown(self, name):
        """Screenshot once all is shown."""
        yield from self.settle()
        return self.screenshot(name)

    def start_anew(self):
        """A new engine, which knows nothing of the past."""
        self.space().shading.type = 'SOLID'
        for _ in range(3):
            yield 'draw'
        self.space().shading.type = 'RENDERED'

    def still(self, name):
        """Path of the same picture by F12."""
        settings = self.scene.render.image_settings
        if hasattr(settings, 'media_type'):
            settings.media_type = 'IMAGE'
        settings.file_format = 'PNG'
        settings.color_mode, settings.color_depth = 'RGB', '8'
        self.scene.render.filepath = output(name + '.png')
        with self.window():
            bpy.ops.render.render(write_still=True)
        return output(name + '.png')


def read_picture(path):
    width, height, pixels = read_byte_image(path)
    rows = [pixels[4 * row * width:4 * (row + 1) * width] for row in reversed(range(height))]
    return display.Picture(width, height, bytes(int(255.0 * value + 0.5) for row in rows
                                                for index, value in enumerate(row) if index % 4 != 3))


def psnr(first, second):
    """Decibels between two pictures of equal size."""
    assert first[:2] == second[:2], (first[:2], second[:2])
    error = sum((a - b) ** 2 for a, b in zip(first.rgb, second.rgb)) / len(first.rgb)
    return 10.0 * math.log10(255.0 ** 2 / error) if error else math.inf
