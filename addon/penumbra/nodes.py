# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading shader node trees: through reroutes, groups and muted nodes to what feeds a socket."""

from typing import NamedTuple

from . import environment, images


class Source(NamedTuple):
    """What feeds an input: `output` of another node, or nothing (None) and the value of `socket` counts."""
    output: object
    socket: object
    groups: tuple       # group nodes around `output` or `socket`, outermost first

    def input(self, name):
        """What feeds an input of the node found."""
        return follow(self.output.node.inputs[name], self.groups)


def follow(socket, groups=()):
    while socket is not None:
        link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
        if link is None:
            return Source(None, socket, groups)
        node, output = link.from_node, link.from_socket
        if node.mute:
            socket = next((inner.from_socket for inner in node.internal_links if inner.to_socket == output), None)
        elif node.type == 'REROUTE':
            socket = node.inputs[0]
        elif node.type == 'GROUP' and node.node_tree:
            socket = _same(output, _group_inputs(node.node_tree))
            groups += (node,)
        elif node.type == 'GROUP_INPUT' and groups:
            socket = _same(output, groups[-1].inputs)
            groups = groups[:-1]
        else:
            return Source(output, socket, groups)
    return Source(None, None, groups)


def _group_inputs(tree):
    node = next((node for node in tree.nodes if node.type == 'GROUP_OUTPUT' and node.is_active_output), None)
    return node.inputs if node else ()


def _same(output, sockets):
    return next((socket for socket in sockets if socket.identifier == output.identifier), None)


def surface(tree):
    """What feeds the surface of a material, world or light."""
    node = tree.get_output_node('CYCLES')
    return follow(node.inputs['Surface']) if node else Source(None, None, ())


def constant(source, default):
    """The value of an input as a number or a list, or None if it is not constant."""
    if source.output is None:
        value = source.socket.default_value if hasattr(source.socket, 'default_value') else default
    elif source.output.node.type in {'VALUE', 'RGB'}:
        value = source.output.default_value
    else:
        return None
    return value if isinstance(value, (int, float)) else list(value)


def _mean_color(source, warnings):
    """A constant colour, or the mean of an environment image; None if it is neither."""
    if source.output and source.output.node.type == 'TEX_ENVIRONMENT' and source.output.node.image:
        node = source.output.node
        return environment.mean(node.image, images.sequence_file(node.image, node.image_user), warnings)
    return constant(source, [1.0] * 3)


def emission(tree, owner, warnings):
    """Linear RGB colour times strength of a world or light that is a Background or Emission of one colour, or of an
    environment image, whose mean counts."""
    source = surface(tree)
    if source.output is None:
        return [0.0] * 3
    if source.output.node.type not in {'BACKGROUND', 'EMISSION'}:
        warnings.append(f"{owner}: a {source.output.node.name} node is not supported, it counts as white 1")
        return [1.0] * 3
    color = _mean_color(source.input('Color'), warnings)
    strength = constant(source.input('Strength'), 1.0)
    if color is None or strength is None:
        warnings.append(f"{owner}: nodes linked to Color or Strength are not supported, the socket's own value counts")
        inputs = source.output.node.inputs
        color = color or list(inputs['Color'].default_value)
        strength = inputs['Strength'].default_value if strength is None else strength
    return [channel * strength for channel in color[:3]]
