# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that differs between Blender 3.4, 4.3 and 5.2. No other file asks for a version."""

import os
from array import array

import bpy
from math import pi
from typing import NamedTuple

BLENDER_4 = bpy.app.version >= (4, 0)

# Cycles spreads an area light's power over a quarter of the sphere before 4.0, over a Lambertian lobe since.
AREA_RADIANCE_PER_POWER = 1.0 / pi if BLENDER_4 else 1.0 / 4.0
# Before 4.0 a spot is a flat disk across its axis, which emits by the cosine, and the object's scale does nothing.
SPOT_IS_FLAT_DISK = not BLENDER_4
SPOT_IS_SCALED = BLENDER_4
# The axes that a light needs: Cycles takes one whose scale is 0 for dark.
AXES_THAT_LIGHT = {'POINT': (), 'SUN': (2,),
                   'SPOT': (0, 1, 2) if BLENDER_4 else (2,), 'AREA': (0, 1, 2) if BLENDER_4 else (0, 1)}
# Before 4.0 Cycles takes a sun for a flat disk at distance 1, whose rim gives less than its centre.
SUN_IS_FLAT_DISK = not BLENDER_4

# Inputs of the Principled shader that were renamed.
PRINCIPLED_EMISSION = 'Emission Color' if BLENDER_4 else 'Emission'
PRINCIPLED_TRANSMISSION = 'Transmission Weight' if BLENDER_4 else 'Transmission'
# Each of the two surfaces of a body of glass tints by its base colour, since 4.0 both together.
TRANSMISSION_EXPONENT = 0.5 if BLENDER_4 else 1.0

# (what is not drawn, input that asks for it) by the node's type.
OMITTED_INPUTS = {
    'BSDF_DIFFUSE': (("the roughness of its diffuse reflection", 'Roughness'),),
    'BSDF_PRINCIPLED': (
        ("metallic reflection", 'Metallic'), ("the roughness of its diffuse reflection", 'Diffuse Roughness'),
        ("subsurface scattering", 'Subsurface Weight' if BLENDER_4 else 'Subsurface'),
        ("sheen", 'Sheen Weight' if BLENDER_4 else 'Sheen'), ("coat", 'Coat Weight' if BLENDER_4 else 'Clearcoat')),
}

# Settings that panels show where there are such.
HAS_LIGHT_TEMPERATURE = 'use_temperature' in bpy.types.Light.bl_rna.properties
LIGHT_POWER = tuple(name for name in ('energy', 'exposure', 'normalize')
                    if name in bpy.types.PointLight.bl_rna.properties)
VIEW_LAYER_OVERRIDES = tuple(name for name in ('material_override', 'world_override')
                             if name in bpy.types.ViewLayer.bl_rna.properties)

# Panels of other engines that fit this one too.
ADOPTED_PANELS = ('EEVEE_MATERIAL_PT_context_material', 'EEVEE_MATERIAL_PT_surface', 'EEVEE_WORLD_PT_surface')


class MeshArray(NamedTuple):
    """Where a member of pnb_mesh_desc is found: as RNA property, and in memory if that can be reached."""
    member: str         # of pnb_mesh_desc
    typecode: str       # of the array module: 'f', 'I' or 'i'
    width: int          # numbers per element
    rna: object         # collection that has `attribute` on its elements
    attribute: str
    memory: object      # collection whose elements' addresses lead to the data, or None
    offset: int = 0     # bytes from an element's address to the data


def prepare_mesh(mesh):
    """Makes triangles and corner normals available."""
    mesh.calc_loop_triangles()
    if not hasattr(mesh, 'corner_normals'):
        mesh.calc_normals_split()


def release_mesh(mesh):
    if not hasattr(mesh, 'corner_normals'):
        mesh.free_normals_split()


