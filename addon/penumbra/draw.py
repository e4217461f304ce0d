# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures and text in a region. Only while Blender draws one: at other times there is no GPU to draw with."""

import textwrap

import blf
import bpy
import gpu
from gpu_extras.presets import draw_texture_2d

_FONT = 0
_TEXT_POINTS = 13


def make_texture(width, height, pixels):
    """Texture of RGBA floats, a ctypes array."""
    buffer = gpu.types.Buffer('FLOAT', len(pixels), pixels)
    return gpu.types.GPUTexture((width, height), format='RGBA32F', data=buffer)


def draw_picture(texture, x, y, width, height):
    """Scene-linear premultiplied colours: Blender applies the view transform afterwards."""
    gpu.state.blend_set('ALPHA_PREMULT')
    draw_texture_2d(texture, (x, y), width, height)
    gpu.state.blend_set('NONE')


def draw_message(region, message):
    """An error, wrapped, in the middle of the region."""
    scale = bpy.context.preferences.system.ui_scale
    size = _TEXT_POINTS * scale
    blf.size(_FONT, size)
    characters = max(20, int(0.8 * region.width / (0.55 * size)))
    lines = [part for line in message.splitlines() for part in textwrap.wrap(line, characters)]
    y = 0.5 * region.height + 0.5 * len(lines) * 1.4 * size
    blf.enable(_FONT, blf.SHADOW)
    blf.shadow(_FONT, 5, 0.0, 0.0, 0.0, 1.0)
    blf.color(_FONT, 1.0, 0.5, 0.2, 1.0)
    for line in lines:
        width, _height = blf.dimensions(_FONT, line)
        y -= 1.4 * size
        blf.position(_FONT, 0.5 * (region.width - width), y, 0)
        blf.draw(_FONT, line)
    blf.disable(_FONT, blf.SHADOW)
