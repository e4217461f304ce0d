# SPDX-License-Identifier: GPL-3.0-or-later
"""Material -> pnb_material: base colour, emission and alpha, each a value and an image, and what shines through."""

from dataclasses import dataclass, field

from . import capi, compat, images, nodes, textures, uvs
from .mesh import Needs
from .names import name_of

GREY = [0.8, 0.8, 0.8]


@dataclass
class Picture:
    """An image as a node uses it."""
    image: object
    file: str           # see images.read
    use: str            # textures.COLOR or ALPHA
    flags: int          # capi.TEXTURE_*
    uv_map: str
    matrix: tuple       # of the texture coordinates


@dataclass
class Surface:
    color: list = field(default_factory=lambda: list(GREY))
    color_image: object = None
    emission: list = field(default_factory=lambda: [0.0] * 3)
    emission_image: object = None
    alpha: float = 1.0
    alpha_image: object = None
    clear: list = field(default_factory=lambda: [1.0] * 3)  # colour of what shines through
    is_tinted: bool = False                                 # and by color_image, too
    is_holdout: bool = False
    color_attribute: str = None     # '': the one for renders, None: none

    def images(self):
        return [image for image in (self.color_image, self.emission_image, self.alpha_image) if image]


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
            target.base_color[:] = [a * b for a, b in zip(surface.color, images.MISSING)]
    if surface.alpha_image:
        target.alpha_texture = texture(surface.alpha_image)
    if surface.emission_image:
        target.emission_texture = texture(surface.emission_image)
        if not target.emission_texture:
            target.emission[:] = [a * b for a, b in zip(surface.emission, images.MISSING)]
    placed = _placement(surface, name_of(material), warnings)
    if placed and placed.matrix != uvs.IDENTITY:
        target.uv_matrix[:] = placed.matrix
    camera, shadow = compat.culls_backfaces(material)
    flags = {capi.MATERIAL_CULL_CAMERA: camera, capi.MATERIAL_CULL_SHADOW: shadow,
             capi.MATERIAL_HOLDOUT: surface.is_holdout, capi.MATERIAL_TINTED: surface.is_tinted,
             capi.MATERIAL_NO_SHADOW: compat.casts_no_shadow(material),
             capi.MATERIAL_OPAQUE_SHADOW: compat.casts_opaque_shadow(material),
             capi.MATERIAL_VERTEX_COLOR: surface.color_attribute is not None}
    target.flags = sum(flag for flag, is_set in flags.items() if is_set)
    return Needs(placed.uv_map if placed else '', surface.color_attribute)


def _placement(surface, name, warnings):
    """The picture whose texture coordinates count, or None."""
    pictures = surface.images()
    if any((picture.uv_map, picture.matrix) != (pictures[0].uv_map, pictures[0].matrix) for picture in pictures):
        warnings.append(f"material '{name}': its images are placed differently, all are placed as "
                        f"'{name_of(pictures[0].image)}'")
    return pictures[0] if pictures else None


def read_surface(material, warnings):
    if not compat.uses_nodes(material):
        return Surface(color=list(material.diffuse_color[:3]))
    return _Reader(name_of(material), warnings).shader(nodes.surface(material.node_tree))


