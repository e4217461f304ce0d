# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadows of coloured glass, alpha-mapped and translucent surfaces, against Cycles of the running Blender."""

import math
import random

import bpy

from harness import CyclesTest, add_camera, add_light, add_plane, white_material

from penumbra import compat

SIDE = 48
# Root of the mean squared error of a channel's visibility.
TOLERANCE = 0.05
# ... of MULTILAYER against REFERENCE.
REFERENCE_TOLERANCE = 0.04
TECHNIQUES = ('REFERENCE', 'MULTILAYER')


def transparent_material(color, image=None, leaf=None):
    """Lets `color` through where the image is 0, or everywhere; shows `leaf` elsewhere."""
    material = bpy.data.materials.new("Transparent")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    output, mix, clear, solid = (tree.nodes.new('ShaderNode' + kind) for kind in (
        'OutputMaterial', 'MixShader', 'BsdfTransparent', 'BsdfDiffuse'))
    clear.inputs['Color'].default_value = *color, 1.0
    mix.inputs[0].default_value = leaf or 0.0
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(solid.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs[0])
    if image:
        picture = tree.nodes.new('ShaderNodeTexImage')
        picture.image = image
        tree.links.new(picture.outputs['Color'], mix.inputs[0])
    return material


def alpha_image(alpha, side=64):
    image = bpy.data.images.new("Alpha", side, side, float_buffer=True)
    image.colorspace_settings.is_data = True
    values = (alpha((i % side + 0.5) / side, (i // side + 0.5) / side) for i in range(side * side))
    image.pixels.foreach_set([channel for value in values for channel in (value, value, value, 1.0)])
    return image


def picket(u, v):
    return 1.0 if abs(u * 8 % 1 - 0.5) < 0.2 or min(abs(v - 0.25), abs(v - 0.75)) < 0.04 else 0.0


def leaf(u, v):
    width = 0.35 * (1 - (2 * v - 1) ** 2)
    return min(max((width - abs(u - 0.5)) * 20, 0), 0.7)


class Transparency(CyclesTest):
    def setUp(self):
        super().setUp()
        self.scene.render.resolution_x = self.scene.render.resolution_y = SIDE
        self.scene.penumbra.light_samples, self.scene.penumbra.samples = 6, 1
        self.scene.penumbra.shadow_map_size = 512
        self.scene.cycles.samples = 256
        self.scene.cycles.transparent_max_bounces = 64
        self.layer.use_pass_shadow = True
        add_plane(half=4).data.materials.append(white_material())
        add_light("Key", 'AREA', location=(0.6, -0.5, 5), rotation=(0.1, 0.12, 0), size=0.8, energy=500)
        add_camera(location=(0, 0, 10), type='ORTHO', ortho_scale=4)

    def add(self, material, half=0.8, **place):
        """A sheet that only its shadow shows, with its image once over it."""
        ob = add_plane("Sheet", half=half, **place)
        for corner, uv in zip(ob.data.uv_layers.new(name="Map").data, ((0, 0), (1, 0), (1, 1), (0, 1))):
            corner.uv = uv
        ob.data.materials.append(material)
        ob.visible_camera = False
        return ob

    def check(self, tolerance=TOLERANCE):
        """Compares visibility: light on the floor over that without any sheet."""
        self.scene.render.engine = 'CYCLES'
        shadowed = self.render("shadowed")
        sheets = [ob for ob in self.scene.objects if ob.name.startswith("Sheet")]
        for ob in sheets:
            ob.hide_render = True
        lit = self.render("lit")
        for ob in sheets:
            ob.hide_render = False
        self.scene.render.engine = 'PENUMBRA'
        pictures = {}
        for technique in TECHNIQUES:
            self.scene.penumbra.technique = technique
            picture = pictures[technique] = self.render(technique)
            for channel in 'RGB':
                name = 'ViewLayer.Combined.' + channel
                ours = picture['ViewLayer.Shadow.' + channel][2]
                theirs = [s / max(u, 1e-9) for s, u in zip(shadowed[name][2], lit[name][2])]
                errors = [(a - b) ** 2 for a, b in zip(ours, theirs)]
                error = math.sqrt(sum(errors) / len(errors))
                print(self.id(), technique, channel, "error", round(error, 4), "darkest", round(min(ours), 3),
                      "Cycles' darkest", round(min(theirs), 3))
                self.assertLess(error, tolerance)
                self.assertLess(min(ours), 0.9)
        for channel in 'RGB':
            truth, ours = (pictures[technique]['ViewLayer.Shadow.' + channel][2] for technique in TECHNIQUES)
            error = math.sqrt(sum((a - b) ** 2 for a, b in zip(truth, ours)) / len(ours))
            print(self.id(), "MULTILAYER against REFERENCE", channel, "error", round(error, 4))
            self.assertLess(error, REFERENCE_TOLERANCE)

    def test_colored_glass(self):
        for i, color in enumerate(((0.9, 0.15, 0.1), (0.2, 0.8, 0.2), (0.15, 0.3, 0.9))):
            angle = 2.0944 * i
            self.add(transparent_material(color), rotation=(0, 0, angle),
                     location=(0.5 * math.cos(angle), 0.5 * math.sin(angle), 0.3 + 0.7 * i))
        self.check()

    def test_stacked_panes(self):
        for i in range(4):
            self.add(transparent_material((0.9, 0.75, 0.4)), half=1.2 - 0.2 * i, location=(0.1 * i, 0, 0.3 + 0.12 * i))
        self.check()

    def test_fence(self):
        self.scene.penumbra.samples = 4     # pickets near to the floor are as fine as pixels
        material = transparent_material((1, 1, 1), alpha_image(picket))
        self.add(material, location=(-0.9, 0, 0.15), rotation=(0.2, 0, 0))
        self.add(material, location=(0.9, 0, 1.6), rotation=(0.2, 0, 0))
        self.check()

    def test_foliage(self):
        numbers = random.Random(3)
        material = transparent_material((0.4, 0.9, 0.2), alpha_image(leaf), leaf=0.7)
        for _ in range(60):
            self.add(material, half=0.25, rotation=[numbers.uniform(-1, 1) for _ in 'XYZ'],
                     location=(numbers.gauss(0, 0.4), numbers.gauss(0, 0.4), numbers.uniform(0.5, 2)))
        self.check()

    def test_principled_alpha(self):
        material = white_material("Half")
        tree = material.node_tree
        shader = tree.nodes.new('ShaderNodeBsdfPrincipled')
        shader.inputs['Alpha'].default_value = 0.4
        tree.links.new(shader.outputs[0], tree.get_output_node('CYCLES').inputs[0])
        self.add(material, location=(0, 0, 1))
        self.check()

    def test_opaque_by_setting(self):
        """Cycles' switch for transparent shadows. Its own picture lies between: rays to the light do not pass, the
        others do."""
        material = transparent_material((0.9, 0.75, 0.4))
        owner = material if hasattr(material, 'use_transparent_shadow') else material.cycles
        owner.use_transparent_shadow = False
        self.add(material, location=(0, 0, 1))
        self.scene.penumbra.technique = 'REFERENCE'
        self.assertEqual(min(self.render()['ViewLayer.Shadow.R'][2]), 0.0)


class Export(CyclesTest):
    """What Cycles has no picture of without reflected light."""

    def material(self, **inputs):
        from penumbra import materials
        material = white_material("Glass")
        tree = material.node_tree
        shader = tree.nodes.new('ShaderNodeBsdfPrincipled')
        for name, value in inputs.items():
            shader.inputs[name].default_value = value
        tree.links.new(shader.outputs[0], tree.get_output_node('CYCLES').inputs[0])
        warnings = []
        surface = materials.read_surface(material, warnings)
        self.assertIn("without refraction", '\n'.join(warnings))
        return surface

    def test_transmission(self):
        surface = self.material(**{compat.PRINCIPLED_TRANSMISSION: 1.0, 'Base Color': (0.25, 1.0, 0.0, 1.0)})
        tint = 0.5 if compat.BLENDER_4 else 0.25
        self.assertEqual(surface.alpha, 0.0)
        for a, e in zip(surface.clear, (tint, 1.0, 0.0)):
            self.assertAlmostEqual(a, e, places=5)

    def test_transmission_and_alpha(self):
        """Half is not there, half of the rest lets green through."""
        surface = self.material(**{compat.PRINCIPLED_TRANSMISSION: 0.5, 'Base Color': (0.0, 1.0, 0.0, 1.0),
                                   'Alpha': 0.5})
        self.assertAlmostEqual(surface.alpha, 0.25)
        for a, e in zip(surface.clear, (0.5 / 0.75, 1.0, 0.5 / 0.75)):
            self.assertAlmostEqual(a, e, places=5)

    def test_shadow_mode(self):
        if 'shadow_method' not in bpy.types.Material.bl_rna.properties:
            self.skipTest("only Blender 3.4 has the modes")
        material = white_material()
        self.assertFalse(compat.casts_no_shadow(material))
        material.shadow_method = 'NONE'
        self.assertTrue(compat.casts_no_shadow(material))

    def test_clip_mode(self):
        """What lies below the threshold casts no shadow, the rest an opaque one; Cycles knows no such mode."""
        if 'shadow_method' not in bpy.types.Material.bl_rna.properties:
            self.skipTest("only Blender 3.4 has the modes")
        from penumbra import capi, materials
        material = white_material()
        for mode, expected in (('CLIP', 0.3), ('HASHED', 0.0)):
            material.shadow_method, material.alpha_threshold = mode, 0.3
            target = capi.Material()
            materials.fill_material(target, material, lambda *_: None, [])
            self.assertAlmostEqual(target.shadow_threshold, expected)
