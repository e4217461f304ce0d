# SPDX-License-Identifier: GPL-3.0-or-later
"""What feeds the colours and numbers of a material: a value, and what it is multiplied with."""

from typing import NamedTuple

from . import images, nodes, textures, uvs, values
from .names import name_of


# Of nodes in one line.
_MOST_NAMES = 3
# Outputs of a Light Path node: kinds of rays that a material may look different to.
CAMERA_RAY, SHADOW_RAY = 'Is Camera Ray', 'Is Shadow Ray'


class Picture(NamedTuple):
    """An image as a node uses it."""
    image: object
    file: str           # see images.read
    use: str            # textures.STRAIGHT, PREMULTIPLIED or ALPHA
    flags: int          # capi.TEXTURE_*
    uv_map: str
    matrix: tuple       # of the texture coordinates


class Feed(NamedTuple):
    value: list             # linear RGB
    picture: Picture = None
    attribute: str = None   # name of a colour attribute of the mesh; '': the one for renders

    def is_textured(self):
        return self.picture is not None or self.attribute is not None


class FeedReader:
    """Of one material, as it is to one kind of rays."""

    def __init__(self, warn, ray):
        self.warn = warn
        self.asks_for_ray = False
        self._ray = ray
        self._known = {}        # Source.key(): Feed or None
        self._left_out = {}     # name of a texture: names of the nodes that it is drawn without

    def color(self, source, default):
        value = values.constant(source, default, self._constant_leaf)
        if value is None:
            feed = self._textured(source)
            if feed:
                return feed
            value = values.constant(source, default, self._unknown)
        return Feed(values.color(value))

    def number(self, source, default):
        """A Feed of grey. No attribute is read as a number."""
        feed = self.color(source, default)
        if feed.attribute is not None:
            self.warn(f"attribute '{feed.attribute}' is not supported in '{source.socket.name}'")
        return feed._replace(value=[values.number(feed.value)] * 3, attribute=None)

    def plain(self, source, default):
        """A number of what no texture can be used for."""
        return values.number(values.constant(source, default, self._unknown))

    def finish(self):
        """Warns of what was found on the way, a line for each texture."""
        for name, left_out in self._left_out.items():
            names = list(left_out)
            more = f" and {len(names) - _MOST_NAMES} more nodes" if len(names) > _MOST_NAMES else ""
            self.warn(f"'{name}' is drawn without {', '.join(names[:_MOST_NAMES])}{more}")

    # ---- Nodes without inputs that count ----

    def _constant_leaf(self, source):
        """What Cycles shows where a name is missing, alpha that an image ignores, and the kind of the rays."""
        node, name = source.output.node, source.output.name
        if node.type == 'LIGHT_PATH' and name.startswith('Is '):
            self.asks_for_ray = True
            return float(name == self._ray)
        if node.type == 'TEX_IMAGE' and node.image and name == 'Alpha' and node.image.alpha_mode == 'NONE':
            return 1.0
        if node.type == 'TEX_IMAGE' and not node.image:
            self.warn(f"node {name_of(node)} has no image")
            return 1.0 if name == 'Alpha' else [*images.MISSING, 1.0]
        if node.type == 'ATTRIBUTE' and not node.attribute_name:
            self.warn(f"node {name_of(node)} names no attribute, it is black")
            return [0.0] * 4
        return None

    def _unknown(self, source):
        value = self._constant_leaf(source)
        if value is None:
            self.warn(f"node {name_of(source.output.node)} is not supported in '{source.socket.name}', the socket's "
                      "own value counts")
            value = values.own(source, 0.0)
        return value

    # ---- Textures ----

    def _textured(self, source):
        """The Feed of an input with a texture somewhere behind it, or None."""
        return source.output and nodes.read_once(self._known, source, self._read)

    def _read(self, source):
        node = source.output.node
        if node.type == 'TEX_IMAGE' and node.image:
            return Feed([1.0] * 3, picture=self._picture(source))
        if node.type == 'VERTEX_COLOR' and source.output.name == 'Color':
            return Feed([1.0] * 3, attribute=node.layer_name)
        if node.type == 'ATTRIBUTE' and node.attribute_type == 'GEOMETRY' and source.output.name in {'Color', 'Vector'}:
            return Feed([1.0] * 3, attribute=node.attribute_name)
        return self._changed(source) if node.type in values.CHANGES else None

    def _changed(self, source):
        """A texture that goes through a node: exact where that multiplies it, else the texture as it is."""
        node = source.output.node
        for number in _kept_inputs(source, self._constant_leaf):
            feed = self._textured(source.input(number))
            if not feed:
                continue
            factor = _factor(source, number, self._constant_leaf)
            if factor:
                return feed._replace(value=[a * b for a, b in zip(feed.value, factor)])
            name = name_of(feed.picture.image) if feed.picture else feed.attribute
            self._left_out.setdefault(name, {})[name_of(node)] = True
            return feed
        return None

    def _picture(self, source):
        node = source.output.node
        if node.projection != 'FLAT':
            self.warn(f"image '{name_of(node.image)}' is placed by a UV map, without its projection {node.projection}")
        uv_map, matrix = uvs.placement(source, self.warn)
        use = textures.ALPHA if source.output.name == 'Alpha' else \
            textures.STRAIGHT if node.outputs['Alpha'].is_linked else textures.PREMULTIPLIED
        return Picture(node.image, images.sequence_file(node.image, node.image_user), use, textures.node_flags(node),
                       uv_map, matrix)


def _kept_inputs(source, leaf):
    """Numbers of the inputs whose texture is kept, the best first: of mixed colours the heavier, never the factor.
    `leaf`: see values.constant."""
    node = source.output.node
    mixed = values.mixed_inputs(node)
    if not mixed:
        return range(len(node.inputs))
    share = values.constant(source.input(mixed[0]), 0.5, leaf)
    if share is None:
        return mixed[1:]
    only = values.only_input(node, values.number(share))
    return (only,) if only else reversed(mixed[1:]) if values.number(share) > 0.5 else mixed[1:]


def _factor(source, number, leaf):
    """The colour that a node multiplies one of its inputs with; None if it does anything else."""
    node = source.output.node
    if node.type == 'MATH':
        if node.operation != 'MULTIPLY' or node.use_clamp or number > 1 or source.socket.type == 'RGBA':
            return None
        other = values.constant(source.input(1 - number), 0.5, leaf)
        return other if other is None else [values.number(other)] * 3
    mixed = values.mixed_inputs(node)
    share = mixed and values.constant(source.input(mixed[0]), 0.5, leaf)
    if share is None:
        return None
    share = min(max(values.number(share), 0.0), 1.0)
    if number == values.only_input(node, share):
        return [1.0] * 3
    other = values.constant(source.input(mixed[2] if number == mixed[1] else mixed[1]), 0.5, leaf)
    if other is None or not values.blends(node, 'MULTIPLY') or number == mixed[2] and share < 1.0:
        return None
    return [1.0 - share + share * channel for channel in values.color(other)]
