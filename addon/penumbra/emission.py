# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear RGB colour times strength of what a world or a light emits."""

from . import compat, environment, images, nodes, sky, values
from .names import name_of


def of_world(world, warnings):
    if not compat.uses_nodes(world):
        return list(world.color)
    owner = f"world '{name_of(world)}'"
    if nodes.output(world.node_tree, 'Volume').output is not None:
        warnings.append(f"{owner}: it is drawn without its volume")
    return of_tree(world.node_tree, owner, warnings, 'Is Diffuse Ray')


def of_tree(tree, owner, warnings, ray=None):
    """Of node trees; one that varies over the sphere counts by its mean. `ray`: the output of Light Path nodes that is
    1; to lights Cycles says none."""
    color = _EmissionReader(owner, warnings, ray).radiance(nodes.output(tree))
    if min(color) < 0.0:
        warnings.append(f"{owner}: its negative emission is left out")
    return [max(channel, 0.0) for channel in color]


class _EmissionReader:
    def __init__(self, owner, warnings, ray):
        self.owner = owner
        self.warnings = warnings
        self._ray = ray
        self._known = {}        # Source.key(): RGB

    def warn(self, text):
        self.warnings.append(f"{self.owner}: {text}")

    def radiance(self, source):
        if source.output is None:
            return [0.0] * 3
        return nodes.read_once(self._known, source, self._read)

    def _read(self, source):
        node = source.output.node
        if source.output.type != 'SHADER':
            return self.color(source, 1.0)
        if node.type in {'BACKGROUND', 'EMISSION'}:
            strength = values.number(self.value(source.input('Strength'), 1.0))
            return [channel * strength for channel in self.color(source.input('Color'), 1.0)]
        if node.type == 'ADD_SHADER':
            first, second = (self.radiance(source.input(number)) for number in (0, 1))
            return [a + b for a, b in zip(first, second)]
        if node.type == 'MIX_SHADER':
            share = min(max(values.number(self.value(source.input(0), 0.5)), 0.0), 1.0)
            first, second = (self.radiance(source.input(number)) for number in (1, 2))
            return [a + (b - a) * share for a, b in zip(first, second)]
        self.warn(f"a {name_of(node)} node emits nothing")
        return [0.0] * 3

    def color(self, source, default):
        return values.color(self.value(source, default))

    def value(self, source, default):
        return values.constant(source, default, self._leaf)

    def _leaf(self, source):
        node = source.output.node
        found = None
        if node.type in {'TEX_ENVIRONMENT', 'TEX_IMAGE'}:
            found = self._image(node)
        elif node.type == 'TEX_SKY':
            found = sky.mean(node)
            self.warn("its sky counts by the mean colour of a clear one, without the disc of the sun")
        elif node.type == 'LIGHT_PATH' and source.output.name.startswith('Is '):
            found = float(source.output.name == self._ray)
            if self._ray:
                self.warn(f"node {name_of(node)}: it counts as for diffuse surfaces, for the camera too")
        elif node.type == 'LIGHT_FALLOFF':
            found = self.value(source.input('Strength'), 100.0)
            if source.output.name != 'Quadratic' or values.constant(source.input('Smooth'), 0.0) != 0.0:
                self.warn(f"node {name_of(node)}: light falls off with the square of the distance, unsmoothed")
        if found is None:
            self.warn(f"node {name_of(node)} is not supported in '{source.socket.name}', the socket's own value counts")
            found = values.own(source, 1.0)
        return found

    def _image(self, node):
        if not node.image:
            self.warn(f"node {name_of(node)} has no image")
            return [*images.MISSING, 1.0]
        file = images.sequence_file(node.image, node.image_user)
        return [*environment.mean(node.image, file, self.warnings), 1.0]
