# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of Composite Soft Shadows share, with and without a window."""

import bpy

from harness import output


class CompositeMixin:
    """For a SceneTest."""

    def combined(self, name):
        """RGB of the composited picture: of a multilayer file the passes are those before the compositor."""
        settings = self.scene.render.image_settings
        if hasattr(settings, 'media_type'):
            settings.media_type = 'IMAGE'
        settings.file_format, settings.color_mode, settings.color_depth = 'OPEN_EXR', 'RGBA', '32'
        self.scene.render.filepath = path = output(name + '.exr')
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(path, check_existing=False)
        pixels = list(image.pixels)
        bpy.data.images.remove(image)
        return pixels

    def check_composite(self, engine):
        """Engine x shadow: floats of 32 bits, read by two different ways."""
        self.scene.render.engine = 'PENUMBRA'
        self.layer.use_pass_shadow = True
        shadow = [self.render("shadow")[f'ViewLayer.Shadow.{channel}'][2] for channel in 'RGB']
        self.layer.use_pass_shadow = False
        self.scene.render.engine = engine
        alone = self.combined("alone")
        self.assertEqual(bpy.ops.penumbra.composite(), {'FINISHED'})
        both = self.combined("both")
        count = len(shadow[0])
        self.assertLess(min(shadow[0]), 0.1)
        for pixel in range(count):
            for channel in range(3):
                expected = alone[4 * pixel + channel] * shadow[channel][pixel]
                self.assertAlmostEqual(both[4 * pixel + channel], expected, delta=1e-5 + 1e-5 * abs(expected))
            self.assertAlmostEqual(both[4 * pixel + 3], alone[4 * pixel + 3], delta=1e-6)
        self.assertEqual(bpy.ops.penumbra.composite_remove(), {'FINISHED'})
        self.assertEqual(self.combined("after"), alone)
