# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender image -> pnb_texture."""

import os
import time
import zlib
from array import array
from ctypes import c_void_p
from operator import mul

import bpy

from . import capi, color_spaces, images
from .names import name_of

# Uses of an image: its colour, which is its brightness where a number is asked for, straight or multiplied with its
# alpha channel, or that channel.
STRAIGHT, PREMULTIPLIED, ALPHA = 'straight', 'premultiplied', 'alpha'

# Files that changed since then may not be what Blender had read before, or be read anew unnoticed.
_start = time.time()


class TextureCache:
    """Textures kept from export to export while their images are sure to have the same content."""

    def __init__(self, watches=False):
        """`watches`: its owner asks it for changes between exports; else the pixels of young files are compared."""
        self._kept = {}         # key: (state, handle, its lines of the report)
        self._used = set()      # keys, by the export that is made
        self._seen = {}         # key: _signature of the image at the last export
        self._watches = watches

    def get(self, image, file, use, flags, warnings):
        """(handle or None, whether the caller has to destroy it). `file`: see images.read; `flags`: capi.TEXTURE_*."""
        key = (image.library and image.library.filepath, name_of(image), file, use, flags)
        state = self._state(image, file)
        self._used.add(key)
        kept, handle, lines = self._kept.get(key, (None, None, []))
        if state is None or kept != state:
            lines = []
            handle = _create(image, file, use, flags, lines)
            if state and handle:
                self._drop(key)
                self._kept[key] = state, handle, lines
        self._note(key)
        warnings.extend(lines)
        return handle, not (state and handle)

    def watch(self, image):
        """Its changes count though it is no texture."""
        key = (image.library and image.library.filepath, name_of(image))
        self._used.add(key)
        self._note(key)

    def _note(self, key):
        if self._watches:
            self._seen[key] = _signature(_image(*key[:2]))

    def _state(self, image, file):
        """What the texture depends on, or None if the image is missing."""
        is_file = file or image.source == 'FILE' and not image.is_dirty
        content = _content(image, file, self._watches) if is_file else None
        content = content or images.checksum(image)     # takes less than making the texture
        return content and (content, image.colorspace_settings.name, image.alpha_mode)

    def end_export(self):
        """Of a sequence, another picture comes with every frame: those that were not used are dropped."""
        for key in [key for key in self._kept if key[2] and key not in self._used]:
            self._drop(key)
        self._seen = {key: signature for key, signature in self._seen.items() if key in self._used}
        self._used = set()

    def changed(self):
        """Names and libraries of images that were painted or reloaded since the last export: Blender draws a viewport
        again then, without an update."""
        return {key[:2] for key, signature in self._seen.items() if signature != _signature(_image(*key[:2]))}

    def forget(self, changed):
        for key in [key for key in self._kept if key[:2] in changed]:
            self._drop(key)

    def _drop(self, key):
        if key in self._kept:
            capi.library().destroy('texture', self._kept.pop(key)[1])

    def clear(self):
        for key in list(self._kept):
            self._drop(key)
        self._seen = {}


cache = TextureCache()


def _image(library, name):
    return bpy.data.images.get((name, library)) if library else bpy.data.images.get(name)


def _signature(image):
    """Differs once the image is painted or reloaded, which frees its pixels."""
    if image is None:
        return None
    is_file = image.source == 'FILE' and not image.is_dirty
    return (image.has_data, image.is_dirty, is_file and _date(images.path_of(image)),
            image.is_dirty and images.checksum(image))


def _date(path):
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        return None
    return path, found.st_dev, found.st_ino, found.st_size, found.st_mtime_ns, found.st_ctime_ns


def _content(image, file, watches):
    """Identifies the pixels of an unedited image by its file, without reading it; None if they may be others."""
    if image.packed_file:
        return image.packed_file.size, 0 if watches else zlib.crc32(image.packed_file.data)
    date = _date(images.path_of(image, file))
    is_young = date is not None and date[-1] > _start * 1e9
    return None if is_young and not file and not watches else date


_EXTENSIONS = {'EXTEND': capi.TEXTURE_EXTEND, 'CLIP': capi.TEXTURE_CLIP, 'MIRROR': capi.TEXTURE_MIRROR}


def node_flags(node):
    """Of an Image Texture node."""
    nearest = capi.TEXTURE_NEAREST if node.interpolation == 'Closest' else 0
    return nearest | _EXTENSIONS.get(node.extension, 0)


def _create(image, file, use, flags, warnings):
    raster = images.read(image, file, warnings)
    if raster is None:
        return None
    first, count = _channels(raster.channels, use)
    desc = capi.TextureDesc(name=name_of(image).encode(), width=raster.width, height=raster.height, channels=count,
                            flags=flags)
    if use != ALPHA:
        _associate(raster, image, use)
        desc.is_srgb = color_spaces.decode(raster, image, warnings)
    desc.pixels.data = c_void_p(raster.values.buffer_info()[0] + 4 * first)
    desc.pixels.stride = 4 * raster.channels
    try:
        return capi.library().create('texture', desc)
    except capi.Error as error:
        warnings.append(f"image '{name_of(image)}': {error}")
        return None


def _associate(raster, image, use):
    """Blender has bytes straight and floats premultiplied. Cycles multiplies colours as they are stored."""
    is_premultiplied = raster.is_float
    if (raster.channels < 4 or is_premultiplied == (use == PREMULTIPLIED)
            or image.alpha_mode not in {'STRAIGHT', 'PREMUL'} or image.colorspace_settings.is_data):
        return
    alpha = raster.values[3::4]
    if alpha == array('f', [1.0]) * len(alpha):
        return
    change = _divided if is_premultiplied else mul
    for channel in range(3):
        raster.values[channel::4] = array('f', map(change, raster.values[channel::4], alpha))


def _divided(color, alpha):
    return color / alpha if alpha else color


def _channels(channels, use):
    """First channel and their number."""
    if use == ALPHA:
        return channels - 1, 1
    return 0, 3 if channels >= 3 else 1
