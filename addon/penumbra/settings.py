# SPDX-License-Identifier: GPL-3.0-or-later
"""scene.penumbra -> pnb_settings, for stills and for viewports."""

from ctypes import c_float

from . import capi, command_line, passes, props


# Texels per side that quick pictures have at least.
_LEAST_MAP = 128


def backend():
    return command_line.options().get('backend') or props.backend()


def forced_technique():
    """The technique that the command line wants for all lights, or None."""
    return command_line.options().get('technique')


def for_still(depsgraph, width, height):
    """pnb_settings of the scene for an image of this full size."""
    scene = depsgraph.scene_eval
    settings = _common(scene, forced_technique(), width, height)
    settings.samples = scene.penumbra.samples
    settings.passes = passes.wanted(depsgraph.view_layer)
    settings.crop[:] = border(scene.render, width, height)
    return settings


def map_size(size, share):
    """Of the maps of a picture that has this share of its width."""
    return min(size, max(_LEAST_MAP, int(size * share)))


def for_viewport(scene, width, height, crop, samples, is_reference, image, share, is_quick):
    """`image`: the one pass wanted; `share`: of the size of shadow maps; `is_quick`: using what the last left."""
    settings = _common(scene, 'REFERENCE' if is_reference else None, width, height)
    settings.samples = samples
    settings.shadow_map_size = map_size(settings.shadow_map_size, share)
    settings.passes = image
    settings.flags |= capi.SETTINGS_PROGRESSIVE | (capi.SETTINGS_QUICK if is_quick else 0)
    settings.crop[:] = crop
    return settings


def viewport_key(scene):
    """Everything that a viewport's picture depends on besides scene and view, to be compared."""
    options = scene.penumbra
    return (options.technique, tuple(_values(options, None)), options.shadow_map_size,
            options.light_samples, options.viewport_samples, options.use_refine, scene.render.film_transparent,
            scene.render.filter_size, backend())


def _values(options, technique):
    """[(name, number)] of the parameters of the technique so named, else of the scene's and of its lights'."""
    values = props.parameter_values(options, props.technique(options, technique))
    for name in props.light_techniques() if technique is None else ():
        values += props.parameter_values(options, props.technique(options, name), of_lights=True)
    return values


def _common(scene, technique, width, height):
    options = scene.penumbra
    values = _values(options, technique)
    settings = capi.Settings(
        technique=props.technique(options, technique)[0].id, width=width, height=height,
        filter_width=scene.render.filter_size, shadow_map_size=options.shadow_map_size,
        light_samples=options.light_samples,
        flags=capi.SETTINGS_FILM_TRANSPARENT if scene.render.film_transparent else 0)
    settings.values = (capi.Value * len(values))(*[capi.Value(name.encode(), value) for name, value in values])
    settings.value_count = len(values)
    return settings


def border(render, width, height):
    """x, y, width, height of the border in pixels: Blender multiplies in single precision and cuts."""
    if not render.use_border:
        return [0, 0, width, height]
    left, right = (_pixels(bound, width) for bound in (render.border_min_x, render.border_max_x))
    bottom, top = (_pixels(bound, height) for bound in (render.border_min_y, render.border_max_y))
    return [left, bottom, right - left, top - bottom]


def _pixels(fraction, size):
    return int(c_float(fraction * size).value)
