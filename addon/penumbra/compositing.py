# SPDX-License-Identifier: GPL-3.0-or-later
"""Soft shadows in the renders of other engines: a linked copy of the scene makes the Shadow pass, and the compositor
multiplies with it. Everything made here carries a mark, by which the counterpart finds and removes it."""

import threading

import bpy
from bpy.types import Operator

from . import compat

# On the copy: that it is one; on nodes: that they are ours, and what the scene was like before.
_MARK = 'penumbra_composite'
_SPACING = 200


def shadow_scene(scene):
    """The copy that makes the shadows of this scene, or None."""
    # Blender lets a node whose scene is deleted show another one.
    return next((node.scene for node in _ours(scene) if node.bl_idname == 'CompositorNodeRLayers' and node.scene and
                 _MARK in node.scene), None)


def is_set_up(scene):
    """Even if the copy was deleted."""
    return bool(_ours(scene))


def _ours(scene):
    tree = compat.compositor_tree(scene)
    return [node for node in tree.nodes if _MARK in node] if tree else []


def add(scene, view_layer):
    """Sets it up. Raises ValueError with what is in the way."""
    if scene.render.engine == 'PENUMBRA':
        raise ValueError("The scene is rendered by Penumbra: its shadows are in the picture already")
    if is_set_up(scene):
        raise ValueError("The scene has composited soft shadows already")
    if not scene.render.use_compositing:
        raise ValueError("Compositing is off: turn it on in Output Properties > Post Processing first")
    if scene.render.use_single_layer:
        raise ValueError("Render Single Layer is on: Blender renders no other scene for the compositor then, "
                         "and Penumbra's shadows are made in one. Turn it off in View Layer Properties first")
    if compat.shares_compositor(scene):
        raise ValueError("Other scenes use the same compositing nodes: make those of this scene a single user first")
    idle = compat.idle_compositor_nodes(scene)
    if idle:
        raise ValueError(f"The scene's compositing nodes are off, and '{idle[0].name}' among them would change the "
                         "picture: turn on Use Nodes in the compositor, or mute or delete them first")
    had_nodes = compat.uses_compositor(scene)
    tree, is_new = compat.ensure_compositor_tree(scene)
    before = set(tree.nodes)
    outputs = compat.compositor_outputs(tree)
    copy = _copy_scene(scene, view_layer)
    shadow = _layers_node(tree, copy, view_layer.name)
    for socket in outputs:
        _multiply(tree, scene, view_layer, socket, shadow.outputs['Shadow'])
    for node in set(tree.nodes) - before:
        node[_MARK] = [int(had_nodes), int(is_new)]


def _copy_scene(scene, view_layer):
    copy = scene.copy()
    copy.name = f"{scene.name} Soft Shadows"
    copy[_MARK] = True
    compat.clear_compositor(copy)
    copy.render.engine = 'PENUMBRA'
    copy.render.film_transparent = False
    layer = copy.view_layers[view_layer.name]
    for other in [other for other in copy.view_layers if other != layer]:
        copy.view_layers.remove(other)
    layer.use = layer.use_pass_shadow = True
    layer.update_render_passes()
    return copy


def _layers_node(tree, scene, layer):
    node = tree.nodes.new('CompositorNodeRLayers')
    node.scene = scene
    node.layer = layer
    node.label = scene.name
    return node


def _multiply(tree, scene, view_layer, socket, shadow):
    """Between an output's image and what feeds it."""
    if socket.links:
        source = socket.links[0].from_socket
    else:
        source = _layers_node(tree, scene, view_layer.name).outputs['Image']
    node, first, second, result = compat.new_multiply_node(tree)
    node.label = "Soft Shadows"
    place = socket.node.location
    node.location = place.x - _SPACING, place.y
    shadow.node.location = place.x - 2 * _SPACING, place.y - 2 * _SPACING
    tree.links.new(source, first)
    tree.links.new(shadow, second)
    tree.links.new(result, socket)


def remove(scene):
    """Leaves the scene as it was before `add`."""
    nodes = _ours(scene)
    if not nodes:
        raise ValueError("The scene has no composited soft shadows")
    copy = shadow_scene(scene)
    had_nodes, is_new = nodes[0][_MARK]
    tree = compat.compositor_tree(scene)
    for node in nodes:
        if node.bl_idname == compat.MULTIPLY_NODE:
            _bypass(tree, node)
    for node in nodes:
        tree.nodes.remove(node)
    if is_new:
        compat.remove_compositor_tree(scene)
    compat.set_uses_compositor(scene, bool(had_nodes))
    # A copy of the scene shows the same shadows.
    if copy and not any(shadow_scene(other) == copy for other in bpy.data.scenes):
        copy.user_clear()   # 3.4 counts a copied scene as a user of itself, and says so
        bpy.data.scenes.remove(copy)


