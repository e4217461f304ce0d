# SPDX-License-Identifier: GPL-3.0-or-later
"""Shader nodes of a material -> Surface: base colour, emission and alpha, and what shines through."""

from dataclasses import dataclass, field, replace

from . import compat, nodes, values
from .feeds import CAMERA_RAY, SHADOW_RAY, FeedReader
from .names import name_of

GREY = [0.8, 0.8, 0.8]
BLACK = [0.0, 0.0, 0.0]


@dataclass
class Surface:
    color: list = field(default_factory=lambda: list(GREY))
    color_image: object = None      # a feeds.Picture, as the other two
    emission: list = field(default_factory=lambda: list(BLACK))
    emission_image: object = None
    alpha: float = 1.0
    alpha_image: object = None
    clear: list = field(default_factory=lambda: [1.0] * 3)  # colour of what shines through
    is_tinted: bool = False                                 # and by color_image, too
    is_holdout: bool = False
    color_attribute: str = None     # '': the one for renders, None: none
    shadow: object = None           # the Surface that shadow rays meet, where a Light Path node makes another one

    def images(self):
        return [image for image in (self.color_image, self.emission_image, self.alpha_image) if image]

    def is_textured(self):
        return bool(self.images()) or self.color_attribute is not None


def read_surface(material, warnings):
    if not compat.uses_nodes(material):
        return Surface(color=list(material.diffuse_color[:3]))
    reader = _SurfaceReader(name_of(material), warnings, CAMERA_RAY)
    surface = reader.surface(material.node_tree)
    if reader.feeds.asks_for_ray:
        surface.shadow = _SurfaceReader(reader.name, [], SHADOW_RAY).surface(material.node_tree)
    return surface


