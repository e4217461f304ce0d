# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair, Curves objects and point clouds -> pnb_mesh: what has no faces, as thin prisms and little polyhedra."""

from array import array
from ctypes import c_void_p

from . import capi, compat
from .names import name_of

# Particle systems that make hair, and how.
_PATH = 'PATH'


def create_curves(data, name, warnings):
    """Handle of a Curves data-block, or None if it is empty."""
    positions = compat.point_values(data, 'position', 'vector', 3)
    strands = array('I', bytes(4 * len(data.curves)))
    if not positions or not strands:
        return None
    data.curves.foreach_get('first_point_index', strands)
    return _create_strands(name, positions, compat.point_values(data, 'radius', 'value', 1), strands, warnings)


def create_points(data, name, warnings):
    """Handle of a point cloud, or None if it is empty."""
    positions = compat.point_values(data, 'position', 'vector', 3)
    if not positions:
        return None
    radii = compat.point_values(data, 'radius', 'value', 1)
    desc = capi.PointsDesc(name=name.encode(), point_count=len(positions) // 3)
    _set(desc.positions, positions, 3)
    _set(desc.radii, radii, 1)
    return _finish(capi.library().create_mesh_of('points', desc), warnings)


def hair_systems(ob):
    """The particle systems of an evaluated object that are drawn as hair."""
    for modifier in ob.modifiers:
        if modifier.type == 'PARTICLE_SYSTEM' and modifier.particle_system:
            settings = modifier.particle_system.settings
            if settings.type == 'HAIR' and settings.render_type == _PATH:
                yield modifier.particle_system


def create_hair(ob, system, is_render, warnings):
    """Handle of the hair of a particle system, in the object's space; None without any."""
    settings = system.settings
    steps = (1 << (settings.render_step if is_render else settings.display_step)) + 1
    positions, radii, strands = array('f'), array('f'), array('I')
    to_object = ob.matrix_world.inverted_safe()
    widths = [_radius(settings, step / (steps - 1)) for step in range(steps)]
    parents = len(system.particles)
    children = len(system.child_particles)
    # Parents are not drawn beside their children.
    for number in range(parents if children else 0, parents + children):
        strands.append(len(positions) // 3)
        for step in range(steps):
            positions.extend(to_object @ system.co_hair(object=ob, particle_no=number, step=step))
        radii.extend(widths)
    if not strands:
        return None
    return _create_strands(name_of(system), positions, radii, strands, warnings)


def hair_slot(system):
    """Index of the material slot."""
    return max(system.settings.material - 1, 0)


def _radius(settings, x):
    """Half the width at a share of the length: Blender's shape of a strand."""
    if settings.use_close_tip and x >= 1.0:
        return 0.0
    shape = settings.shape
    left = (1.0 - x) ** (1.0 + shape if shape < 0.0 else 1.0 / max(1.0 - shape, 1e-6))
    width = left * (settings.root_radius - settings.tip_radius) + settings.tip_radius
    return 0.5 * settings.radius_scale * width


def _create_strands(name, positions, radii, strands, warnings):
    desc = capi.StrandsDesc(name=name.encode(), point_count=len(positions) // 3, strand_count=len(strands))
    _set(desc.positions, positions, 3)
    _set(desc.radii, radii, 1)
    _set(desc.first_points, strands, 1)
    return _finish(capi.library().create_mesh_of('strands', desc), warnings)


def _set(target, values, width):
    if values:
        target.data = c_void_p(values.buffer_info()[0])
        target.stride = 4 * width


def _finish(handle, warnings):
    warning = capi.library().mesh_warning(handle).decode(errors='replace')
    if warning:
        warnings.append(warning)
    return handle
