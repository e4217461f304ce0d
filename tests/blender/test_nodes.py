# SPDX-License-Identifier: GPL-3.0-or-later
"""Node trees: what constants come to, against Cycles; what is kept of others; and the lines of the report on them."""

import time
from math import cos, pi, radians, sin

import bpy

from harness import CyclesTest, SceneTest, add_camera, add_light, add_plane

from penumbra import attributes, emission, sky, surfaces

COLOR = 0.7, 0.3, 0.1, 1.0


class Tree:
    """A material's nodes."""

    def __init__(self, name="Test"):
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.output = self.add('OutputMaterial')

    def add(self, kind, *inputs, **settings):
        """A node with values, or outputs of other nodes, for its first inputs."""
        node = self.tree.nodes.new('ShaderNode' + kind)
        for key, value in settings.items():
            setattr(node, key, value)
        for socket, value in zip(node.inputs, inputs):
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            elif value is not None:
                socket.default_value = value
        return node

    def surface(self, output):
        self.tree.links.new(output, self.output.inputs['Surface'])

    def image(self, name="Picture", **settings):
        return self.add('TexImage', image=bpy.data.images.new(name, 4, 4), **settings).outputs['Color']

    def read(self):
        """(Surface, lines)."""
        lines = []
        return surfaces.read_surface(self.material, lines), list(dict.fromkeys(lines))


def _ramp(tree):
    node = tree.add('ValToRGB', 0.3)
    node.color_ramp.elements[0].color, node.color_ramp.elements[1].position = COLOR, 0.8
    return node.outputs[0]


def _ramp_alpha(tree):
    node = tree.add('ValToRGB', 0.3)
    node.color_ramp.elements[0].color = 1, 1, 1, 0.5
    return node.outputs[1]


def _mix(tree, factor, a, b, **settings):
    """The Mix node, whose inputs share names."""
    node = tree.add('Mix', **settings)
    numbers = {'FLOAT': (0, 2, 3), 'VECTOR': (0, 4, 5), 'RGBA': (0, 6, 7)}[node.data_type]
    for number, value in zip(numbers, (factor, a, b)):
        node.inputs[number].default_value = value
    return next(output for output in node.outputs if output.enabled)


def _math(operation, *numbers, **settings):
    return lambda tree: tree.add('Math', *numbers, operation=operation, **settings).outputs[0]


def _mix_rgb(blend, factor=0.6, **settings):
    return lambda tree: tree.add('MixRGB', factor, COLOR, (0.2, 0.6, 0.9, 1), blend_type=blend, **settings).outputs[0]


def _modern(kind, blend='MIX', factor=0.3, **settings):
    a, b = {'FLOAT': (0.2, 0.9), 'VECTOR': ((0.1, 0.2, 0.3), (0.9, 0.8, 0.7)),
            'RGBA': (COLOR, (0.2, 0.6, 0.9, 1))}[kind]
    return lambda tree: _mix(tree, factor, a, b, data_type=kind, blend_type=blend, **settings)


