# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated mesh -> pnb_mesh: by address and stride where memory matches RNA, else by foreach_get."""

from array import array
from ctypes import c_float, c_int32, c_uint32, c_void_p
from typing import NamedTuple

from . import attributes, capi, compat

_CTYPES = {'f': c_float, 'I': c_uint32, 'i': c_int32}

# (member, stride): whether memory was found to hold what RNA says.
_verified = {}


class Needs(NamedTuple):
    """What a material reads of the mesh it lies on."""
    uv_map: str = ''        # '': the one for renders
    color: str = None       # colour attribute; '': the one for renders, None: none


NO_NEEDS = Needs()


def create_mesh(mesh, name, needs, use_pointers, warnings):
    """Handle of the library's copy, or None for a mesh without triangles. `needs`: of the material of each slot."""
    if not len(mesh.vertices) or not len(mesh.polygons):
        return None
    def warn(text):
        warnings.append(f"object '{name}': {text}")

    compat.prepare_mesh(mesh)
    try:
        desc = capi.MeshDesc(name=name.encode(), vertex_count=len(mesh.vertices), corner_count=len(mesh.loops),
                             triangle_count=len(mesh.loop_triangles), polygon_count=len(mesh.polygons))
        maps = dict.fromkeys(need.uv_map for need in needs)
        for lost in [uv_map for uv_map in maps if uv_map and uv_map not in mesh.uv_layers]:
            warn(f"it has no UV map '{lost}' and shows one texel of the image there")
        copies = [_fill(getattr(desc, source.member), source, use_pointers)
                  for source in compat.mesh_arrays(mesh, next(iter(maps), ''))]
        if len(maps) > 1:
            copies.append(_fill_mixed_uvs(desc.corner_uvs, mesh, [need.uv_map for need in needs]))
        copies.append(_fill_colors(desc, mesh, needs, warn))
        handle = capi.library().create('mesh', desc)
        del copies
    finally:
        compat.release_mesh(mesh)
    warning = capi.library().mesh_warning(handle).decode(errors='replace')
    if warning:
        warnings.append(warning)
    return handle


def _fill_mixed_uvs(target, mesh, maps):
    """Texture coordinates of each face from the map that its material names."""
    layers = {name: copy_of(source) for name in maps for source in compat.mesh_arrays(mesh, name)
              if source.member == 'corner_uvs'}
    mixed = array('f', bytes(8 * len(mesh.loops)))
    for polygon in mesh.polygons:
        name = maps[min(polygon.material_index, len(maps) - 1)]
        start, end = 2 * polygon.loop_start, 2 * (polygon.loop_start + polygon.loop_total)
        if name in layers:
            mixed[start:end] = layers[name][start:end]
    target.data, target.stride = c_void_p(mixed.buffer_info()[0]), 8
    return mixed


def _fill_colors(desc, mesh, needs, warn):
    """Colours of the attribute that its materials name; returns the copy, as _fill does."""
    names = dict.fromkeys(need.color for need in needs if need.color is not None)
    if not names:
        return None
    if len(names) > 1:
        warn("of its materials' colour attributes only the first is drawn")
    colors = attributes.read_colors(mesh, next(iter(names)), warn)
    target = getattr(desc, colors.member)
    # RGBA: the library reads the first three of each four.
    target.data, target.stride = c_void_p(colors.values.buffer_info()[0]), 16
    return colors.values


def _fill(target, source, use_pointers):
    """Sets data and stride; returns the copy that must outlive the use of them, if there is one."""
    place = memory_of(source) if use_pointers else None
    if place:
        target.data, target.stride = place
        return None
    copy = copy_of(source)
    target.data = c_void_p(copy.buffer_info()[0])
    target.stride = 4 * source.width
    return copy


def copy_of(source):
    count = len(source.rna) * source.width
    copy = array(source.typecode, bytes(4 * count))
    source.rna.foreach_get(source.attribute, copy)
    return copy


def memory_of(source):
    """(address, stride) of an array whose memory is what RNA says, or None."""
    if source.memory is None or len(source.memory) < 2 or len(source.memory) != len(source.rna):
        return None
    first = source.memory[0].as_pointer()
    stride = source.memory[1].as_pointer() - first
    key = (source.member, stride)
    if key not in _verified:
        _verified[key] = _matches(source, first, stride)
    return (first + source.offset, stride) if _verified[key] else None


def _matches(source, first, stride):
    """Compares some elements: their addresses before anything is read from there."""
    if stride < source.offset + 4 * source.width:
        return False
    element = _CTYPES[source.typecode] * source.width
    last = len(source.memory) - 1
    for index in {0, 1, last // 2, last}:
        address = first + index * stride
        if source.memory[index].as_pointer() != address:
            return False
        value = getattr(source.rna[index], source.attribute)
        expected = [value] if source.width == 1 else list(value)
        if list(element.from_address(address + source.offset)) != expected:
            return False
    return True
