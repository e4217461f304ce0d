# SPDX-License-Identifier: GPL-3.0-or-later
"""The mean colour of an environment image."""

from math import pi, sin

from . import color_spaces, textures
from .names import name_of

# Rows and columns that are looked at; a mean needs no more.
_SIDE = 256


def mean(image, warnings):
    """Linear mean over the sphere: rows of an equirectangular picture count by the sine of their angle to the pole."""
    pixels = textures.pixels_of(image)
    if pixels is None:
        warnings.append(f"image '{name_of(image)}' is missing ({image.filepath or 'no file'})")
        return [1.0, 0.0, 1.0]
    width, height = image.size
    channels = image.channels
    step = channels * max(width // _SIDE, 1)
    sums, total = [0.0] * 3, 0.0
    encoded = not (image.is_float or image.colorspace_settings.is_data)
    for y in range(0, height, max(height // _SIDE, 1)):
        weight = sin(pi * (y + 0.5) / height)
        start = channels * width * y
        for channel in range(3):
            values = pixels[start + min(channel, channels - 1):start + channels * width:step]
            if encoded:
                values = [color_spaces.srgb_to_linear(value) for value in values]
            sums[channel] += weight * sum(values) / len(values)
        total += weight
    return [value / total for value in sums]
