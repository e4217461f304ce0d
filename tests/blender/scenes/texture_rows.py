# SPDX-License-Identifier: GPL-3.0-or-later
"""Sequences and alpha of images, attributes of meshes, and nodes between a texture and a shader."""

from material_rows import Nodes, paint, picture, picture_files, principled, textured, unwrap
from rows import *


def _shades(number):
    """The chequered picture in another colour each time."""
    def color(x, y):
        grey = 0.8 if (x + y) % 2 else 0.3
        return [grey * (0.25 + 0.25 * number), grey * (1.0 - 0.2 * number), grey]
    return color


@row('materials')
def image_sequence(stage):
    """A sequence of images, at the picture of this frame."""
    image = picture_files(stage, "sequence", [_shades(number) for number in range(4)])
    _nodes, texture, _diffuse = textured(stage, image)
    user = texture.image_user
    user.frame_duration, user.frame_start, user.frame_offset, user.use_auto_refresh = 3, 5, 1, True
    stage.frame = 6


@row('materials')
def image_sequence_repeats(stage):
    """A sequence that starts again after its last picture, in another colour space."""
    image = picture_files(stage, "cyclic", [_shades(number) for number in range(3)])
    image.colorspace_settings.name = 'Non-Color'
    _nodes, texture, _diffuse = textured(stage, image)
    user = texture.image_user
    user.frame_duration, user.use_cyclic, user.use_auto_refresh = 3, True, True
    stage.frame = 8


@row('materials')
def image_none(stage):
    """An Image Texture without an image: Cycles' pink."""
    textured(stage, None)


@row('materials')
def uv_map_missing(stage):
    """A UV Map node that names a map which is not there: one texel everywhere."""
    def change(nodes, texture):
        node = nodes.add('UVMap')
        node.uv_map = "Lost"
        nodes.link(node.outputs[0], texture.inputs['Vector'])
    textured(stage, picture(), change=change)


@row('materials')
def image_multiplied(stage):
    """An image times a constant colour, by Mix nodes."""
    def change(nodes, texture):
        mix, diffuse = nodes.add('MixRGB', Color2=(0.5, 1.0, 0.2, 1.0)), texture.outputs[0].links[0].to_node
        mix.blend_type = 'MULTIPLY'
        mix.inputs[0].default_value = 0.75
        nodes.link(texture.outputs['Color'], mix.inputs[1])
        nodes.link(mix.outputs[0], diffuse.inputs['Color'])
    textured(stage, picture(), change=change)


@row('materials')
def constants_through_nodes(stage):
    """A colour through Math, Color Ramp, Mix and others."""
    nodes = Nodes()
    math, ramp, hue, mix = (nodes.add(kind) for kind in ('Math', 'ValToRGB', 'HueSaturation', 'MixRGB'))
    math.operation = 'MULTIPLY'
    math.inputs[0].default_value, math.inputs[1].default_value = 0.8, 0.4
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.9, 0.1, 0.2, 1), (0.1, 0.6, 0.3, 1)
    hue.inputs['Hue'].default_value, hue.inputs['Saturation'].default_value = 0.6, 0.8
    mix.blend_type = 'SCREEN'
    mix.inputs[0].default_value, mix.inputs[2].default_value = 0.5, (0.3, 0.4, 0.1, 1)
    diffuse = nodes.add('BsdfDiffuse')
    for output, socket in ((math.outputs[0], ramp.inputs[0]), (ramp.outputs[0], hue.inputs['Color']),
                           (hue.outputs[0], mix.inputs[1]), (mix.outputs[0], diffuse.inputs['Color'])):
        nodes.link(output, socket)
    paint(stage, nodes.surface(diffuse.outputs[0]))


def _attribute(stage, kind, domain, name="Paint"):
    """Floor and cube in the colours of an attribute; a material that names the attribute `name`."""
    nodes = Nodes()
    source, diffuse = nodes.add('Attribute'), nodes.add('BsdfDiffuse')
    source.attribute_name = name
    nodes.link(source.outputs['Color'], diffuse.inputs['Color'])
    paint(stage, nodes.surface(diffuse.outputs[0]))
    for ob in (stage.floor, bpy.data.objects["Cube"]):
        layer = ob.data.attributes.new("Paint", kind, domain)
        for index, element in enumerate(layer.data):
            color = ((0.9, 0.2, 0.1, 1), (0.1, 0.5, 0.8, 1), (0.3, 0.7, 0.2, 1))[index % 3]
            if hasattr(element, 'color'):
                element.color = color
            elif hasattr(element, 'vector'):
                element.vector = color[:len(element.vector)]
            else:
                element.value = color[0] > 0.2 if kind == 'BOOLEAN' else color[0]


@row('materials')
def attribute_of_faces(stage):
    """Colours of faces."""
    _attribute(stage, 'FLOAT_COLOR', 'FACE')


@row('materials')
def attribute_of_vectors(stage):
    """Vectors of vertices as colours."""
    _attribute(stage, 'FLOAT_VECTOR', 'POINT')


@row('materials')
def attribute_of_numbers(stage):
    """Numbers of corners as grey."""
    _attribute(stage, 'FLOAT', 'CORNER')


@row('materials')
def attribute_of_switches(stage):
    """Switches of faces as black and white."""
    _attribute(stage, 'BOOLEAN', 'FACE')


@row('materials')
def attribute_missing(stage):
    """An attribute that the mesh does not have: black. The other cube is there for its light."""
    refine(stage)
    _attribute(stage, 'FLOAT_COLOR', 'POINT', name="Lost")
    stage.cube(half=0.45, location=(0.8, 0.3, 0.5), rotation=(0, 0, 0.3))


# ---- Alpha of images ----

def _thirds(x, y):
    return [0.0, 0.5, 1.0][(x + y) % 3]


@row('materials')
def image_alpha_unused(stage):
    """Bytes with alpha, of which only the colour is used: it is multiplied with alpha."""
    refine(stage)   # a dark picture
    textured(stage, picture(alpha=_thirds))


@row('materials')
def image_alpha_unused_data(stage):
    """Non-colour data with alpha: colours as they are stored."""
    textured(stage, picture(alpha=_thirds, color_space='Non-Color'))


@row('materials')
def image_alpha_float(stage):
    """Floats with alpha, both used: colours are divided by alpha."""
    image = picture(alpha=_thirds, float_buffer=True)
    image.alpha_mode = 'PREMUL'     # Cycles 5.2 takes those that no file has for straight otherwise, others do not
    _decal(stage, image)


@row('materials')
def image_alpha_ignored(stage):
    """An image whose alpha mode is None."""
    image = picture(alpha=_thirds)
    image.alpha_mode = 'NONE'
    _decal(stage, image)


def _decal(stage, image):
    """A cube with colour and alpha of an image."""
    nodes = Nodes()
    texture, shader = nodes.add('TexImage'), principled(nodes)
    texture.image, texture.interpolation = image, 'Closest'
    nodes.link(texture.outputs['Color'], shader.inputs['Base Color'])
    nodes.link(texture.outputs['Alpha'], shader.inputs['Alpha'])
    unwrap(stage.cube(material=nodes.surface(shader.outputs[0])))
