# SPDX-License-Identifier: GPL-3.0-or-later
"""Colour spaces of byte images, which come as they are stored. Blender has already made float images linear."""

from array import array
from typing import NamedTuple

from .names import name_of


class Space(NamedTuple):
    to_rec709: tuple    # linear RGB to linear Rec.709, by rows; None: the same primaries
    gamma: float        # exponent; 1 = linear, 0 = the sRGB curve


_P3 = (1.2249402, -0.2249402, 0.0, -0.0420570, 1.0420570, 0.0, -0.0196376, -0.0786361, 1.0982736)
_REC2020 = (1.6604910, -0.5876411, -0.0728499, -0.1245505, 1.1328999, -0.0083494, -0.0181508, -0.1005789, 1.1187297)
_ACESCG = (1.7050510, -0.6217921, -0.0832589, -0.1302565, 1.1408047, -0.0105483, -0.0240033, -0.1289690, 1.1529723)
_ACES2065 = (2.5216861, -1.1341310, -0.3875553, -0.2764799, 1.3727191, -0.0962392, -0.0153781, -0.1529753, 1.1683534)
_XYZ = (3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108, 0.0415560, 0.0556434, -0.2040259, 1.0572252)

_SPACES = {
    'sRGB': Space(None, 0.0),
    'Linear': Space(None, 1.0), 'Linear Rec.709': Space(None, 1.0), 'Raw': Space(None, 1.0),
    'Rec.1886': Space(None, 2.4), 'Rec.2020': Space(_REC2020, 2.4), 'Linear Rec.2020': Space(_REC2020, 1.0),
    'Display P3': Space(_P3, 0.0), 'Linear DCI-P3 D65': Space(_P3, 1.0),
    'Linear ACEScg': Space(_ACESCG, 1.0), 'ACEScg': Space(_ACESCG, 1.0),
    'Linear ACES': Space(_ACES2065, 1.0), 'ACES2065-1': Space(_ACES2065, 1.0),
    'XYZ': Space(_XYZ, 1.0), 'Linear CIE-XYZ D65': Space(_XYZ, 1.0),
}


def decode(raster, image, warnings):
    """Makes an image's Raster linear Rec.709 in place, but for the sRGB curve: True if that is left to do."""
    settings = image.colorspace_settings
    values, channels = raster.values, raster.channels
    if raster.is_float or settings.is_data or channels < 3:
        return not (raster.is_float or settings.is_data)
    space = _SPACES.get(settings.name)
    if space is None:
        warnings.append(f"image '{name_of(image)}': colour space {settings.name} is taken for sRGB")
        space = _SPACES['sRGB']
    if space.to_rec709 is None and space.gamma in (0.0, 1.0):
        return space.gamma == 0.0
    table = _curve(space.gamma)
    planes = [[table[round(255.0 * value)] for value in values[channel::channels]] for channel in range(3)]
    if space.to_rec709:
        planes = _convert(planes, space.to_rec709)
    for channel in range(3):
        values[channel::channels] = array('f', planes[channel])
    return False


def _curve(gamma):
    """Linear values of the 256 bytes."""
    return [srgb_to_linear(byte / 255.0) if gamma == 0.0 else (byte / 255.0) ** gamma for byte in range(256)]


def srgb_to_linear(value):
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def _convert(planes, matrix):
    rows = [matrix[3 * row:3 * row + 3] for row in range(3)]
    return [[max(a * r + b * g + c * h, 0.0) for r, g, h in zip(*planes)] for a, b, c in rows]
