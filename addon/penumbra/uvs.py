# SPDX-License-Identifier: GPL-3.0-or-later
"""What feeds the Vector of an image texture: a UV map and a 2 x 3 matrix that moves it."""

from mathutils import Euler, Matrix, Vector

from . import values
from .names import name_of

IDENTITY = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)


def placement(texture, warn):
    """(name of the UV map or '', matrix) of what is linked to an Image Texture node; `texture`: its nodes.Source."""
    matrix = Matrix()
    source = texture.input('Vector')
    while source.output and source.output.node.type == 'MAPPING':
        matrix = matrix @ _mapping(source, warn)
        source = source.input('Vector')
    return _uv_map(source, texture.output.node, warn), _rows(matrix)


def _rows(matrix):
    return tuple(matrix[row][column] for row in (0, 1) for column in (0, 1, 3))


def _mapping(source, warn):
    """Of a Mapping node, as Blender applies it to points."""
    node = source.output.node
    location, rotation, scale = (_vector(source, name, default, warn) for name, default in
                                 (('Location', 0.0), ('Rotation', 0.0), ('Scale', 1.0)))
    turn = Euler(rotation).to_matrix().to_4x4()
    if node.vector_type == 'TEXTURE':
        unscaled = _scaled([1.0 / value if value else 0.0 for value in scale])
        return unscaled @ turn.inverted() @ Matrix.Translation(-location)
    if node.vector_type == 'VECTOR':
        return turn @ _scaled(scale)
    if node.vector_type == 'NORMAL':
        warn(f"node {name_of(node)}: the kind Normal is not supported, it is taken for Point")
    return Matrix.Translation(location) @ turn @ _scaled(scale)


def _scaled(scale):
    return Matrix.Diagonal((*scale, 1.0))


def _vector(source, name, default, warn):
    if name not in source.output.node.inputs:
        return Vector([default] * 3)
    value = values.constant(source.input(name), [default] * 3)
    if value is None:
        warn(f"nodes linked to '{name}' of {name_of(source.output.node)} are not supported, the socket's own value "
             "counts")
        value = source.output.node.inputs[name].default_value
    return Vector(value[:3] if hasattr(value, '__len__') else [value] * 3)


def _uv_map(source, texture, warn):
    if source.output is None:
        return ''
    node = source.output.node
    if node.type == 'UVMAP':
        return node.uv_map
    if node.type == 'ATTRIBUTE':
        return node.attribute_name
    if not (node.type == 'TEX_COORD' and source.output.name == 'UV'):
        warn(f"image '{name_of(texture.image)}' is placed by the UV map for renders, without {name_of(node)}")
    return ''
