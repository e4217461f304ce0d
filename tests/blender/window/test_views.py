# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a viewport looks, what part of it is rendered, and what it says when it cannot."""

import bpy
import mathutils
from bpy_extras.view3d_utils import location_3d_to_region_2d

from harness import ADDON, add_light, add_world
from window import ViewportTest, psnr, read_picture

from penumbra import capi, draw, view, viewport

POINTS = [(0.0, 0.0, 0.0), (1.0, 0.5, 0.2), (-0.7, 1.1, 0.9), (0.3, -1.2, -0.5)]


def pixel(seen, point):
    """Where the library's camera sees a point."""
    matrix = mathutils.Matrix([seen.matrix[row::4] for row in range(4)])
    x, y, z = (matrix.inverted() @ mathutils.Vector((*point, 1.0))).xyz
    if seen.projection == capi.PERSPECTIVE:
        x, y = x / -z, y / -z
    left, right, bottom, top = seen.window
    return (x - left) / (right - left) * seen.width, (y - bottom) / (top - bottom) * seen.height


class Matrices(ViewportTest):
    """The library sees every point at the pixel where Blender shows it."""

    def setUp(self):
        super().setUp()
        self.still_life()

    def check(self, name):
        yield from self.settle()
        with self.in_viewport():
            seen = view.read(bpy.context, self.scene)
        for point in POINTS:
            wanted = location_3d_to_region_2d(self.region(), self.region_3d(), point)
            found = mathutils.Vector(pixel(seen, point))
            # Single-precision matrices over 640 pixels.
            self.assertLess((found - wanted).length, 0.02, f"{name}: {found} instead of {wanted}")
        self.assertGreater(seen.clip_end, seen.clip_start)
        self.assertGreater(seen.clip_start, 0.0)

    def test_views(self):
        region_3d = self.region_3d()
        self.look()
        yield from self.check("perspective")
        region_3d.view_perspective = 'ORTHO'
        yield from self.check("orthographic")
        camera = bpy.data.objects["Camera"]
        camera.location, camera.rotation_euler = (0.5, -5.0, 5.0), (0.7, 0.1, 0.2)
        self.scene.render.resolution_x, self.scene.render.resolution_y = 200, 300
        self.scene.render.pixel_aspect_x = 1.5
        region_3d.view_perspective = 'CAMERA'
        for zoom, offset, shift, kind in ((0.0, (0.0, 0.0), (0.0, 0.0), 'PERSP'),
                                          (12.0, (0.1, -0.05), (0.2, 0.1), 'PERSP'),
                                          (-8.0, (-0.1, 0.07), (-0.1, 0.3), 'ORTHO')):
            region_3d.view_camera_zoom, region_3d.view_camera_offset = zoom, offset
            camera.data.shift_x, camera.data.shift_y = shift
            camera.data.type = kind
            yield from self.check(f"camera {zoom} {offset} {shift} {kind}")