def mesh_arrays(mesh, uv_map=''):
    """The arrays of a prepared mesh. They are valid as long as the evaluated mesh is. `uv_map`: its name; '': the one
    for renders."""
    triangles = mesh.loop_triangles
    yield MeshArray('positions', 'f', 3, mesh.vertices, 'co', mesh.vertices)
    yield MeshArray('corner_vertices', 'I', 1, mesh.loops, 'vertex_index', mesh.loops)
    if hasattr(mesh, 'corner_normals'):
        yield MeshArray('corner_normals', 'f', 3, mesh.corner_normals, 'vector', mesh.corner_normals)
    else:
        yield MeshArray('corner_normals', 'f', 3, mesh.loops, 'normal', None)
    layers = mesh.uv_layers
    layer = layers.get(uv_map) if uv_map else next((each for each in layers if each.active_render), None)
    if layer and hasattr(layer, 'uv'):
        yield MeshArray('corner_uvs', 'f', 2, layer.uv, 'vector', layer.uv)
    elif layer:
        yield MeshArray('corner_uvs', 'f', 2, layer.data, 'uv', layer.data)
    yield MeshArray('triangles', 'I', 3, triangles, 'loops', triangles)
    if hasattr(mesh, 'loop_triangle_polygons'):
        polygons = mesh.loop_triangle_polygons
        yield MeshArray('triangle_polygons', 'I', 1, polygons, 'value', polygons)
    else:
        yield MeshArray('triangle_polygons', 'I', 1, triangles, 'polygon_index', triangles, 12)
    slots = mesh.attributes.get('material_index')
    if slots and slots.domain == 'FACE' and slots.data_type == 'INT':
        yield MeshArray('polygon_materials', 'i', 1, slots.data, 'value', slots.data)


def light_casts_shadow(light):
    """Blender 3.4 has one switch per engine: either one turns the shadow off."""
    cycles = getattr(light, 'cycles', None)
    return light.use_shadow and getattr(cycles, 'cast_shadow', True)


def light_is_portal(light):
    """Whether it only shows Cycles where the world's light comes in."""
    return light.type == 'AREA' and getattr(getattr(light, 'cycles', None), 'is_portal', False)


def light_color(light):
    """Linear colour that the energy is multiplied with."""
    color = list(light.color)
    if getattr(light, 'use_temperature', False):
        color = [a * b for a, b in zip(color, light.temperature_color)]
    gain = 2.0 ** getattr(light, 'exposure', 0.0)
    return [channel * gain for channel in color]


def light_is_normalized(light):
    """Whether the energy is the power of the whole light instead of its power per area."""
    return getattr(light, 'normalize', True)


def uses_nodes(owner):
    """Materials, worlds and lights: `use_nodes` is deprecated in 5.x, where it is always on."""
    return bool(owner.node_tree) and getattr(owner, 'use_nodes', True)


def culls_backfaces(material):
    """(for the camera, for shadows)."""
    return material.use_backface_culling, getattr(material, 'use_backface_culling_shadow', False)


def casts_no_shadow(material):
    """By EEVEE's shadow mode of Blender 3.4."""
    return getattr(material, 'shadow_method', 'OPAQUE') == 'NONE'


def shadow_threshold(material):
    """The alpha from which on EEVEE's shadow mode CLIP of Blender 3.4 takes a surface for opaque; 0: another mode."""
    clips = getattr(material, 'shadow_method', 'OPAQUE') == 'CLIP'
    return min(max(material.alpha_threshold, 1e-6), 1.0) if clips else 0.0


def casts_opaque_shadow(material):
    """Transparency can be left out of shadows: a setting of Cycles, since 4.2 of the material."""
    return not all(getattr(owner, 'use_transparent_shadow', True)
                   for owner in (material, getattr(material, 'cycles', None)))


def draw_material_settings(column, material):
    """In the panel: what the functions above read."""
    if hasattr(material, 'shadow_method'):
        column.prop(material, 'use_backface_culling')
        column.prop(material, 'shadow_method')
        if material.shadow_method == 'CLIP':
            column.prop(material, 'alpha_threshold')
        return
    sub = column.column(heading="Backface Culling")
    sub.prop(material, 'use_backface_culling', text="Camera")
    sub.prop(material, 'use_backface_culling_shadow', text="Shadow")
    column.prop(material, 'use_transparent_shadow')


def view_layer_overrides(view_layer):
    """(material, world) that replace all others, or None."""
    return view_layer.material_override, getattr(view_layer, 'world_override', None)


# ---- Compositor: a tree of the scene until 4.x, a node group of its own since 5.0 ----

_COMPOSITOR_IS_GROUP = 'compositing_node_group' in bpy.types.Scene.bl_rna.properties


def compositor_tree(scene):
    return scene.compositing_node_group if _COMPOSITOR_IS_GROUP else scene.node_tree


def uses_compositor(scene):
    return bool(scene.compositing_node_group) if _COMPOSITOR_IS_GROUP else scene.use_nodes


def shares_compositor(scene):
    """Whether what is changed in its tree changes other scenes' pictures."""
    return _COMPOSITOR_IS_GROUP and scene.compositing_node_group is not None and \
        sum(other.compositing_node_group == scene.compositing_node_group for other in bpy.data.scenes) > 1


