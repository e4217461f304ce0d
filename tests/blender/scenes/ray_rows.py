# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials that are others to other rays, by a Light Path node."""

from material_rows import Nodes
from rows import *


def _mixed(stage, ray, *shaders):
    """A cube of two shaders, the second of which this kind of ray meets."""
    nodes = Nodes()
    mix = nodes.add('MixShader')
    nodes.link(nodes.add('LightPath').outputs[ray], mix.inputs[0])
    for kind, socket in zip(shaders, mix.inputs[1:]):
        nodes.link(nodes.add(kind).outputs[0], socket)
    stage.cube(material=nodes.surface(mix.outputs[0]))


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
