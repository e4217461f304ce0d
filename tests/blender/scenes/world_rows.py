# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds: ambient light and background."""

from material_rows import picture, picture_files
from rows import *


# The floor is lit by all of the upper half of the world; nothing is over it.
def _world(stage, build):
    stage.scene.render.film_transparent = False
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    build(world.node_tree, next(node for node in world.node_tree.nodes if node.type == 'BACKGROUND'))
    stage.scene.world = world


@row('materials')
def world_colour(stage):
    """World colour and strength as ambient light and background."""
    def build(_tree, background):
        background.inputs['Color'].default_value = 0.3, 0.5, 0.9, 1
        background.inputs['Strength'].default_value = 0.5
    _world(stage, build)


@row('materials', until=(5, 0))
def world_without_nodes(stage):
    """`use_nodes` of the world off: its own colour. From Blender 5 on nodes are always used."""
    _world(stage, lambda _tree, _background: None)
    stage.scene.world.use_nodes = False
    stage.scene.world.color = 0.2, 0.3, 0.1


@row('materials')
def world_environment(stage):
    """An environment image, of one colour here: its mean is the ambient light."""
    def build(tree, background):
        texture = tree.nodes.new('ShaderNodeTexEnvironment')
        texture.image = picture(float_buffer=True, color=lambda _x, _y: [0.4, 0.3, 0.2])
        tree.links.new(texture.outputs[0], background.inputs['Color'])
    _world(stage, build)


@row('materials')
def world_none(stage):
    """No world: black."""
    stage.scene.render.film_transparent = False
    stage.cube()


def _other_space():
    """A colour space with other primaries than sRGB."""
    spaces = bpy.types.ColorManagedInputColorspaceSettings.bl_rna.properties['name'].enum_items.keys()
    return next(name for name in ('Display P3', 'Linear ACEScg') if name in spaces)


def _environment(stage, image):
    """The node of a world lit by an environment image."""
    nodes = []

    def build(tree, background):
        nodes.append(tree.nodes.new('ShaderNodeTexEnvironment'))
        nodes[0].image = image
        tree.links.new(nodes[0].outputs[0], background.inputs['Color'])
    _world(stage, build)
    return nodes[0]


@row('materials')
def world_environment_bytes(stage):
    """An environment image of bytes in another colour space than sRGB, with other primaries."""
    _environment(stage, picture(color=lambda _x, _y: [0.8, 0.5, 0.2], color_space=_other_space()))


@row('materials')
def world_environment_sequence(stage):
    """An environment of a sequence of images, at its third."""
    colors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.4, 0.8], [0.0, 0.0, 1.0]]
    image = picture_files(stage, "environment", [lambda _x, _y, color=color: color for color in colors])
    node = _environment(stage, image)
    node.image_user.frame_duration = len(colors)
    node.image_user.use_auto_refresh = True
    stage.frame = 3


@row('materials')
def world_environment_through_nodes(stage):
    """An environment image through nodes that change its colour."""
    node = _environment(stage, picture(float_buffer=True, color=lambda _x, _y: [0.4, 0.3, 0.2]))
    tree = node.id_data
    change, background = tree.nodes.new('ShaderNodeHueSaturation'), node.outputs[0].links[0].to_node
    change.inputs['Saturation'].default_value, change.inputs['Value'].default_value = 0.5, 1.5
    tree.links.new(node.outputs[0], change.inputs['Color'])
    tree.links.new(change.outputs[0], background.inputs['Color'])


@row('materials')
def world_mix(stage):
    """Mix Shader of two Backgrounds."""
    def build(tree, background):
        background.inputs['Color'].default_value = 0.8, 0.2, 0.1, 1
        other, mix = tree.nodes.new('ShaderNodeBackground'), tree.nodes.new('ShaderNodeMixShader')
        other.inputs['Color'].default_value = 0.1, 0.3, 0.9, 1
        mix.inputs[0].default_value = 0.25
        output = background.outputs[0].links[0].to_socket
        tree.links.new(background.outputs[0], mix.inputs[1])
        tree.links.new(other.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], output)
    _world(stage, build)


@row('materials')
def world_without_image(stage):
    """An environment without an image: Cycles' pink."""
    _environment(stage, None)