class Regions(ViewportTest):
    def setUp(self):
        super().setUp()
        self.still_life()
        self.look()

    def test_orthographic_equals_still(self):
        """A view from above or from the front, where the floor is a line, is one of an orthographic camera; see
        test_equals_still for the limit."""
        add_light("Front", 'POINT', location=(-1.0, -4.0, 2.0), energy=200.0)
        region_3d = self.region_3d()
        region_3d.view_perspective = 'ORTHO'
        camera = bpy.data.objects["Camera"]
        camera.data.type = 'ORTHO'
        camera.rotation_mode = 'QUATERNION'
        self.scene.penumbra.samples = self.scene.penumbra.viewport_samples
        for name, rotation, location in (("above", (1.0, 0.0, 0.0, 0.0), (0, 0, 8)),
                                         ("front", (0.5 ** 0.5, 0.5 ** 0.5, 0.0, 0.0), (0, -8, 0))):
            region_3d.view_rotation = camera.rotation_quaternion = rotation
            camera.location = location
            shown = yield from self.shown("orthographic-" + name)
            of_cube = 3 * (shown.width * (shown.height // 2 - 20) + shown.width // 2)
            self.assertGreater(min(shown.rgb[of_cube:of_cube + 3]), 60, f"{name}: the cube is lit")
            left, right, _bottom, _top = self.read_view().window
            camera.data.ortho_scale = right - left
            render = self.scene.render
            render.resolution_x, render.resolution_y = shown.width, shown.height
            still = read_picture(self.still("orthographic-still-" + name))
            self.assertGreaterEqual(psnr(shown, still), 40.0, name)

    def read_view(self):
        with self.in_viewport():
            return view.read(bpy.context, self.scene)

    def check_border(self, whole, part, bounds):
        """Inside as without border, nothing outside; beside the dashes of Blender's own outline."""
        left, right, bottom, top = bounds
        x, y = int(left * whole.width + 0.5), int(bottom * whole.height + 0.5)
        width, height = int(right * whole.width + 0.5) - x, int(top * whole.height + 0.5) - y
        inside = x + 2, y + 2, width - 4, height - 4
        # At most a rounding of the position at which the picture is drawn.
        self.assertGreaterEqual(psnr(part.cut(*inside), whole.cut(*inside)), 60.0)
        for outside in ((0, 0, whole.width, y - 2), (0, 0, x - 2, whole.height),
                        (x + width + 2, 0, whole.width - x - width - 2, whole.height)):
            self.assertLessEqual(len(set(part.cut(*outside).rgb)), 60, "more than a background's gradient")
            self.assertNotEqual(part.cut(*outside), whole.cut(*outside))

    def test_border_of_region(self):
        whole = yield from self.shown("whole")
        space = self.space()
        space.use_render_border = True
        space.render_border_min_x, space.render_border_max_x = 0.25, 0.75
        space.render_border_min_y, space.render_border_max_y = 0.25, 0.75
        self.check_border(whole, (yield from self.shown("part")), (0.25, 0.75, 0.25, 0.75))

    def test_border_of_camera(self):
        self.look_through_camera()
        whole = yield from self.shown("whole")
        render = self.scene.render
        render.use_border = True
        render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.25, 0.75
        self.check_border(whole, (yield from self.shown("part")), (0.25, 0.75, 0.25, 0.75))

    def test_quad_view(self):
        add_world((0.2, 0.3, 0.4))
        add_light("Sun", 'SUN', rotation=(0.9, 0.3, 0.0), energy=2.0)
        with self.in_viewport():
            bpy.ops.screen.region_quadview()
        yield from self.settle()
        regions = [region for region in self.area().regions if region.type == 'WINDOW']
        self.assertEqual(len(regions), 4)
        pictures = [self.screenshot(f"quad-{number}", region) for number, region in enumerate(regions)]
        for number, picture in enumerate(pictures):
            middle = 3 * (picture.width * picture.height // 2 + picture.width // 2)
            self.assertNotEqual(picture.rgb[:3], picture.rgb[middle:middle + 3],
                                f"region {number} shows nothing in its middle")
        self.assertEqual(len({picture.rgb for picture in pictures}), 4)

    def test_resize(self):
        large = yield from self.shown("large")
        with self.in_viewport():
            bpy.ops.screen.screen_full_area(use_hide_panels=True)
        small = yield from self.shown("small")
        self.assertLess(small.width, large.width)
        yield from self.start_anew()
        self.assertTrue(small == (yield from self.shown("small-fresh")))

    def test_local_view(self):
        cube = bpy.data.objects["Cube"]
        whole = yield from self.shown("global")
        cube.select_set(True)
        bpy.context.view_layer.objects.active = cube
        with self.in_viewport():
            bpy.ops.view3d.localview(frame_selected=False)
        local = yield from self.shown("local")
        self.assertFalse(local == whole)
        with self.in_viewport():
            bpy.ops.view3d.localview(frame_selected=False)
        self.assertTrue(whole == (yield from self.shown("global again")))

    def test_object_types(self):
        """By the popover of object types, for this viewport only."""
        whole = yield from self.shown("types")
        shown = [whole]
        for kind in ('light', 'mesh'):
            setattr(self.space(), 'show_object_viewport_' + kind, False)
            shown.append((yield from self.shown(f"types without {kind}")))
            setattr(self.space(), 'show_object_viewport_' + kind, True)
        self.assertEqual(len({picture.rgb for picture in shown}), 2)    # without either there is nothing to see
        self.assertTrue(whole == (yield from self.shown("types again")))

    def test_local_collections(self):
        """Collections that are hidden in one viewport."""
        cube, group = bpy.data.objects["Cube"], bpy.data.collections.new("Group")
        self.scene.collection.children.link(group)
        group.objects.link(cube)
        self.scene.collection.objects.unlink(cube)
        whole = yield from self.shown("collections")
        self.space().use_local_collections = True
        self.assertTrue(whole == (yield from self.shown("local collections")))
        with self.in_viewport():
            bpy.ops.object.hide_collection(collection_index=1, toggle=True)
        hidden = yield from self.shown("hidden collection")
        self.assertFalse(whole == hidden)
        yield from self.start_anew()
        self.assertTrue(hidden == (yield from self.shown("hidden collection, fresh")))
        self.space().use_local_collections = False
        self.assertTrue(whole == (yield from self.shown("no local collections")))

    def test_at_rest_nothing_runs(self):
        yield from self.settle()
        self.assertFalse(bpy.app.timers.is_registered(viewport._tick))

    def test_separate_viewports(self):
        """Two areas with views of their own follow one scene."""
        with self.in_viewport():
            bpy.ops.screen.screen_full_area(use_hide_panels=True)
        yield 'draw'
        areas = bpy.context.window_manager.windows[0].screen.areas
        other = max((area for area in areas if area.type != 'VIEW_3D'), key=lambda area: area.width * area.height)
        self.addCleanup(setattr, other, 'type', other.type)
        other.type = 'VIEW_3D'
        spaces = self.space(), other.spaces.active
        for space in spaces:
            space.overlay.show_overlays = space.show_gizmo = False
            space.shading.type = 'RENDERED'
        spaces[1].region_3d.view_rotation = 0.9, 0.4, 0.0, 0.1
        spaces[1].region_3d.view_distance = 6.0
        before = yield from self.both("before", other)
        bpy.data.objects["Cube"].location.x += 0.5
        after = yield from self.both("after", other)
        for space in spaces:
            space.shading.type = 'SOLID'
        yield from self.settle()
        for space in spaces:
            space.shading.type = 'RENDERED'
        fresh = yield from self.both("fresh", other)
        self.assertEqual(len({picture.rgb for picture in before + after}), 4)
        self.assertTrue(after == fresh)

    def both(self, name, other):
        yield from self.settle()
        region = next(region for region in other.regions if region.type == 'WINDOW')
        return [self.screenshot("separate-" + name), self.screenshot("separate-other-" + name, region)]

    def record(self, owner, name, argument):
        """List of an argument of every call from now on."""
        calls, original = [], getattr(owner, name)

        def recorded(*arguments):
            calls.append(arguments[argument])
            return original(*arguments)
        setattr(owner, name, recorded)
        self.addCleanup(setattr, owner, name, original)
        return calls

    def test_error(self):
        """It is told in the viewport, and gone with its cause."""
        good = yield from self.shown("good")
        preferences = bpy.context.preferences.addons[ADDON].preferences
        self.addCleanup(setattr, preferences, 'backend', preferences.backend)
        before, preferences.backend = preferences.backend, 'nosuch'
        said, status = self.record(draw, 'draw_message', 1), self.record(viewport.EngineHost, 'show_status', 1)
        bad = yield from self.shown("error")
        self.assertFalse(bad == good)
        for text in (said[-1], status[-1]):     # what it is, what is wrong, and what would be right
            for words in ("Penumbra cannot draw this viewport", "nosuch", "egl", "osmesa"):
                self.assertIn(words, text)
        preferences.backend = before
        self.assertTrue(good == (yield from self.shown("good again")))

    def test_error_of_drawing(self):
        """As if the GPU's driver refused the shader."""
        said = self.record(draw, 'draw_message', 1)
        original = draw._get_shadow_shader
        self.addCleanup(setattr, draw, '_get_shadow_shader', original)
        draw._get_shadow_shader = lambda: 1 / 0
        self.scene.penumbra.viewport_view = 'SHADOW'
        yield from self.shown("error of drawing")
        self.assertIn("Unexpected ZeroDivisionError", said[-1])
        draw._get_shadow_shader = original
        bpy.data.objects["Cube"].location.x += 0.1
        count = len(said)
        yield from self.shown("drawn again")
        self.assertEqual(len(said), count)

    def test_out_of_memory(self):
        """Shadow maps of 5 GiB, which llvmpipe refuses: the text names the cure."""
        good = yield from self.shown("good")
        before, self.scene.penumbra.shadow_map_size = self.scene.penumbra.shadow_map_size, 16384
        said, status = self.record(draw, 'draw_message', 1), self.record(viewport.EngineHost, 'show_status', 1)
        yield from self.shown("out of memory")
        for text in (said[-1], status[-1]):
            for words in ("Penumbra cannot draw this viewport", "16384 x 16384", "Smaller shadow maps"):
                self.assertIn(words, text)
        self.scene.penumbra.shadow_map_size = before
        self.assertTrue(good == (yield from self.shown("good again")))
