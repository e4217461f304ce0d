# SPDX-License-Identifier: GPL-3.0-or-later
"""Attributes of a mesh that materials read as colours, whatever their type and domain."""

from array import array
from typing import NamedTuple

_BLACK = (0.0, 0.0, 0.0, 1.0)

# By the attribute's type: (RNA property, its type code, its numbers).
_TYPES = {
    'FLOAT_COLOR': ('color', 'f', 4), 'BYTE_COLOR': ('color', 'f', 4), 'FLOAT_VECTOR': ('vector', 'f', 3),
    'FLOAT2': ('vector', 'f', 2), 'FLOAT': ('value', 'f', 1), 'INT': ('value', 'i', 1), 'INT8': ('value', 'i', 1),
    'BOOLEAN': ('value', 'b', 1),
}


class Colors(NamedTuple):
    member: str     # of pnb_mesh_desc
    values: array   # RGBA of each element, linear


def read_colors(mesh, attribute, warn):
    """The Colors of an attribute; '': the colour attribute for renders. What is not there is black, as in Cycles."""
    layer = mesh.attributes.get(attribute) if attribute else _for_renders(mesh)
    if layer is None:
        warn(f"it has no colour attribute '{attribute}' and is black there" if attribute else
             "it has no colour attribute and is black there")
        return Colors('vertex_colors', array('f', _BLACK * len(mesh.vertices)))
    if layer.data_type not in _TYPES:
        warn(f"attribute '{layer.name}' cannot be a colour, it is black")
        return Colors('vertex_colors', array('f', _BLACK * len(mesh.vertices)))
    values = _rgba(layer)
    if layer.data_type != 'BYTE_COLOR' and len(values) and (max(values) > 1.0 or min(values) < 0.0):
        warn(f"attribute '{layer.name}' is cut off at 0 and 1")
    if layer.domain == 'CORNER':
        return Colors('corner_colors', values)
    if layer.domain == 'FACE':
        return Colors('corner_colors', _of_corners(mesh, values))
    if layer.domain == 'EDGE':
        warn(f"attribute '{layer.name}' of edges counts by its mean")
        return Colors('vertex_colors', array('f', _mean(values) * len(mesh.vertices)))
    return Colors('vertex_colors', values)


def _for_renders(mesh):
    colors = mesh.color_attributes
    index = getattr(colors, 'render_color_index', -1)
    return colors[index if 0 <= index < len(colors) else 0] if len(colors) else None


def _rgba(layer):
    name, typecode, width = _TYPES[layer.data_type]
    count = len(layer.data)
    found = array(typecode, bytes(array(typecode).itemsize * width * count))
    layer.data.foreach_get(name, found)
    if width == 4:
        return found
    values = array('f', _BLACK * count)
    for channel in range(3):
        if width == 1 or channel < width:
            values[channel::4] = array('f', found[min(channel, width - 1)::width])
    return values


def _of_corners(mesh, values):
    """Each corner has the colour of its face."""
    found = array('f')
    for polygon in mesh.polygons:
        found.extend(values[4 * polygon.index:4 * polygon.index + 4] * polygon.loop_total)
    return found


def _mean(values):
    count = max(len(values) // 4, 1)
    return tuple(sum(values[channel::4]) / count for channel in range(4))
