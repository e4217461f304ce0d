# SPDX-License-Identifier: GPL-3.0-or-later
"""Material -> pnb_material."""

from . import capi, compat, images, uvs
from .mesh import Needs
from .names import name_of
from .surfaces import read_surface


def fill_material(target, material, texture, warnings):
    """`texture(picture)` returns a handle or None. Returns what the material needs of a mesh."""
    surface = read_surface(material, warnings)
    target.base_color[:] = surface.color
    target.transparency = 1.0 - surface.alpha
    target.absorption[:] = [1.0 - min(max(channel, 0.0), 1.0) for channel in surface.clear]
    target.shadow_threshold = compat.shadow_threshold(material)
    target.emission[:] = surface.emission
    if surface.color_image:
        target.base_color_texture = texture(surface.color_image)
        if not target.base_color_texture:
            target.base_color[:] = _missing(surface.color)
    if surface.alpha_image:
        target.alpha_texture = texture(surface.alpha_image)
    if surface.emission_image:
        target.emission_texture = texture(surface.emission_image)
        if not target.emission_texture:
            target.emission[:] = _missing(surface.emission)
    placed = _placement(surface, name_of(material), warnings)
    if placed and placed.matrix != uvs.IDENTITY:
        target.uv_matrix[:] = placed.matrix
    target.flags = _flags(material, surface) | _shadow_flags(surface, name_of(material), warnings)
    return Needs(placed.uv_map if placed else '', surface.color_attribute)


def _missing(color):
    return [a * b for a, b in zip(color, images.MISSING)]


def _flags(material, surface):
    camera, shadow = compat.culls_backfaces(material)
    flags = {capi.MATERIAL_CULL_CAMERA: camera, capi.MATERIAL_CULL_SHADOW: shadow,
             capi.MATERIAL_HOLDOUT: surface.is_holdout, capi.MATERIAL_TINTED: surface.is_tinted,
             capi.MATERIAL_NO_SHADOW: compat.casts_no_shadow(material),
             capi.MATERIAL_OPAQUE_SHADOW: compat.casts_opaque_shadow(material),
             capi.MATERIAL_VERTEX_COLOR: surface.color_attribute is not None}
    return sum(flag for flag, is_set in flags.items() if is_set)


def _shadow_flags(surface, name, warnings):
    """Of a surface that is another one to shadow rays: those either pass or stop."""
    shadow = surface.shadow
    if shadow is None or (shadow.alpha, shadow.alpha_image) == (surface.alpha, surface.alpha_image):
        return 0
    if not shadow.alpha_image and shadow.alpha >= 1.0:
        return capi.MATERIAL_OPAQUE_SHADOW
    if shadow.alpha > 0.0 or shadow.is_tinted or min(shadow.clear) < 1.0:
        warnings.append(f"material '{name}': its shadow is that of what the camera sees")
        return 0
    return capi.MATERIAL_NO_SHADOW


def _placement(surface, name, warnings):
    """The picture whose texture coordinates count, or None."""
    pictures = surface.images()
    if any((picture.uv_map, picture.matrix) != (pictures[0].uv_map, pictures[0].matrix) for picture in pictures):
        warnings.append(f"material '{name}': its images are placed differently, all are placed as "
                        f"'{name_of(pictures[0].image)}'")
    return pictures[0] if pictures else None
