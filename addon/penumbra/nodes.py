# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading shader node trees: through reroutes, groups and muted nodes to what feeds a socket."""

from typing import NamedTuple


class Source(NamedTuple):
    """What feeds an input: `output` of another node, or nothing (None) and the value of `socket` counts."""
    output: object
    socket: object
    groups: tuple       # group nodes around `output` or `socket`, outermost first

    def input(self, key):
        """What feeds an input of the node found, by name or index."""
        return follow(self.output.node.inputs[key], self.groups)

    def key(self):
        """Equal for what is fed by the same output."""
        return self.output, self.groups


def read_once(known, source, read):
    """`read(source)`, called the first time that its output is asked for; `known`: a dictionary for the results."""
    key = source.key()
    if key not in known:
        known[key] = read(source)
    return known[key]


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


def output(tree, name='Surface'):
    """What feeds an input of the output node of a material, world or light."""
    node = tree.get_output_node('CYCLES')
    return follow(node.inputs[name]) if node else Source(None, None, ())
