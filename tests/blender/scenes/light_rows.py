# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights."""

from math import cos, pi, sin

from rows import *
from scene_rows import second_light, without_shadow


def _only(stage, kind, **settings):
    """Another light instead of the stage's."""
    stage.cube()
    stage.light.hide_render = True
    settings.setdefault('location', (0.8, -0.5, 2.6))
    return add_light("Other", kind, **settings)


@row('scene')
def light_point(stage):
    """A point light with a radius."""
    _only(stage, 'POINT', shadow_soft_size=0.15)


@row('scene')
def light_spot(stage):
    """A spot with a soft edge."""
    _only(stage, 'SPOT', rotation=(0.1, 0.3, 0), spot_size=0.9, spot_blend=0.5, shadow_soft_size=0.04, energy=300)


@row('scene')
def light_sun(stage):
    """A sun of 6 degrees."""
    _only(stage, 'SUN', rotation=(0.3, 0.5, 0), energy=3, angle=0.105)


@row('scene')
def light_disk(stage):
    """A disk."""
    _only(stage, 'AREA', shape='DISK', size=0.8, rotation=(0.2, 0.3, 0))


@row('scene')
def light_ellipse_scaled(stage):
    """An ellipse, scaled and turned."""
    _only(stage, 'AREA', shape='ELLIPSE', size=0.6, size_y=0.3, rotation=(0.2, 0.3, 0.5), scale=(1.5, 2, 1))


@row('scene')
def light_spread(stage):
    """An area light that shines into a cone of 60 degrees."""
    refine(stage)
    _only(stage, 'AREA', size=0.7, spread=radians(60), rotation=(0.1, 0.2, 0))


@row('scene')
def light_without_shadow(stage):
    """A light whose shadow is switched off, beside one with a shadow."""
    stage.cube()
    without_shadow(second_light().data)


@row('scene')
def light_hidden_from_diffuse(stage):
    """A light that no diffuse surface sees."""
    stage.cube()
    second_light().visible_diffuse = False


@row('scene')
def light_portal(stage):
    """An area light that only shows where the world's light comes in, beside one that lights."""
    stage.cube()
    portal = add_light("Portal", 'AREA', location=(-1.2, -1.2, 2.2), size=0.6, energy=200)
    portal.data.cycles.is_portal = True
    stage.scene.world = add_world((0, 0, 0))    # Cycles ends with a crash without one


@row('scene')
def lights_without_scale(stage):
    """Lights whose scale is 0 along all axes or one, beside one that lights."""
    refine(stage)   # Cycles chooses among them for each sample
    stage.cube()
    for number, scale in enumerate(((0, 0, 0), (1, 1, 0), (0, 1, 1))):
        place = {'location': (number - 1, -1.2, 2.2), 'scale': scale}
        add_light("Sun", 'SUN', angle=0, energy=0.5, **place)
        add_light("Spot", 'SPOT', shadow_soft_size=0, energy=60, **place)
        add_light("Area", 'AREA', size=0.4, energy=30, **place)


@row('scene', since=(4, 4))
def light_exposure(stage):
    """Exposure of a light."""
    _only(stage, 'POINT', shadow_soft_size=0.1, energy=25).data.exposure = 1.7


@row('scene', since=(4, 4))
def light_not_normalized(stage):
    """Normalize off: the energy is that of each square metre."""
    _only(stage, 'AREA', shape='DISK', size=0.8, rotation=(0.2, 0.3, 0), scale=(1, 2, 1)).data.normalize = False


@row('scene', since=(4, 4))
def light_temperature(stage):
    """Colour by temperature."""
    data = _only(stage, 'AREA', size=0.6).data
    data.use_temperature, data.temperature = True, 2700


@row('scene')
def light_nodes(stage):
    """An Emission node with colour and strength."""
    data = _only(stage, 'AREA', size=0.6).data
    data.use_nodes = True
    node = next(node for node in data.node_tree.nodes if node.type == 'EMISSION')
    node.inputs['Color'].default_value = 0.2, 0.6, 1, 1
    node.inputs['Strength'].default_value = 1.5


@row('scene')
def lights_many(stage):
    """Twelve lights."""
    stage.cube()
    stage.light.hide_render = True
    for number in range(12):
        angle = 2 * pi * number / 12
        add_light("Small", 'POINT', location=(1.5 * cos(angle), 1.5 * sin(angle), 1.5), energy=15,
                  shadow_soft_size=0.05, color=(1, number / 12, 0.5))
