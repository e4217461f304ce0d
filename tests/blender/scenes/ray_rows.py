# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials, lamps and worlds that are others to other rays, by a Light Path node."""

from material_rows import Nodes
from rows import *
from scene_rows import second_light


def _mixed(stage, ray, *shaders):
    """A cube of two shaders, the second of which this kind of ray meets."""
    nodes = Nodes()
    mix = nodes.add('MixShader')
    nodes.link(nodes.add('LightPath').outputs[ray], mix.inputs[0])
    for kind, socket in zip(shaders, mix.inputs[1:]):
        nodes.link(nodes.add(kind).outputs[0], socket)
    stage.cube(material=nodes.surface(mix.outputs[0]))


def _use_nodes(block):
    block.use_nodes = True
    return block.node_tree


@row('materials')
def transparent_to_shadow_rays(stage):
    """Transparent where Is Shadow Ray: no shadow."""
    _mixed(stage, 'Is Shadow Ray', 'BsdfDiffuse', 'BsdfTransparent')


@row('materials')
def opaque_to_camera_rays(stage):
    """Transparent but where Is Camera Ray: no shadow."""
    _mixed(stage, 'Is Camera Ray', 'BsdfTransparent', 'BsdfDiffuse')


@row('materials')
def transparent_to_camera_rays(stage):
    """Transparent where Is Camera Ray: nothing but the shadow."""
    _mixed(stage, 'Is Camera Ray', 'BsdfDiffuse', 'BsdfTransparent')


@row('materials')
def lamp_by_rays(stage):
    """A lamp as bright as Is Diffuse Ray: Cycles asks lamps without a ray, so it is dark."""
    stage.cube()
    tree = _use_nodes(second_light().data)
    emission = next(node for node in tree.nodes if node.type == 'EMISSION')
    tree.links.new(tree.nodes.new('ShaderNodeLightPath').outputs['Is Diffuse Ray'], emission.inputs['Strength'])


@row('materials')
def world_by_rays(stage):
    """A world as bright as Is Diffuse Ray: ambient light."""
    world = bpy.data.worlds.new("World")
    tree = _use_nodes(world)
    background = next(node for node in tree.nodes if node.type == 'BACKGROUND')
    background.inputs['Color'].default_value = 0.3, 0.5, 0.9, 1
    tree.links.new(tree.nodes.new('ShaderNodeLightPath').outputs['Is Diffuse Ray'], background.inputs['Strength'])
    stage.scene.world = world
