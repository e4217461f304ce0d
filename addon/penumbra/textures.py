# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender image -> pnb_texture."""

from array import array
from ctypes import c_void_p

from . import capi, color_spaces
from .names import name_of

# Uses of an image: its colour, its alpha channel, or its brightness as alpha.
COLOR, ALPHA, GREY = 'color', 'alpha', 'grey'


class TextureCache:
    """Textures of unedited image files, kept while an animation is rendered: images cannot be reloaded meanwhile."""

    def __init__(self):
        self._kept = {}

    def get(self, image, use, flags, warnings):
        """(handle or None, whether the caller has to destroy it). `flags`: capi.TEXTURE_*."""
        key = (image.library and image.library.filepath, name_of(image), use, flags)
        state = (tuple(image.size), image.filepath, image.colorspace_settings.name, image.alpha_mode)
        keep = image.source == 'FILE' and not image.is_dirty
        if keep and self._kept.get(key, (None,))[0] == state:
            return self._kept[key][1], False
        handle = _create(image, use, flags, warnings)
        if not keep or handle is None:
            return handle, True
        self._drop(key)
        self._kept[key] = state, handle
        return handle, False

    def _drop(self, key):
        if key in self._kept:
            capi.library().destroy('texture', self._kept.pop(key)[1])

    def clear(self):
        for key in list(self._kept):
            self._drop(key)


cache = TextureCache()


_EXTENSIONS = {'EXTEND': capi.TEXTURE_EXTEND, 'CLIP': capi.TEXTURE_CLIP, 'MIRROR': capi.TEXTURE_MIRROR}


def node_flags(node):
    """Of an Image Texture node."""
    nearest = capi.TEXTURE_NEAREST if node.interpolation == 'Closest' else 0
    return nearest | _EXTENSIONS.get(node.extension, 0)


def pixels_of(image):
    """Floats as RNA gives them, or None if the image is missing."""
    width, height = image.size
    if not width or not height:
        return None
    pixels = array('f', bytes(4 * len(image.pixels)))
    image.pixels.foreach_get(pixels)
    return pixels if image.has_data else None


def _create(image, use, flags, warnings):
    width, height = image.size
    pixels = pixels_of(image)
    if pixels is None:
        warnings.append(f"image '{name_of(image)}' is missing ({image.filepath or 'no file'})")
        return None
    if image.source in {'MOVIE', 'SEQUENCE', 'TILED'}:
        warnings.append(f"image '{name_of(image)}': of a {image.source.lower()} only one picture is used")
    channels = image.channels
    first, count = _channels(channels, use)
    desc = capi.TextureDesc(name=name_of(image).encode(), width=width, height=height, channels=count, flags=flags)
    if use != ALPHA:
        desc.is_srgb = color_spaces.decode(pixels, channels, image, warnings)
    desc.pixels.data = c_void_p(pixels.buffer_info()[0] + 4 * first)
    desc.pixels.stride = 4 * channels
    try:
        return capi.library().create('texture', desc)
    except capi.Error as error:
        warnings.append(f"image '{name_of(image)}': {error}")
        return None


def _channels(channels, use):
    """First channel and their number."""
    if use == ALPHA:
        return channels - 1, 1
    return 0, 3 if channels >= 3 else 1
