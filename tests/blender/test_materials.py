# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials: colour and alpha of a lit plane against Cycles of the running Blender."""

import bpy

from harness import CyclesTest, add_camera, add_cube, add_light, add_plane, add_world, white_material

from penumbra import compat

SIDE = 16


class MaterialTest(CyclesTest):
    def setUp(self):
        super().setUp()
        self.plane = add_plane(half=3)
        layer = self.plane.data.uv_layers.new(name="Map")
        for corner, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
            corner.uv = uv
        add_light("Sun", 'SUN', energy=2.0, angle=0)
        add_camera(type='ORTHO', ortho_scale=2)
        self.scene.render.resolution_x = self.scene.render.resolution_y = SIDE
        self.scene.cycles.samples = 64

    def material(self, *kinds, ob=None):
        """(links, nodes): a material of the plane with these nodes, the first of which is its output."""
        material = bpy.data.materials.new("Test")
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        (ob or self.plane).data.materials.append(material)
        return tree.links, [tree.nodes.new(kind) for kind in ('ShaderNodeOutputMaterial', *kinds)]

    def means(self, picture):
        return [sum(picture['ViewLayer.Combined.' + channel][2]) / SIDE ** 2 for channel in 'RGBA']

    def check(self, tolerance=0.01):
        """Means over the picture: transparent surfaces are noisy in both engines."""
        expected, actual = (self.means(picture) for picture in self.both())
        print(self.id(), [round(value, 4) for value in expected], [round(value, 4) for value in actual])
        for a, e in zip(actual, expected):
            self.assertAlmostEqual(a, e, delta=tolerance * max(1.0, e))
        return actual


class Values(MaterialTest):
    def test_emission(self):
        links, (output, shader) = self.material('ShaderNodeEmission')
        shader.inputs['Color'].default_value = 0.25, 0.5, 1.0, 1.0
        shader.inputs['Strength'].default_value = 3.0
        links.new(shader.outputs[0], output.inputs[0])
        self.check()

    def test_principled_emission(self):
        links, (output, shader) = self.material('ShaderNodeBsdfPrincipled')
        self.plain_principled(shader)
        shader.inputs['Base Color'].default_value = 0.5, 0.25, 0.0, 1.0
        shader.inputs[compat.PRINCIPLED_EMISSION].default_value = 0.0, 0.5, 1.0, 1.0
        shader.inputs['Emission Strength'].default_value = 2.0
        links.new(shader.outputs[0], output.inputs[0])
        self.check()

    def test_principled_emission_and_alpha(self):
        self.scene.render.film_transparent = True
        links, (output, shader) = self.material('ShaderNodeBsdfPrincipled')
        self.plain_principled(shader)
        shader.inputs[compat.PRINCIPLED_EMISSION].default_value = 0.0, 0.5, 1.0, 1.0
        shader.inputs['Emission Strength'].default_value = 2.0
        shader.inputs['Alpha'].default_value = 0.25
        links.new(shader.outputs[0], output.inputs[0])
        # 64 stratified samples per pixel: a quarter of them within one.
        self.assertAlmostEqual(self.check(tolerance=0.02)[3], 0.25, delta=1 / 64)

    @staticmethod
    def plain_principled(shader):
        """Without what is not diffuse."""
        for name in ('Specular', 'Specular IOR Level'):
            if name in shader.inputs:
                shader.inputs[name].default_value = 0.0

    def test_image_emits(self):
        image = bpy.data.images.new("Picture", 8, 8, float_buffer=True)
        image.pixels.foreach_set([0.5, 1.0, 0.25, 1.0] * 64)
        links, (output, shader, picture) = self.material('ShaderNodeEmission', 'ShaderNodeTexImage')
        picture.image = image
        shader.inputs['Strength'].default_value = 2.0
        links.new(picture.outputs[0], shader.inputs['Color'])
        links.new(shader.outputs[0], output.inputs[0])
        self.check()

    def test_diffuse_and_emission_mixed(self):
        links, (output, mix, diffuse, emission) = self.material('ShaderNodeMixShader', 'ShaderNodeBsdfDiffuse',
                                                                'ShaderNodeEmission')
        mix.inputs[0].default_value = 0.25
        emission.inputs['Strength'].default_value = 4.0
        links.new(diffuse.outputs[0], mix.inputs[1])
        links.new(emission.outputs[0], mix.inputs[2])
        links.new(mix.outputs[0], output.inputs[0])
        self.check()

    def test_diffuse_and_emission_added(self):
        links, (output, add, diffuse, emission) = self.material('ShaderNodeAddShader', 'ShaderNodeBsdfDiffuse',
                                                                'ShaderNodeEmission')
        diffuse.inputs['Color'].default_value = 0.5, 0.25, 0.125, 1.0
        emission.inputs['Strength'].default_value = 0.5
        links.new(diffuse.outputs[0], add.inputs[0])
        links.new(emission.outputs[0], add.inputs[1])
        links.new(add.outputs[0], output.inputs[0])
        self.check()

    def test_emission_of_no_light(self):
        """Nothing else in the scene."""
        bpy.data.objects.remove(bpy.data.objects["Sun"])
        self.test_emission()


