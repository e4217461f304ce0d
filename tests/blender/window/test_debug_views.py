# SPDX-License-Identifier: GPL-3.0-or-later
"""What a viewport can show instead of the picture, and refining to the reference."""

import bpy

from harness import add_light
from window import ViewportTest

from penumbra import statistics, viewport


def share(picture, is_color):
    """Of the pixels whose (r, g, b) is so."""
    pixels = list(zip(picture.rgb[0::3], picture.rgb[1::3], picture.rgb[2::3]))
    return sum(is_color(*pixel) for pixel in pixels) / len(pixels)


class DebugViews(ViewportTest):
    def setUp(self):
        super().setUp()
        self.scene.render.preview_pixel_size = '2'
        self.still_life()
        add_light("Second", 'AREA', location=(-2, 1, 3), rotation=(0, -0.6, 0), size=0.5)
        self.look(distance=5.0)
        self.scene.view_settings.view_transform = 'Standard'
        self.settings = self.scene.penumbra

    def test_views(self):
        final = yield from self.shown("view-final")
        self.settings.viewport_view = 'SHADOW'
        shadow = yield from self.shown("view-shadow")
        self.assertGreater(share(shadow, lambda r, g, b: r == g == b), 0.99, "white lights have grey shadows")
        self.settings.viewport_view = 'LIGHT'
        lights = []
        for name in ("Key", "Second"):
            self.settings.viewport_light = name
            lights.append((yield from self.shown("view-" + name)))
        self.settings.viewport_view = 'CLASSES'
        classes = yield from self.shown("view-classes")
        for color, test in (("lit", lambda r, g, b: r > 150 and g > 150),
                            ("penumbra", lambda r, g, b: r > 2 * g and r > b),
                            ("umbra", lambda r, g, b: b > 2 * g and b > 2 * r)):
            self.assertGreater(share(classes, test), 0.0004, color)     # 120 of 640 x 480 pixels
        self.assertEqual(len({picture.rgb for picture in (final, shadow, *lights, classes)}), 5)
        self.settings.viewport_light = "Key"
        for view, name, dark in (('PENUMBRA', "penumbra", 0.3), ('BLOCKER', "blocker", 0.3), ('MAP', "map", 0.0)):
            self.settings.viewport_view = view
            shown = yield from self.shown("view-" + name)
            labels = [seen._picture.label for seen in viewport._viewports if seen._picture]
            self.assertTrue(any("Key" in label and "sample" not in label for label in labels), labels)
            self.assertGreaterEqual(share(shown, lambda r, g, b: r + g + b == 0), dark, "nothing blocks there")
            self.assertGreater(share(shown, lambda r, g, b: r + g + b > 30), 0.01, "something does here")
        self.settings.viewport_view = 'FINAL'
        self.assertTrue(final == (yield from self.shown("view-final-again")))

    def test_refine(self):
        """The last picture is REFERENCE's."""
        self.settings.light_samples = 3
        first = yield from self.shown("refine-technique")
        self.assertIn("PCSS", statistics.last.what)
        self.settings.use_refine = True
        refined = yield from self.shown("refine-refined")
        self.assertIn("REFERENCE", statistics.last.what)
        self.assertFalse(first == refined)
        self.settings.use_refine = False
        self.settings.technique = 'REFERENCE'
        self.assertTrue(refined == (yield from self.shown("refine-reference")))

    def test_presets_and_statistics(self):
        for name, size in (('DRAFT', 512), ('FINAL', 2048), ('PREVIEW', 1024)):
            self.assertEqual(bpy.ops.penumbra.preset(preset=name), {'FINISHED'})
            self.assertEqual(self.settings.shadow_map_size, size)
        yield from self.settle()
        last = statistics.last
        self.assertEqual((last.samples, last.triangles, last.lights), (16, 14, 2))
        self.assertGreater(last.milliseconds(), 0.0)
        self.assertGreater(last.megabytes(), 2 * 1024 * 1024 * 4 / 2 ** 20)
