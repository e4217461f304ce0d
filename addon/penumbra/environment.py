# SPDX-License-Identifier: GPL-3.0-or-later
"""The mean colour of an environment image."""

from array import array
from math import pi, sin

from . import color_spaces, images

# Rows and columns that are looked at; a mean needs no more.
_SIDE = 256


def mean(image, file, warnings):
    """Linear mean over the sphere: rows of an equirectangular picture count by the sine of their angle to the pole.
    `file`: see images.read."""
    raster = images.read(image, file, warnings)
    if raster is None:
        return images.MISSING
    raster = _thinned(raster)
    is_srgb = color_spaces.decode(raster, image, warnings)
    decoded = color_spaces.srgb_to_linear if is_srgb else float
    weights = [sin(pi * (y + 0.5) / raster.height) for y in range(raster.height)]
    sums = [0.0] * 3
    for y, weight in enumerate(weights):
        row = raster.values[y * raster.width * raster.channels:(y + 1) * raster.width * raster.channels]
        for channel in range(3):
            values = row[min(channel, raster.channels - 1)::raster.channels]
            sums[channel] += weight * sum(map(decoded, values)) / raster.width
    return [value / sum(weights) for value in sums]


def _thinned(raster):
    """Some rows and columns, in up to three channels."""
    step_x, step_y = max(raster.width // _SIDE, 1), max(raster.height // _SIDE, 1)
    columns, rows = range(0, raster.width, step_x), range(0, raster.height, step_y)
    channels = 3 if raster.channels >= 3 else 1
    stride = raster.channels
    values = array('f')
    for y in rows:
        row = raster.values[stride * raster.width * y:stride * raster.width * (y + 1)]
        values.extend(row[stride * x + channel] for x in columns for channel in range(channels))
    return raster._replace(values=values, width=len(columns), height=len(rows), channels=channels)