# What a new tree consists of, or what shows pictures only.
_PLAIN_NODES = {'CompositorNodeRLayers', 'CompositorNodeComposite', 'CompositorNodeViewer', 'NodeFrame', 'NodeReroute'}


def idle_compositor_nodes(scene):
    """Those that would change the picture if the tree, which is off, were used."""
    if uses_compositor(scene) or not compositor_tree(scene):
        return []
    return [node for node in compositor_tree(scene).nodes if node.bl_idname not in _PLAIN_NODES and not node.mute]


def set_uses_compositor(scene, uses):
    if not _COMPOSITOR_IS_GROUP and scene.use_nodes != uses:
        scene.use_nodes = uses


def ensure_compositor_tree(scene):
    """(tree, whether it is new) that is used for renders."""
    before = compositor_tree(scene)
    if not _COMPOSITOR_IS_GROUP:
        scene.use_nodes = True
        return scene.node_tree, before is None
    if before:
        return before, False
    tree = bpy.data.node_groups.new(f"{scene.name} Compositor", 'CompositorNodeTree')
    tree.interface.new_socket("Image", in_out='OUTPUT', socket_type='NodeSocketColor')
    tree.nodes.new('NodeGroupOutput')
    scene.compositing_node_group = tree
    return tree, True


def remove_compositor_tree(scene):
    """A scene's own tree cannot be removed, only not be used."""
    if _COMPOSITOR_IS_GROUP:
        bpy.data.node_groups.remove(scene.compositing_node_group)


def clear_compositor(scene):
    """Of a copied scene."""
    if _COMPOSITOR_IS_GROUP:
        scene.compositing_node_group = None
    elif scene.node_tree:
        scene.node_tree.nodes.clear()
        scene.use_nodes = False


def compositor_outputs(tree):
    """The image sockets of what is taken as the render."""
    kind = 'NodeGroupOutput' if _COMPOSITOR_IS_GROUP else 'CompositorNodeComposite'
    nodes = [node for node in tree.nodes if node.bl_idname == kind and not node.mute] or [tree.nodes.new(kind)]
    return [node.inputs[0] for node in nodes]


MULTIPLY_NODE = 'ShaderNodeMix' if _COMPOSITOR_IS_GROUP else 'CompositorNodeMixRGB'


def new_multiply_node(tree):
    """(node, first input, second input, output)."""
    node = tree.nodes.new(MULTIPLY_NODE)
    if _COMPOSITOR_IS_GROUP:
        node.data_type, node.blend_type = 'RGBA', 'MULTIPLY'
        sockets = {socket.identifier: socket for socket in (*node.inputs, *node.outputs)}
        sockets['Factor_Float'].default_value = 1.0
        return node, sockets['A_Color'], sockets['B_Color'], sockets['Result_Color']
    node.blend_type = 'MULTIPLY'
    return node, node.inputs[1], node.inputs[2], node.outputs[0]


def multiply_input(node):
    """The first input of such a node."""
    name = 'A_Color' if _COMPOSITOR_IS_GROUP else 'Image'
    return next(socket for socket in node.inputs if socket.identifier == name)


def missing_from(block):
    """Path of the library in which a data-block that is used here is not found, so that a place-holder stands for it;
    else None. Before Blender 4 nothing tells a place-holder: an empty thing from a file that is not there."""
    original = block.original
    reference = original.override_library.reference if original.override_library else original
    if reference is None or reference.library is None:
        return None
    path = reference.library.filepath
    if hasattr(reference, 'is_missing'):
        return path if reference.is_missing else None
    is_empty = not any(getattr(reference, name, None) for name in _CONTENTS)
    return path if is_empty and not os.path.exists(bpy.path.abspath(path)) else None


# What a data-block has inside, by its kind.
_CONTENTS = ('data', 'vertices', 'splines', 'points', 'elements', 'objects', 'nodes', 'node_tree', 'has_data')


def light_linking(ob):
    """Of an original object; None before Blender 4.0."""
    return getattr(ob, 'light_linking', None)


def point_values(data, name, attribute, width):
    """Numbers of an attribute of the points of a Curves data-block or a point cloud; empty if it has none."""
    layer = data.attributes.get(name)
    if layer is None or layer.domain != 'POINT':
        return array('f')
    values = array('f', bytes(4 * width * len(layer.data)))
    layer.data.foreach_get(attribute, values)
    return values
