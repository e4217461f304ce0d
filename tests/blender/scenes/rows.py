# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows of the scene comparison and the stage they play on."""

from dataclasses import dataclass, field
from math import radians

import bpy

from harness import add_camera, add_cube, add_light, add_mesh, add_object, add_plane, add_world, white_material

__all__ = ['ROWS', 'Stage', 'row', 'refine', 'radians', 'bpy', 'add_camera', 'add_cube', 'add_light', 'add_mesh',
           'add_object', 'add_plane', 'add_world', 'white_material']

ROWS = []

WIDTH, HEIGHT = 96, 64

# Largest errors that pass, unless a row says why it needs others.
# Coverage: mean difference of alpha; a tenth of the pixels touch outlines, where half of one sub-pixel sample in 144
# and Cycles' noise are .0004 together. Position: distance of the centres of light, in pixels. Light: RMSE over the
# mean, of which the noise of 256 samples of Cycles and of our sub-pixel samples is up to .018.
LIMITS = {'coverage': 0.002, 'position': 0.1, 'light': 0.02}


def refine(stage):
    """More samples of both, for a picture that is mostly outlines, or mostly dark: noise counts more there."""
    stage.scene.cycles.samples, stage.scene.penumbra.samples = 1024, 576


@dataclass
class Row:
    group: str
    name: str
    text: str
    build: object
    versions: tuple     # (first, last) with None for any
    limits: dict
    channel: str        # pass whose channels are compared as light

    def fits(self, version):
        first, last = self.versions
        return (first is None or version >= first) and (last is None or version < last)


def row(group, since=None, until=None, channel='Combined', **limits):
    """Registers a builder `(stage)`; its docstring is the text of the report."""
    def register(build):
        ROWS.append(Row(group, build.__name__, ' '.join(build.__doc__.split()), build, (since, until),
                        {**LIMITS, **limits}, channel))
        return build
    return register


@dataclass
class Stage:
    """An empty scene with a floor, a light and a camera. A builder changes it, and may say what is compared."""
    scene: object
    folder: str                     # for files of the row
    layer: str = 'ViewLayer'
    view: str = ''                  # of stereo
    frame: int = 1
    for_cycles: object = None       # called before Cycles renders: what has another name there
    for_penumbra: object = None
    material: object = field(default_factory=white_material)

    def __post_init__(self):
        scene, render = self.scene, self.scene.render
        render.resolution_x, render.resolution_y, render.resolution_percentage = WIDTH, HEIGHT, 100
        render.film_transparent = True
        scene.world = None
        self.floor = self.show(add_plane(half=1.6))
        self.light = add_light("Key", 'AREA', location=(1.2, -0.6, 3.0), rotation=(0.2, 0.4, 0), energy=200, size=0.6)
        self.camera = add_camera(location=(0, -4.2, 4.2), rotation=(radians(45), 0, 0))

    def show(self, ob, material=None):
        """Gives the object the stage's material."""
        ob.data.materials.append(material or self.material)
        return ob

    def cube(self, half=0.35, location=(-0.2, 0.1, 0.5), rotation=(0.3, 0.2, 0.4), material=None, **place):
        return self.show(add_cube(half=half, location=location, rotation=rotation, **place), material)

    def modifier(self, ob, kind, **settings):
        modifier = ob.modifiers.new(kind, kind)
        for key, value in settings.items():
            setattr(modifier, key, value)
        return modifier
