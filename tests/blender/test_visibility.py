# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow catchers, view layers and collections, against Cycles of the running Blender."""

import bpy

from harness import CyclesTest, add_camera, add_cube, add_light, add_plane, add_world, white_material

WIDTH, HEIGHT = 32, 24


class VisibilityTest(CyclesTest):
    def setUp(self):
        super().setUp()
        self.scene.render.resolution_x, self.scene.render.resolution_y = WIDTH, HEIGHT
        self.scene.penumbra.technique, self.scene.penumbra.light_samples = 'REFERENCE', 6
        self.scene.penumbra.samples = 16
        self.scene.cycles.samples = 256
        material = white_material()
        self.floor = add_plane(half=1.5)
        self.cube = add_cube(half=0.4, location=(-0.2, 0, 0.4))
        for ob in (self.floor, self.cube):
            ob.data.materials.append(material)
        add_camera(location=(0, 0, 8))
        add_light("Key", 'AREA', location=(2, 0, 3), rotation=(0, 0.6, 0), size=0.5)

    def check(self, mean=0.005, layer='ViewLayer', channels='RGBA'):
        """Means of the absolute differences, of light and alpha between 0 and about 1; returns our picture."""
        expected, actual = self.both()
        for channel in channels:
            name = f'{layer}.Combined.{channel}'
            differences = [abs(a - e) for a, e in zip(actual[name][2], expected[name][2])]
            print(self.id(), name, "mean difference", round(sum(differences) / len(differences), 5), "largest",
                  round(max(differences), 4))
            self.assertLess(sum(differences) / len(differences), mean)
        return actual


class ShadowCatcher(VisibilityTest):
    def setUp(self):
        super().setUp()
        self.floor.is_shadow_catcher = True

    def test_transparent_film(self):
        self.scene.render.film_transparent = True
        alpha = self.check()['ViewLayer.Combined.A'][2]
        self.assertEqual((min(alpha), max(alpha)), (0.0, 1.0))
        self.assertTrue(any(0.1 < value < 0.9 for value in alpha))

    def test_two_lights(self):
        self.scene.render.film_transparent = True
        add_light("Fill", 'POINT', location=(-2, 1, 3), shadow_soft_size=0.2, color=(1, 0.5, 0.25))
        self.check()

    def test_two_kinds(self):
        """A holdout beside a catcher."""
        self.scene.render.film_transparent = True
        self.cube.is_holdout = True
        self.check()

    def test_background(self):
        add_world((0.25, 0.5, 0.75))
        self.cube.is_holdout = True     # what the world gives it as ambient light is not compared
        picture = self.render()
        colors = {channel: picture['ViewLayer.Combined.' + channel][2] for channel in 'RGBA'}
        self.assertAlmostEqual(colors['B'][0], 0.75, delta=1e-4)    # unshadowed
        self.assertAlmostEqual(colors['A'][0], 1.0, delta=1e-6)
        dark = min(value for value, alpha in zip(colors['B'], colors['A']) if alpha == 1.0)
        self.assertLess(dark, 0.6)


class ViewLayers(VisibilityTest):
    def setUp(self):
        super().setUp()
        self.scene.render.film_transparent = True
        self.collection = bpy.data.collections.new("Boxes")
        self.scene.collection.children.link(self.collection)
        self.scene.collection.objects.unlink(self.cube)
        self.collection.objects.link(self.cube)
        self.inside = self.layer.layer_collection.children["Boxes"]

    def test_holdout(self):
        self.inside.holdout = True
        self.assertLess(sum(self.check()['ViewLayer.Combined.A'][2]), WIDTH * HEIGHT * 0.99)

    def test_indirect_only(self):
        self.inside.indirect_only = True
        self.check()

    def test_excluded(self):
        self.inside.exclude = True
        self.check()

    def test_hidden_in_renders(self):
        self.collection.hide_render = True
        self.check()

    def test_layers_differ(self):
        """One layer without the collection, one where it is a holdout, one with another material."""
        self.inside.exclude = True
        other = self.scene.view_layers.new("Other")
        other.layer_collection.children["Boxes"].holdout = True
        third = self.scene.view_layers.new("Third")
        third.material_override = white_material("Red", (1, 0, 0))
        for layer in ('ViewLayer', 'Other', 'Third'):
            picture = self.check(layer=layer)
        self.assertEqual(max(picture['Third.Combined.G'][2]), 0.0)
        self.assertLess(min(picture['Other.Combined.A'][2]), 0.5)