CONSTANTS = [
    *(_math(operation, 0.7, 0.4, 0.2) for operation in (
        'ADD', 'SUBTRACT', 'MULTIPLY', 'DIVIDE', 'MULTIPLY_ADD', 'POWER', 'LOGARITHM', 'SQRT', 'ABSOLUTE', 'EXPONENT',
        'MINIMUM', 'MAXIMUM', 'LESS_THAN', 'GREATER_THAN', 'SIGN', 'COMPARE', 'ROUND', 'FLOOR', 'CEIL', 'TRUNC',
        'FRACT', 'MODULO', 'SINE', 'COSINE', 'TANGENT', 'RADIANS', 'DEGREES')),
    _math('ADD', 0.8, 0.9, use_clamp=True), _math('DIVIDE', 0.8, 0.0),
    *(_mix_rgb(blend) for blend in ('MIX', 'ADD', 'SUBTRACT', 'MULTIPLY', 'SCREEN', 'DIVIDE', 'DIFFERENCE', 'DARKEN',
                                    'LIGHTEN', 'OVERLAY')),
    _mix_rgb('ADD', use_clamp=True), _mix_rgb('MIX', factor=1.7),
    _modern('FLOAT'), _modern('FLOAT', factor=1.5, clamp_factor=False), _modern('VECTOR'), _modern('RGBA'),
    _modern('RGBA', 'MULTIPLY'), _modern('RGBA', 'ADD', factor=1.0, clamp_result=True),
    _ramp, _ramp_alpha,
    lambda tree: tree.add('Invert', 0.4, COLOR).outputs[0],
    lambda tree: tree.add('Gamma', COLOR, 2.2).outputs[0],
    lambda tree: tree.add('BrightContrast', COLOR, 0.2, 0.5).outputs[0],
    lambda tree: tree.add('HueSaturation', 0.7, 1.4, 0.8, 0.6, COLOR).outputs[0],
    lambda tree: tree.add('Clamp', 1.4, 0.2, 0.9).outputs[0],
    lambda tree: tree.add('Clamp', 0.5, 0.9, 0.7, clamp_type='RANGE').outputs[0],
    lambda tree: tree.add('MapRange', 0.4, 0.2, 0.7, 0.1, 1.5).outputs[0],
    lambda tree: tree.add('MapRange', 0.9, 0.2, 0.7, 1.5, 0.1).outputs[0],
    lambda tree: tree.add('RGBToBW', COLOR).outputs[0],
    lambda tree: tree.add('CombineColor', 0.2, 0.5, 0.9).outputs[0],
    lambda tree: tree.add('CombineXYZ', 0.2, 0.5, 0.9).outputs[0],
    lambda tree: tree.add('SeparateColor', COLOR).outputs[1],
    lambda tree: tree.add('SeparateXYZ', (0.2, 0.5, 0.9)).outputs[2],
    # A colour linked to a number, a vector to a number, a number to a colour.
    lambda tree: tree.add('Math', tree.add('Gamma', COLOR, 1.0).outputs[0], 0.5, operation='MULTIPLY').outputs[0],
    lambda tree: tree.add('Math', tree.add('CombineXYZ', 0.2, 0.5, 0.9).outputs[0], 0.5).outputs[0],
    lambda tree: tree.add('Gamma', tree.add('Value').outputs[0], 2.0).outputs[0],
]


class Constants(CyclesTest):
    def test_against_cycles(self):
        """A row of planes, of which each emits what its nodes come to."""
        count = len(CONSTANTS)
        for number, build in enumerate(CONSTANTS):
            tree = Tree(f"Nodes {number}")
            tree.surface(tree.add('Emission', build(tree)).outputs[0])
            add_plane(half=0.5, location=(number, 0, 0)).data.materials.append(tree.material)
        add_camera(location=((count - 1) / 2, 0, 5), type='ORTHO', ortho_scale=count)
        self.scene.render.resolution_x, self.scene.render.resolution_y = 3 * count, 3
        self.scene.cycles.samples = 1
        expected, actual = self.both()
        for channel in 'RGB':
            name = f'ViewLayer.Combined.{channel}'
            for number in range(count):
                pixel = 3 * count + 3 * number + 1
                a, e = actual[name][2][pixel], max(expected[name][2][pixel], 0.0)   # we leave out negative emission
                with self.subTest(number=number, channel=channel):
                    self.assertAlmostEqual(a, e, delta=1e-3 * max(1.0, e))


