# SPDX-License-Identifier: GPL-3.0-or-later
"""Light object -> pnb_light, with the radiometry of Cycles of the running Blender version."""

from math import pi, sqrt, tan

from . import capi, compat, emission, props
from .names import name_of

SMALLEST_MAP = 16   # texels per side that the library allows
_TYPES = {'AREA': capi.AREA, 'POINT': capi.POINT, 'SPOT': capi.SPOT, 'SUN': capi.SUN}


def gives_light(light, name, matrix, warnings):
    """False for what Cycles takes for dark."""
    if compat.light_is_portal(light):
        return False
    fault = "no area" if light.type == 'AREA' and not light.size * _height(light) else \
        "" if all(matrix.col[axis].length for axis in compat.AXES_THAT_LIGHT[light.type]) else "a scale of 0"
    if fault:
        warnings.append(f"light '{name}' has {fault} and gives no light")
    return not fault


def fill_light(target, ob, matrix, warnings):
    """Writes the light of an evaluated object into `target`, a capi.Light."""
    light, name = ob.data, name_of(ob)
    target.name = name.encode()
    target.type = _TYPES[light.type]
    target.flags = 0 if compat.light_casts_shadow(light) else capi.LIGHT_NO_SHADOW
    scaled = light.type != 'SPOT' or compat.SPOT_IS_SCALED
    target.matrix[:] = column_major(matrix if scaled else matrix.normalized())
    color = _color(light, name, warnings)
    strength = _STRENGTH[light.type](target, light, matrix, name, warnings)
    target.emission[:] = [channel * light.energy * strength for channel in color]
    _fill_overrides(target, light.penumbra)


def _fill_overrides(target, options):
    if options.technique != props.AS_SCENE:
        target.technique = options.technique.encode()
    if options.shadow_map_size:
        target.shadow_map_size = max(options.shadow_map_size, SMALLEST_MAP)
    target.shadow_color[:] = options.shadow_color


def column_major(matrix):
    return [value for column in matrix.col for value in column]


def _color(light, name, warnings):
    color = compat.light_color(light)
    if not compat.uses_nodes(light):
        return color
    tint = emission.of_tree(light.node_tree, f"light '{name}'", warnings)
    return [a * b for a, b in zip(color, tint)]


def _point(target, light, matrix, name, warnings):
    target.radius = light.shadow_soft_size
    area = 1.0 if compat.light_is_normalized(light) else 4.0 * pi * light.shadow_soft_size ** 2
    return area / (4.0 * pi)


def _spot(target, light, matrix, name, warnings):
    target.spot_angle = light.spot_size
    target.spot_blend = light.spot_blend
    if compat.SPOT_IS_FLAT_DISK:
        target.flags |= capi.LIGHT_COSINE_SPOT
    return _point(target, light, matrix, name, warnings)


def _sun(target, light, matrix, name, warnings):
    target.angle = light.angle
    if not compat.light_is_normalized(light):
        return pi * (light.angle / 2.0) ** 2
    squared = tan(min(light.angle, 3.0) / 2.0) ** 2
    if not compat.SUN_IS_FLAT_DISK or squared < 1e-6:
        return 1.0
    return 2.0 * (sqrt(1.0 + squared) - 1.0) / squared  # mean cosine over the disk


def _height(light):
    return light.size_y if light.shape in {'RECTANGLE', 'ELLIPSE'} else light.size


def _area(target, light, matrix, name, warnings):
    target.shape = capi.ELLIPSE if light.shape in {'DISK', 'ELLIPSE'} else capi.RECTANGLE
    target.size[:] = light.size, _height(light)
    target.spread = light.spread
    area = light.size * _height(light) * matrix.col[0].length * matrix.col[1].length
    if target.shape == capi.ELLIPSE:
        area *= pi / 4.0
    return compat.AREA_RADIANCE_PER_POWER * (1.0 / area if compat.light_is_normalized(light) else 1.0)


_STRENGTH = {'AREA': _area, 'POINT': _point, 'SPOT': _spot, 'SUN': _sun}