class _Reader:
    def __init__(self, name, warnings):
        self.name = name
        self.warnings = warnings

    def warn(self, text):
        self.warnings.append(f"material '{self.name}': {text}")

    def shader(self, source):
        if source.output is None:
            return Surface(color=[0.0] * 3)
        node = source.output.node
        if node.type == 'BSDF_TRANSPARENT':
            return self.transparent(source)
        if node.type == 'HOLDOUT':
            return Surface(is_holdout=True)
        if node.type == 'MIX_SHADER':
            return self.mix(source)
        if node.type == 'ADD_SHADER':
            return self.add(source)
        if node.type == 'EMISSION':
            surface = Surface(color=[0.0] * 3)
            self.emission(source, 'Color', 'Strength', surface)
            return surface
        return self.scattering(source)

    def transparent(self, source):
        surface = Surface(alpha=0.0)
        surface.clear, surface.color_image = self.color(source.input('Color'), [1.0] * 3)
        surface.is_tinted = bool(surface.color_image)
        return surface

    def scattering(self, source):
        """A surface that reflects light, by what it has in common with a diffuse one."""
        node = source.output.node
        surface = Surface()
        color = next((name for name in ('Base Color', 'Color') if name in node.inputs), None)
        if color is None:
            self.warn(f"a {node.name} node is not supported, it is drawn grey")
            return surface
        if node.type not in {'BSDF_PRINCIPLED', 'BSDF_DIFFUSE'}:
            self.warn(f"a {node.name} node is drawn as a diffuse surface of its colour")
        surface.color_attribute = self.color_attribute(source.input(color))
        if surface.color_attribute is not None:
            surface.color = [1.0] * 3
        else:
            surface.color, surface.color_image = self.color(source.input(color), GREY)
        if node.type == 'BSDF_PRINCIPLED':
            self.emission(source, compat.PRINCIPLED_EMISSION, 'Emission Strength', surface)
        if 'Alpha' in node.inputs:
            self.alpha(source.input('Alpha'), surface)
        if compat.PRINCIPLED_TRANSMISSION in node.inputs:
            self.transmission(source, surface)
        return surface

    def transmission(self, source, surface):
        """Light that a Principled surface refracts goes straight on, in the surface's colour."""
        share = nodes.constant(source.input(compat.PRINCIPLED_TRANSMISSION), 0.0)
        if not isinstance(share, float) or share <= 0.0:
            return
        share, alpha = min(share, 1.0), surface.alpha
        surface.alpha = alpha * (1.0 - share)
        surface.is_tinted = bool(surface.color_image)
        surface.clear = [(1.0 - alpha + alpha * share * max(channel, 0.0) ** compat.TRANSMISSION_EXPONENT)
                         / (1.0 - surface.alpha) for channel in surface.color]
        self.warn("light passes straight through its transmission, without refraction")

    def emission(self, source, color, strength, surface):
        factor = nodes.constant(source.input(strength), 1.0)
        if factor is None:
            factor = self.fallback(source.input(strength), 1.0)
            self.warn(f"nodes linked to '{strength}' are not supported, the socket's own value counts")
        elif isinstance(factor, list):
            factor = sum(factor[:3]) / 3.0
        if factor <= 0.0:
            return
        value, surface.emission_image = self.color(source.input(color), [1.0] * 3)
        surface.emission = [max(channel, 0.0) * factor for channel in value]
        if any(surface.emission):
            self.warn("its emission is seen, but lights nothing")

    def add(self, source):
        """The sum of two shaders, of which transparency cannot be a part."""
        first, second = self.shaders(source.output.node.inputs, source.groups)
        if first.alpha < 1.0 or second.alpha < 1.0 or first.images() or second.images():
            self.warn("Add Shader is supported for opaque shaders without images, of others the second is drawn")
            return second if second.alpha > 0.0 else first
        return Surface(color=[a + b for a, b in zip(first.color, second.color)],
                       emission=[a + b for a, b in zip(first.emission, second.emission)])

    def mix(self, source):
        """Two shaders by factor: by constants, or transparency by an image."""
        first, second = self.shaders(source.output.node.inputs[1:], source.groups)
        factor = source.input('Fac' if 'Fac' in source.output.node.inputs else 'Factor')
        weight = nodes.constant(factor, 0.5)
        transparent = first.alpha == 0.0
        if weight is None and transparent and not second.alpha_image:
            second.alpha_image = self.image(factor)
            second.clear = first.clear
            if first.is_tinted:
                self.warn("an image that tints what shines through counts only without an image of alpha")
            return second
        if weight is None:
            self.warn("shaders are mixed by nodes only from Transparent and by an image; half of each is taken")
            weight = 0.5
        return self.blend(first, second, min(max(weight, 0.0), 1.0))

    def shaders(self, sockets, groups):
        return [self.shader(nodes.follow(socket, groups)) for socket in sockets]

    def blend(self, first, second, weight):
        """Colours count by their share of the opaque part."""
        alpha = first.alpha * (1.0 - weight) + second.alpha * weight
        share = second.alpha * weight / alpha if alpha > 0.0 else 0.5
        heavier = second if share > 0.5 else first
        if 0.0 < share < 1.0:
            if first.images() or second.images():
                self.warn("of two mixed shaders with images only the heavier one is drawn")
            else:
                heavier.color = [a + (b - a) * share for a, b in zip(first.color, second.color)]
                heavier.emission = [a + (b - a) * share for a, b in zip(first.emission, second.emission)]
        passing = [(1.0 - weight) * (1.0 - first.alpha) * a + weight * (1.0 - second.alpha) * b
                   for a, b in zip(first.clear, second.clear)]
        heavier.clear = [channel / (1.0 - alpha) for channel in passing] if alpha < 1.0 else [1.0] * 3
        heavier.alpha = alpha
        return heavier

    def color_attribute(self, source):
        """Name of the colour attribute that feeds the input, or None."""
        if source.output is None:
            return None
        node = source.output.node
        if node.type == 'VERTEX_COLOR':
            return node.layer_name
        if node.type == 'ATTRIBUTE' and node.attribute_type == 'GEOMETRY' and source.output.name == 'Color':
            return node.attribute_name
        return None

    def color(self, source, default):
        """(linear colour, image that multiplies it or None)."""
        value = nodes.constant(source, default)
        if value is None:
            image = self.image(source)
            return ([1.0] * 3, image) if image else (self.fallback(source, default), None)
        return (value[:3] if isinstance(value, list) else [value] * 3), None

    def alpha(self, source, surface):
        value = nodes.constant(source, 1.0)
        if value is None:
            surface.alpha_image = self.image(source)
            value = 1.0 if surface.alpha_image else self.fallback(source, 1.0)
        elif isinstance(value, list):
            value = sum(value[:3]) / 3.0
        surface.alpha = min(max(value, 0.0), 1.0)

    def image(self, source):
        """The Picture of an Image Texture that feeds the input directly, or None."""
        output = source.output
        if output.node.type != 'TEX_IMAGE' or not output.node.image:
            self.warn(f"node {output.node.name} is not supported in '{source.socket.name}', or has no image")
            return None
        uv_map, matrix = uvs.placement(source, self.warn)
        use = textures.ALPHA if output.name == 'Alpha' else textures.COLOR
        file = images.sequence_file(output.node.image, output.node.image_user)
        return Picture(output.node.image, file, use, textures.node_flags(output.node), uv_map, matrix)

    def fallback(self, source, default):
        """The value a socket has beside its unsupported link."""
        value = getattr(source.socket, 'default_value', default)
        return value if isinstance(value, (int, float)) else list(value)[:3]