class Kept(SceneTest):
    """What is drawn of textures behind nodes."""

    def assert_keeps(self, tree, output, *lines):
        tree.surface(tree.add('BsdfDiffuse', output).outputs[0])
        surface, found = tree.read()
        self.assertEqual(surface.color_image.image.name, "Picture")
        self.assertEqual(len(found), len(lines), found)
        for part, line in zip(lines, found):
            self.assertIn(part, line)
            self.assertIn("material 'Test'", line)
        return surface

    def test_image_through_nodes(self):
        for kind, number in (('HueSaturation', 4), ('Gamma', 0), ('BrightContrast', 0), ('Invert', 1), ('RGBCurve', 1),
                             ('MixRGB', 1), ('MixRGB', 2)):
            with self.subTest(kind=kind, number=number):
                tree = Tree()
                node = tree.add(kind)
                tree.tree.links.new(tree.image(), node.inputs[number])
                self.assert_keeps(tree, node.outputs[0], f"'Picture' is drawn without {node.name}")
                bpy.data.materials.remove(tree.material)
                bpy.data.images.remove(bpy.data.images["Picture"])

    def test_factor(self):
        tree = Tree()
        gained = tree.add('MixRGB', 0.5, tree.image(), (0.5, 1.0, 0.0, 1.0), blend_type='MULTIPLY').outputs[0]
        surface = self.assert_keeps(tree, gained)
        for a, e in zip(surface.color, (0.75, 1.0, 0.5)):
            self.assertAlmostEqual(a, e, places=6)

    def test_one_side_alone(self):
        """Of a Mix node whose factor is 0 or 1 only one side counts, and there is nothing to say."""
        for factor, sides, blend, kept in ((0.0, 'image first', 'ADD', True), (1.0, 'image second', 'MIX', True),
                                           (1.0, 'image first', 'MIX', False), (0.0, 'image second', 'SCREEN', False)):
            with self.subTest(factor=factor, sides=sides):
                tree = Tree()
                pair = (tree.image(), COLOR) if sides == 'image first' else (COLOR, tree.image())
                tree.surface(tree.add('BsdfDiffuse', tree.add('MixRGB', factor, *pair, blend_type=blend).outputs[0])
                             .outputs[0])
                surface, lines = tree.read()
                self.assertEqual((bool(surface.color_image), lines), (kept, []))
                for a, e in zip(surface.color, (1.0, 1.0, 1.0) if kept else COLOR):
                    self.assertAlmostEqual(a, e, places=6)

    def test_heavier_image(self):
        for factor, name in ((0.2, "First"), (0.8, "Second")):
            tree = Tree()
            mixed = tree.add('MixRGB', factor, tree.image("First"), tree.image("Second"))
            tree.surface(tree.add('BsdfDiffuse', mixed.outputs[0]).outputs[0])
            self.assertEqual(tree.read()[0].color_image.image.name.split('.')[0], name)

    def test_alpha_through_math(self):
        tree = Tree()
        shader = tree.add('BsdfPrincipled')
        half = tree.add('Math', tree.image(), 0.5, operation='MULTIPLY')
        tree.tree.links.new(half.outputs[0], shader.inputs['Alpha'])
        tree.surface(shader.outputs[0])
        surface, lines = tree.read()
        self.assertEqual((surface.alpha, surface.alpha_image.image.name), (0.5, "Picture"))
        self.assertEqual(lines, [])

    def test_procedural(self):
        """The nodes behind it get the value of the socket it is linked to."""
        tree = Tree()
        ramp = tree.add('ValToRGB', tree.add('TexNoise').outputs[0])
        ramp.inputs[0].default_value = 0.5
        tree.surface(tree.add('BsdfDiffuse', ramp.outputs[0]).outputs[0])
        surface, lines = tree.read()
        for channel in surface.color:
            self.assertAlmostEqual(channel, 0.5, places=5)
        self.assertEqual(len(lines), 1)