class Holdout(MaterialTest):
    def setUp(self):
        super().setUp()
        add_world((0.25, 0.5, 0.75))
        # Without light, since the world's counts as ambient light here.
        links, (output, shader) = self.material('ShaderNodeEmission')
        links.new(shader.outputs[0], output.inputs[0])
        self.plane.scale = 0.2, 0.2, 1.0
        add_cube("Hole", location=(0.5, 0, 1))

    def test_object(self):
        bpy.data.objects["Hole"].is_holdout = True
        for transparent in (False, True):
            with self.subTest(film_transparent=transparent):
                self.scene.render.film_transparent = transparent
                self.assertLess(self.check(tolerance=0.02)[3], 0.9)

    def test_shader(self):
        links, (output, shader) = self.material('ShaderNodeHoldout', ob=bpy.data.objects["Hole"])
        links.new(shader.outputs[0], output.inputs[0])
        self.assertLess(self.check(tolerance=0.02)[3], 0.9)


class BackfaceCulling(MaterialTest):
    """Cycles has no such switch, but nodes that do the same."""

    def culled(self, camera=True, shadow=False, **place):
        """A plane under which the floor is seen, with its back upwards."""
        ob = add_plane("Back", half=0.5, location=(0, 0, 1), **place)
        material = white_material()
        material.use_backface_culling = camera
        if hasattr(material, 'use_backface_culling_shadow'):
            material.use_backface_culling_shadow = shadow
        ob.data.materials.append(material)
        self.plane.data.materials.append(white_material("Red", (1, 0, 0)))
        picture = self.render()
        bpy.data.objects.remove(ob)
        center = (SIDE // 2) * SIDE + SIDE // 2
        return [picture['ViewLayer.Combined.' + channel][2][center] for channel in 'RG']

    def assert_sees(self, pixel, what):
        lit = 2.0 / 3.14159265
        expected = {'plane': (lit, lit), 'floor': (lit, 0.0), 'shadow': (0.0, 0.0)}[what]
        for a, e in zip(pixel, expected):
            self.assertAlmostEqual(a, e, delta=0.01)

    def test_camera(self):
        half_turn = (3.14159265, 0, 0)
        self.assert_sees(self.culled(), 'plane')
        self.assert_sees(self.culled(rotation=half_turn), 'shadow')
        self.assert_sees(self.culled(rotation=half_turn, camera=False), 'plane')
        self.assert_sees(self.culled(scale=(-1, 1, 1)), 'plane')
        self.assert_sees(self.culled(scale=(1, 1, -1)), 'shadow')

    def test_shadow(self):
        if 'use_backface_culling_shadow' not in bpy.types.Material.bl_rna.properties:
            self.skipTest("Blender has no such switch yet")
        half_turn = (3.14159265, 0, 0)
        self.assert_sees(self.culled(rotation=half_turn, shadow=True), 'floor')
        self.assert_sees(self.culled(scale=(1, -1, -1), camera=True, shadow=True), 'floor')
        self.assert_sees(self.culled(scale=(1, 1, -1), camera=True, shadow=True), 'floor')
        self.assert_sees(self.culled(camera=True, shadow=True), 'plane')