def _bypass(tree, multiply):
    """What fed a Multiply node feeds what it fed; a source of ours goes with it."""
    sources = [link.from_socket for link in compat.multiply_input(multiply).links if _MARK not in link.from_node]
    targets = [link.to_socket for output in multiply.outputs for link in output.links]
    for source in sources:
        for target in targets:
            tree.links.new(source, target)


# ---- Keeping the copy like its scene ----

_RENDER_SETTINGS = ('resolution_x', 'resolution_y', 'resolution_percentage', 'pixel_aspect_x', 'pixel_aspect_y',
                    'use_border', 'use_crop_to_border', 'border_min_x', 'border_max_x', 'border_min_y', 'border_max_y',
                    'use_multiview', 'filter_size', 'use_simplify', 'simplify_subdivision_render',
                    'simplify_child_particles_render')
_COLLECTION_SETTINGS = ('exclude', 'holdout', 'indirect_only')


@bpy.app.handlers.persistent
def synchronize(scene, *_arguments):
    """Before a render: the copy looks through the same camera at the same frame with the same settings."""
    copy = shadow_scene(scene) if isinstance(scene, bpy.types.Scene) else None
    if copy is None:
        return
    _assign(copy, 'camera', scene.camera)
    _assign(copy, 'frame_current', scene.frame_current)
    for name in _RENDER_SETTINGS:
        _assign(copy.render, name, getattr(scene.render, name))
    _assign_group(copy.penumbra, scene.penumbra)


@bpy.app.handlers.persistent
def synchronize_objects(scene, *_arguments):
    """Once the scene has changed, before it is evaluated, since Blender 5.2 crashes if objects come during a render or
    after an update: the copy has the same ones. What is in a collection it has anyway."""
    # F12 updates its own graph beside the main thread, which may be drawing.
    copy = shadow_scene(scene) if threading.current_thread() is threading.main_thread() else None
    if copy is None:
        return
    _assign_links(copy.collection.objects, scene.collection.objects)
    _assign_links(copy.collection.children, scene.collection.children)
    target = copy.view_layers[0]
    source = scene.view_layers.get(target.name)
    if source:
        _assign_collections(target.layer_collection, source.layer_collection)


def _assign_links(target, source):
    before, wanted = set(target), set(source)
    for item in before - wanted:
        target.unlink(item)
    for item in wanted - before:
        target.link(item)


def _assign_collections(target, source):
    """Of a view layer."""
    for child in source.children:
        found = target.children.get(child.name)
        if found:
            for name in _COLLECTION_SETTINGS:
                _assign(found, name, getattr(child, name))
            _assign_collections(found, child)


def _assign(target, name, value):
    if getattr(target, name) != value:
        setattr(target, name, value)


def _assign_group(target, source):
    for item in source.bl_rna.properties:
        if item.identifier in {'rna_type', 'name'}:
            continue
        if item.type == 'POINTER':
            _assign_group(getattr(target, item.identifier), getattr(source, item.identifier))
        else:
            _assign(target, item.identifier, getattr(source, item.identifier))


# ---- Operators ----

class _Operator(Operator):
    bl_options = {'REGISTER', 'UNDO'}

    def execute(self, context):
        try:
            self.change(context)
        except ValueError as error:
            self.report({'ERROR'}, str(error))
            return {'CANCELLED'}
        return {'FINISHED'}


class PENUMBRA_OT_composite(_Operator):
    """Multiply Penumbra's soft shadows into the renders of this scene, by its compositor"""
    bl_idname = 'penumbra.composite'
    bl_label = "Composite Soft Shadows"

    def change(self, context):
        add(context.scene, context.view_layer)


class PENUMBRA_OT_composite_remove(_Operator):
    """Undo Composite Soft Shadows: remove its nodes and its scene"""
    bl_idname = 'penumbra.composite_remove'
    bl_label = "Remove Composited Soft Shadows"

    def change(self, context):
        remove(context.scene)


CLASSES = (PENUMBRA_OT_composite, PENUMBRA_OT_composite_remove)