class Shared(SceneTest):
    """Each of many nodes is linked to both inputs of the next: twice as many ways with each."""

    def read(self, tree):
        start = time.perf_counter()
        surface, lines = tree.read()
        self.assertLess(time.perf_counter() - start, 5.0)
        self.assertLess(len(lines), 10)
        return surface

    def test_shaders(self):
        tree = Tree()
        output = tree.add('BsdfDiffuse', COLOR).outputs[0]
        for _ in range(30):
            output = tree.add('MixShader', 0.5, output, output).outputs[0]
        tree.surface(output)
        for a, e in zip(self.read(tree).color, COLOR):
            self.assertAlmostEqual(a, e, places=5)

    def test_colors(self):
        for textured in (False, True):
            tree = Tree()
            output = tree.image() if textured else tree.add('Gamma', COLOR, 1.0).outputs[0]
            for _ in range(30):
                output = tree.add('MixRGB', 0.5, output, output).outputs[0]
            tree.surface(tree.add('BsdfDiffuse', output).outputs[0])
            self.assertEqual(bool(self.read(tree).color_image), textured)

    def test_world(self):
        world = bpy.data.worlds.new("World")
        world.use_nodes = True
        tree = world.node_tree
        output = next(node for node in tree.nodes if node.type == 'BACKGROUND').outputs[0]
        target = output.links[0].to_socket
        output.node.inputs['Color'].default_value = COLOR
        for _ in range(30):
            mix = tree.nodes.new('ShaderNodeMixShader')
            tree.links.new(output, mix.inputs[1])
            tree.links.new(output, mix.inputs[2])
            output = mix.outputs[0]
        tree.links.new(output, target)
        for a, e in zip(emission.of_world(world, []), COLOR):
            self.assertAlmostEqual(a, e, places=5)


class Lines(SceneTest):
    def lines(self, build):
        tree = Tree()
        shader = tree.add('BsdfPrincipled')
        tree.surface(shader.outputs[0])
        build(tree, shader)
        return tree.read()[1]

    def test_defaults(self):
        self.assertEqual(self.lines(lambda *_: None), [])

    def test_what_is_not_drawn(self):
        def build(tree, shader):
            shader.inputs['Metallic'].default_value = 1.0
            bump = tree.add('Bump')
            tree.tree.links.new(tree.add('TexNoise').outputs[0], bump.inputs['Height'])
            tree.tree.links.new(bump.outputs[0], shader.inputs['Normal'])
            height = next(socket for socket in tree.output.inputs if socket.name == 'Displacement')
            tree.tree.links.new(tree.add('Displacement').outputs[0], height)
            next(socket for socket in shader.inputs if socket.name in {'Sheen', 'Sheen Weight'}).default_value = 0.5
        bump = self.lines(lambda tree, shader: tree.tree.links.new(
            tree.add('NormalMap', None, tree.image()).outputs[0], shader.inputs['Normal']))
        self.assertEqual(bump, ["material 'Test': it is drawn without its normal map or bump"])
        self.assertEqual(len(self.lines(build)), 1)
        for part in ("its displacement", "its normal map or bump", "metallic reflection", "sheen"):
            self.assertIn(part, self.lines(build)[0])

    def test_what_does_not_bend(self):
        self.assertEqual(self.lines(lambda tree, shader: tree.tree.links.new(
            tree.add('NormalMap').outputs[0], shader.inputs['Normal'])), [])

    def test_volume_beside_a_surface(self):
        lines = self.lines(lambda tree, shader: tree.tree.links.new(tree.add('VolumeScatter').outputs[0],
                                                                    tree.output.inputs['Volume']))
        self.assertEqual(lines, ["material 'Test': it is drawn without its volume"])

    def test_attribute_out_of_range(self):
        mesh = add_plane().data
        for number, (kind, value, count) in enumerate((('FLOAT_COLOR', 1.0, 0), ('FLOAT_COLOR', 2.0, 1),
                                                       ('FLOAT', 1.0, 0), ('FLOAT', -0.5, 1))):
            layer = mesh.attributes.new(f"Paint{number}", kind, 'POINT')
            if kind == 'FLOAT':
                layer.data[0].value = value
            else:
                layer.data[0].color = value, 0.0, 0.0, 1.0
            lines = []
            attributes.read_colors(mesh, layer.name, lines.append)
            self.assertEqual(len(lines), count, (kind, value))

    def test_negative_emission(self):
        def build(tree, _shader):
            tree.surface(tree.add('Emission', (1, 1, 1, 1), -2.0).outputs[0])
        self.assertEqual(self.lines(build), ["material 'Test': its negative emission is left out"])