class _SurfaceReader:
    def __init__(self, name, warnings, ray):
        self.name = name
        self.warnings = warnings
        self.feeds = FeedReader(self.warn, ray)
        self.omitted = {}       # what is not drawn, in the order found
        self._known = {}        # Source.key(): Surface

    def warn(self, text):
        self.warnings.append(f"material '{self.name}': {text}")

    def surface(self, tree):
        source = nodes.output(tree)
        has_volume = nodes.output(tree, 'Volume').output is not None
        if has_volume:
            self.omitted["its volume"] = True
        if nodes.output(tree, 'Displacement').output is not None:
            self.omitted["its displacement"] = True
        surface = Surface(alpha=0.0) if has_volume and source.output is None else self.shader(source)
        self.feeds.finish()
        if self.omitted:
            self.warn(f"it is drawn without {', '.join(self.omitted)}")
        return surface

    def shader(self, source):
        """A Surface of the caller's own; what is linked to several shaders is read once."""
        if source.output is None:
            return Surface(color=list(BLACK))
        return replace(nodes.read_once(self._known, source, self._read))

    def _read(self, source):
        node = source.output.node
        if source.output.type != 'SHADER':
            return self.color_as_shader(source)
        if node.type == 'BSDF_TRANSPARENT':
            return self.transparent(source)
        if node.type == 'HOLDOUT':
            return Surface(is_holdout=True)
        if node.type == 'MIX_SHADER':
            return self.mix(source)
        if node.type == 'ADD_SHADER':
            return self.add(source)
        if node.type == 'EMISSION':
            surface = Surface(color=list(BLACK))
            self.emission(source, 'Color', 'Strength', surface)
            return surface
        return self.scattering(source)

    # ---- Shaders of their own ----

    def color_as_shader(self, source):
        """A colour in place of a shader is emitted."""
        surface = Surface(color=list(BLACK))
        self.emit(source, 1.0, surface)
        return surface

    def transparent(self, source):
        feed = self.feeds.color(source.input('Color'), [1.0] * 3)
        if feed.attribute is not None:
            self.warn("a colour attribute does not tint what shines through")
        return Surface(alpha=0.0, clear=feed.value, color_image=feed.picture, is_tinted=bool(feed.picture))

    def scattering(self, source):
        """A surface that reflects light, by what it has in common with a diffuse one."""
        node = source.output.node
        surface = Surface()
        color = next((name for name in ('Base Color', 'Color') if name in node.inputs), None)
        if color is None:
            self.warn(f"a {name_of(node)} node is not supported, it is drawn grey")
            return surface
        if node.type not in {'BSDF_PRINCIPLED', 'BSDF_DIFFUSE'}:
            self.warn(f"a {name_of(node)} node is drawn as a diffuse surface of its colour")
        self.omit(source)
        feed = self.feeds.color(source.input(color), GREY)
        surface.color, surface.color_image, surface.color_attribute = feed
        if node.type == 'BSDF_PRINCIPLED':
            self.emission(source, compat.PRINCIPLED_EMISSION, 'Emission Strength', surface)
        if 'Alpha' in node.inputs:
            feed = self.feeds.number(source.input('Alpha'), 1.0)
            surface.alpha, surface.alpha_image = min(max(feed.value[0], 0.0), 1.0), feed.picture
        if compat.PRINCIPLED_TRANSMISSION in node.inputs:
            self.transmission(source, surface)
        return surface

    def omit(self, source):
        """Notes what of a node's settings would change the picture, and does not."""
        node = source.output.node
        if 'Normal' in node.inputs and _bends(source.input('Normal')):
            self.omitted["its normal map or bump"] = True
        for label, name in compat.OMITTED_INPUTS.get(node.type, ()):
            if name in node.inputs:
                value = values.constant(source.input(name), 0.0)
                if value is None or values.number(value) > 0.0:
                    self.omitted[label] = True

    def transmission(self, source, surface):
        """Light that a Principled surface refracts goes straight on, in the surface's colour."""
        share = min(max(self.feeds.plain(source.input(compat.PRINCIPLED_TRANSMISSION), 0.0), 0.0), 1.0)
        if share <= 0.0:
            return
        alpha = surface.alpha
        surface.alpha = alpha * (1.0 - share)
        surface.is_tinted = bool(surface.color_image)
        surface.clear = [(1.0 - alpha + alpha * share * max(channel, 0.0) ** compat.TRANSMISSION_EXPONENT)
                         / (1.0 - surface.alpha) for channel in surface.color]
        self.warn("light passes straight through its transmission, without refraction")

    def emission(self, source, color, strength, surface):
        factor = self.feeds.plain(source.input(strength), 1.0)
        if factor:
            self.emit(source.input(color), factor, surface)

    def emit(self, source, factor, surface):
        feed = self.feeds.color(source, [1.0] * 3)
        if feed.attribute is not None:
            self.warn(f"attribute '{feed.attribute}' does not change what it emits")
        emission = [channel * factor for channel in feed.value]
        surface.emission, surface.emission_image = [max(channel, 0.0) for channel in emission], feed.picture
        if min(emission) < 0.0:
            self.warn("its negative emission is left out")
        if any(surface.emission):
            self.warn("its emission is seen, but lights nothing")

    # ---- Several shaders ----

    def add(self, source):
        """The sum of two shaders, of which transparency cannot be a part."""
        first, second = self.shaders(source, 0, 1)
        if first.alpha < 1.0 or second.alpha < 1.0 or first.is_textured() or second.is_textured():
            self.warn("Add Shader is supported for opaque shaders without textures, of others the second is drawn")
            return second if second.alpha > 0.0 else first
        return Surface(color=[a + b for a, b in zip(first.color, second.color)],
                       emission=[a + b for a, b in zip(first.emission, second.emission)])

    def mix(self, source):
        """Two shaders by factor: by constants, or transparency by an image."""
        first, second = self.shaders(source, 1, 2)
        factor = self.feeds.number(source.input(0), 0.5)
        if factor.picture and first.alpha == 0.0 and not second.alpha_image:
            second.alpha, second.alpha_image = second.alpha * min(max(factor.value[0], 0.0), 1.0), factor.picture
            second.clear = first.clear
            if first.is_tinted:
                self.warn("an image that tints what shines through counts only without an image of alpha")
            return second
        weight = factor.value[0]
        if factor.picture:
            self.warn("shaders are mixed by images only from Transparent; half of each is taken")
            weight = 0.5
        return self.blend(first, second, min(max(weight, 0.0), 1.0))

    def shaders(self, source, *numbers):
        return [self.shader(source.input(number)) for number in numbers]

    def blend(self, first, second, weight):
        """Colours count by their share of the opaque part."""
        alpha = first.alpha * (1.0 - weight) + second.alpha * weight
        share = second.alpha * weight / alpha if alpha > 0.0 else 0.5
        heavier = second if share > 0.5 else first
        if 0.0 < share < 1.0:
            if first.is_textured() or second.is_textured():
                self.warn("of two mixed shaders with textures only the heavier one is drawn")
            else:
                heavier.color = [a + (b - a) * share for a, b in zip(first.color, second.color)]
                heavier.emission = [a + (b - a) * share for a, b in zip(first.emission, second.emission)]
        passing = [(1.0 - weight) * (1.0 - first.alpha) * a + weight * (1.0 - second.alpha) * b
                   for a, b in zip(first.clear, second.clear)]
        heavier.clear = [channel / (1.0 - alpha) for channel in passing] if alpha < 1.0 else [1.0] * 3
        heavier.alpha = alpha
        return heavier


def _bends(source):
    """Whether what feeds a Normal input is another normal than the surface's own."""
    if source.output is None or source.output.node.type == 'NEW_GEOMETRY':
        return False
    node = source.output.node
    if node.type == 'NORMAL_MAP':
        return source.input('Color').output is not None
    if node.type == 'BUMP':
        return source.input('Height').output is not None or _bends(source.input('Normal'))
    return True
