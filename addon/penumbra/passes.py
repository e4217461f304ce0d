# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes of a view layer: one generator registers them and asks the library for them."""

from array import array
from ctypes import byref, memmove
from typing import NamedTuple

from . import capi
from .names import name_of

LIGHT_PREFIX = "Shadow."
# Bytes of a pass name in Blender.
_NAME_SIZE = 63


class Pass(NamedTuple):
    name: str
    channels: str
    kind: str           # of the compositor's socket
    flag: int           # capi.PASS_*
    background: float   # where the library made no such pass


def list_passes(view_layer):
    """`view_layer` is the original one: the evaluated one lacks lights that are hidden."""
    yield Pass("Combined", "RGBA", 'COLOR', capi.PASS_COMBINED, 0.0)
    if view_layer.use_pass_z:
        yield Pass("Depth", "Z", 'VALUE', capi.PASS_DEPTH, 1e10)
    if view_layer.use_pass_normal:
        yield Pass("Normal", "XYZ", 'VECTOR', capi.PASS_NORMAL, 0.0)
    if view_layer.use_pass_shadow:
        yield Pass("Shadow", "RGB", 'COLOR', capi.PASS_SHADOW, 1.0)
    if view_layer.penumbra.use_pass_light_shadows:
        for name in dict.fromkeys(map(light_pass_name, _light_names(view_layer.objects))):
            yield Pass(name, "RGB", 'COLOR', capi.PASS_LIGHT_SHADOWS, 1.0)


def _light_names(objects):
    """Of lights among the objects and in collections that they instance. Each instance of a light has a pass of its
    own, whose name the library numbers."""
    counts = {}
    for ob in _lights(objects, ()):
        name = name_of(ob)
        number = counts[name] = counts.get(name, -1) + 1
        yield f"{name}.{number:03}" if number else name


def _lights(objects, around):
    """`around`: the collections whose instances the objects are in."""
    for ob in objects:
        if ob.type == 'LIGHT':
            yield ob
        elif ob.instance_type == 'COLLECTION' and ob.instance_collection and ob.instance_collection not in around:
            yield from _lights(ob.instance_collection.all_objects, (*around, ob.instance_collection))


def light_pass_name(light_name):
    return (LIGHT_PREFIX + light_name).encode()[:_NAME_SIZE].decode(errors='ignore')


def wanted(view_layer):
    """The library's pass flags."""
    flags = 0
    for item in list_passes(view_layer):
        flags |= item.flag
    return flags


def fill_layer(render_layer, view_layer, job, width, height):
    """Writes a finished job into a render layer: all passes one after the other, as Blender keeps them. Gives the names
    of images that have no pass there."""
    images = _images(job)
    backgrounds = {item.name: item.background for item in list_passes(view_layer)}
    pixels = array('f')
    for render_pass in render_layer.passes:
        count = width * height * render_pass.channels
        image = images.get(render_pass.name)
        if image and image.channels == render_pass.channels and (image.width, image.height) == (width, height):
            start = len(pixels)
            pixels.frombytes(bytes(4 * count))
            memmove(pixels.buffer_info()[0] + 4 * start, image.pixels, 4 * count)
        else:
            pixels.extend(array('f', [backgrounds.get(render_pass.name, 0.0)]) * count)
    render_layer.passes.foreach_set('rect', pixels)
    return sorted(images.keys() - backgrounds.keys())


def _images(job):
    """Images by pass name; of lights with one name the first."""
    images = {}
    for index in range(capi.library().job_image_count(job)):
        image = capi.Image()
        capi.library().job_get_image(job, index, byref(image))
        images.setdefault(image.name[:_NAME_SIZE].decode(errors='ignore'), image)
    return images