class Emission(SceneTest):
    """Of worlds and lights."""

    def world(self, kind):
        world = bpy.data.worlds.new("World")
        world.use_nodes = True
        tree = world.node_tree
        background = next(node for node in tree.nodes if node.type == 'BACKGROUND')
        node = tree.nodes.new(kind)
        tree.links.new(node.outputs[0], background.inputs['Color'])
        self.scene.world = world
        return world, node

    def test_world_volume(self):
        world, _node = self.world('ShaderNodeRGB')
        tree = world.node_tree
        tree.links.new(tree.nodes.new('ShaderNodeVolumeScatter').outputs[0],
                       next(node for node in tree.nodes if node.type == 'OUTPUT_WORLD').inputs['Volume'])
        lines = []
        emission.of_world(world, lines)
        self.assertEqual(lines, ["world 'World': it is drawn without its volume"])

    def test_world_by_rays(self):
        """It lights as diffuse rays see it."""
        world, path = self.world('ShaderNodeLightPath')
        background = next(node for node in world.node_tree.nodes if node.type == 'BACKGROUND')
        for output, expected in (('Is Camera Ray', 0.0), ('Is Diffuse Ray', 1.0)):
            world.node_tree.links.new(path.outputs[output], background.inputs['Color'])
            lines = []
            self.assertEqual(emission.of_world(world, lines), [expected] * 3)
            self.assertEqual(lines, ["world 'World': node Light Path: it counts as for diffuse surfaces, for the "
                                     "camera too"])

    def test_light_falloff(self):
        light = add_light("Light", 'POINT').data
        light.use_nodes = True
        tree = light.node_tree
        falloff = tree.nodes.new('ShaderNodeLightFalloff')
        falloff.inputs['Strength'].default_value = 3.0
        for output, count in (('Quadratic', 0), ('Linear', 1)):
            tree.links.new(falloff.outputs[output], tree.nodes['Emission'].inputs['Strength'])
            lines = []
            self.assertEqual(emission.of_tree(tree, "light 'Light'", lines), [3.0] * 3)
            self.assertEqual(len(lines), count)

    def test_sky(self):
        """The table against Cycles' panorama."""
        _world, node = self.world('ShaderNodeTexSky')
        camera = add_camera(location=(0, 0, 0), rotation=(pi / 2, 0, 0), type='PANO')
        owner = camera.data if hasattr(camera.data, 'panorama_type') else camera.data.cycles
        owner.panorama_type = 'EQUIRECTANGULAR'
        width, height = self.scene.render.resolution_x, self.scene.render.resolution_y = 32, 16
        self.scene.render.engine = 'CYCLES'
        self.scene.cycles.samples, self.scene.cycles.use_denoising = 16, False
        weights = [sin(pi * (y + 0.5) / height) for y in range(height)]
        for kind in node.bl_rna.properties['sky_type'].enum_items.keys():
            node.sky_type = kind
            if hasattr(node, 'sun_disc'):
                node.sun_disc = False
            for angle in (15, 37, 75):
                node.sun_elevation, node.sun_direction = radians(angle), (cos(radians(angle)), 0, sin(radians(angle)))
                picture = self.render(kind)
                for channel, found in zip('RGB', sky.mean(node)):
                    values = picture[f'ViewLayer.Combined.{channel}'][2]
                    rows = [sum(values[width * y:width * (y + 1)]) / width for y in range(height)]
                    expected = sum(a * b for a, b in zip(weights, rows)) / sum(weights)
                    with self.subTest(kind=kind, angle=angle, channel=channel):
                        # Between the entries of the table, and with a sun or its halo within one of few pixels.
                        self.assertAlmostEqual(found, expected, delta=0.15 * expected)
