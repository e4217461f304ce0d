# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels of Blender's images: of the file of a sequence that a node shows at this frame, too."""

import os
import zlib
from array import array
from typing import NamedTuple

import bpy

from .names import name_of

# Instead of an image that is missing, as Cycles draws it.
MISSING = [1.0, 0.0, 1.0]


class Raster(NamedTuple):
    """Floats as RNA gives them: bytes as they are stored, float images in linear Rec.709."""
    values: array
    width: int
    height: int
    channels: int
    is_float: bool


def sequence_file(image, user):
    """Path of the picture that an image user shows of a sequence; '' for any other image."""
    return image.filepath_from_user(image_user=user) if image.source == 'SEQUENCE' else ''


def path_of(image, file=''):
    return file or bpy.path.abspath(image.filepath, library=image.library)


def read(image, file, warnings):
    """The Raster of an image, or of the picture of a sequence in `file`; None, and a line, if it is missing."""
    raster = _read_file(image, file) if file or image.source == 'SEQUENCE' else _read(image)
    if raster is None:
        warnings.append(f"image '{name_of(image)}' is missing ({file or image.filepath or 'no file'})")
    elif image.source == 'MOVIE':
        warnings.append(f"image '{name_of(image)}': of a movie only the first picture is used")
    elif image.source == 'TILED':
        warnings.append(f"image '{name_of(image)}': of its tiles only the first is used")
    return raster


def checksum(image):
    """Of its pixels; None without any."""
    raster = _read(image)
    return raster and zlib.adler32(raster.values)


def _read_file(image, file):
    """RNA gives the pixels of no picture but the first. The others are loaded as images of their own, beside the
    .blend's data: Blender crashes where those change during a render."""
    if not os.path.isfile(file):
        return None
    with bpy.data.temp_data() as data:
        loaded = data.images.load(file)
        loaded.colorspace_settings.name = image.colorspace_settings.name
        loaded.alpha_mode = image.alpha_mode
        return _read(loaded)


def _read(image):
    width, height = image.size
    if not width or not height:
        return None
    values = array('f', bytes(4 * len(image.pixels)))
    image.pixels.foreach_get(values)
    return Raster(values, width, height, image.channels, image.is_float) if image.has_data else None
