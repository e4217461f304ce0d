# SPDX-License-Identifier: GPL-3.0-or-later
"""Soft shadows over what other engines draw."""

import bpy

import display
from harness import add_world, eevee, output, turn_off_eevee_shadows
from window import ViewportTest, psnr

from penumbra import viewport


def to_linear(value):
    """Of display values: Blender blends overlays by a power of 2.2."""
    return (value / 255.0) ** 2.2


class Overlay(ViewportTest):
    def setUp(self):
        super().setUp()
        self.still_life()
        self.look_through_camera()
        self.scene.penumbra.samples = self.scene.penumbra.viewport_samples
        space = self.space()
        # Overlays are on, but none except ours.
        space.overlay.show_overlays = True
        for name in ('show_floor', 'show_axis_x', 'show_axis_y', 'show_text', 'show_stats', 'show_cursor',
                     'show_extras', 'show_outline_selected', 'show_object_origins', 'show_ortho_grid',
                     'show_relationship_lines'):
            setattr(space.overlay, name, False)

    def shadow(self):
        """The Shadow pass by F12, of the region's pixels, rows top-down."""
        engine = self.scene.render.engine
        self.scene.render.engine = 'PENUMBRA'
        self.layer.use_pass_shadow = True
        with self.window():
            width, _height, red = self.render("overlay-shadow")['ViewLayer.Shadow.R']
        self.layer.use_pass_shadow = False
        self.scene.render.engine = engine
        return [red[start:start + width] for start in range(len(red) - width, -1, -width)]

    def check(self, engine, shading, name):
        self.scene.render.engine = engine
        self.space().shading.type = shading
        without = yield from self.shown(name + "-without")
        self.scene.penumbra.use_overlay = True
        with_shadow = yield from self.shown(name + "-with")
        light = [value for row in self.shadow() for value in row for _channel in range(3)]
        expected = bytes(int(255.0 * (to_linear(value) * share) ** (1.0 / 2.2) + 0.5)
                         for value, share in zip(without.rgb, light))
        expected = display.Picture(*without[:2], expected)
        expected.save(output(name + "-expected.ppm"))
        value = psnr(with_shadow, expected)
        print(f"{name}: {psnr(with_shadow, without):.1f} dB from the picture without, {value:.1f} dB from the product")
        self.assertLess(psnr(with_shadow, without), 30.0)
        # 8 bits of alpha and of colour, twice rounded; dark tones are spread by the power.
        self.assertGreaterEqual(value, 40.0)

    def test_workbench(self):
        self.space().shading.light = 'FLAT'
        yield from self.check('BLENDER_WORKBENCH', 'SOLID', "overlay-workbench")

    def test_eevee(self):
        turn_off_eevee_shadows(self.scene)
        self.scene.eevee.taa_samples = 1
        yield from self.check(eevee(), 'RENDERED', "overlay-eevee")

    def test_follows_edits(self):
        self.space().shading.type = 'SOLID'
        self.scene.penumbra.use_overlay = True
        before = yield from self.shown("overlay-before")
        bpy.data.objects["Cube"].location.x += 1.0
        after = yield from self.shown("overlay-moved")
        bpy.data.lights["Key"].size = 3.0
        larger = yield from self.shown("overlay-larger")
        self.assertEqual(len({before.rgb, after.rgb, larger.rgb}), 3)
        self.scene.penumbra.use_overlay = False
        plain = yield from self.shown("overlay-off")
        self.scene.penumbra.use_overlay = True
        self.assertFalse(plain == larger)
        self.assertTrue(larger == (yield from self.shown("overlay-on")))

    def test_follows_view_layer(self):
        self.space().shading.type = 'SOLID'
        self.scene.penumbra.use_overlay = True
        group = bpy.data.collections.new("Group")
        self.scene.collection.children.link(group)
        cube = bpy.data.objects["Cube"]
        group.objects.link(cube)
        self.scene.collection.objects.unlink(cube)
        empty = self.scene.view_layers.new("Empty")
        empty.layer_collection.children["Group"].exclude = True
        before = yield from self.shown("overlay-layer")
        window = bpy.context.window_manager.windows[0]
        window.view_layer = empty
        yield 'draw'
        without = yield from self.shown("overlay-other-layer")
        window.view_layer = self.layer
        yield 'draw'
        self.assertTrue(before == (yield from self.shown("overlay-first-layer")))
        bpy.data.objects.remove(cube)
        self.assertTrue(without == (yield from self.shown("overlay-no-cube")))

    def test_border(self):
        """Of the render: Workbench and EEVEE draw the whole viewport all the same."""
        self.scene.penumbra.use_overlay = True
        for engine, shading in (('PENUMBRA', 'SOLID'), ('BLENDER_WORKBENCH', 'RENDERED')):
            self.scene.render.engine = engine
            self.space().shading.type = shading
            self.scene.render.use_border = False
            whole = yield from self.shown("overlay-whole")
            self.scene.render.use_border = True
            self.scene.render.border_max_x = 0.5
            part = yield from self.shown("overlay-border")
            outside = whole.width * 5 // 8, 0, whole.width // 4, whole.height  # of the outline that Blender draws, too
            self.assertTrue(part.cut(*outside) == whole.cut(*outside), shading)

    def test_follows_engines(self):
        """Other engines and shadings, a world that is deleted, and moves while they change: no exception, and the end
        is what an overlay shows that was not there before."""
        self.scene.penumbra.use_overlay = True
        add_world((0.2, 0.3, 0.4))
        for engine in ('PENUMBRA', 'CYCLES', 'BLENDER_WORKBENCH', 'PENUMBRA'):
            self.scene.render.engine = engine
            for shading in ('RENDERED', 'WIREFRAME', 'SOLID'):
                self.space().shading.type = shading
                yield 'draw'
                yield 'draw'
                bpy.data.objects["Cube"].location.x += 0.05
            if self.scene.world:
                bpy.data.worlds.remove(self.scene.world)
        self.assertEqual([shown._error for shown in viewport._viewports if shown._error], [])
        end = yield from self.shown("overlay-end")
        self.scene.penumbra.use_overlay = False
        self.assertFalse(end == (yield from self.shown("overlay-none")))
        self.scene.penumbra.use_overlay = True
        self.assertTrue(end == (yield from self.shown("overlay-fresh")))
