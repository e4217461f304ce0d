# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances and libraries."""

import os

from frame_rows import collect
from geometry_rows import chain, geometry_nodes
from rows import *


@row('scene')
def geometry_nodes_instances(stage):
    """Instances of an object on points, by geometry nodes."""
    source = stage.cube(half=0.15, location=(9, 9, 9))
    ob = stage.show(add_plane("Points", half=0.6, location=(0, 0, 0.5)))
    group = geometry_nodes(stage, ob)
    instance, info = group.nodes.new('GeometryNodeInstanceOnPoints'), group.nodes.new('GeometryNodeObjectInfo')
    info.inputs['Object'].default_value = source
    instance.inputs['Rotation'].default_value = 0.3, 0.2, 0.4
    group.links.new(info.outputs['Geometry'], instance.inputs['Instance'])
    chain(group, instance)


@row('scene')
def geometry_nodes_realized(stage):
    """Geometry of nodes with a material of its own."""
    group = geometry_nodes(stage, stage.show(add_plane("Grid", half=0.5, location=(0, 0, 0.6))))
    extrude, material = group.nodes.new('GeometryNodeExtrudeMesh'), group.nodes.new('GeometryNodeSetMaterial')
    extrude.inputs['Offset Scale'].default_value = 0.3
    material.inputs['Material'].default_value = white_material("Blue", (0.1, 0.2, 0.9))
    chain(group, extrude, material)


@row('scene')
def particle_instances(stage):
    """Particles as objects; the emitter is hidden."""
    source = stage.cube(half=0.5, location=(9, 9, 9), rotation=(0, 0, 0))
    ob = stage.show(add_plane("Emitter", half=0.9, location=(0, 0, 0.5)))
    bpy.context.view_layer.objects.active = ob
    stage.modifier(ob, 'PARTICLE_SYSTEM')
    settings = ob.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 12, 1, 1, 50
    settings.physics_type, settings.render_type = 'NO', 'OBJECT'
    settings.instance_object, settings.particle_size = source, 0.25
    ob.show_instancer_for_render = False


@row('scene')
def vertex_instances(stage):
    """Children on the vertices of their parent, which is not drawn."""
    parent = add_plane("Parent", half=0.7, location=(0, 0, 0.5))
    parent.instance_type = 'VERTS'
    child = stage.cube(half=0.2, location=(0, 0, 0))
    child.parent = parent
    parent.show_instancer_for_render = False


@row('scene')
def collection_instance(stage):
    """A collection that is only seen through its instance, mirrored and turned."""
    collection = bpy.data.collections.new("Group")
    for location in ((-0.4, 0, 0.4), (0.4, 0.2, 0.6)):
        ob = stage.cube(half=0.25, location=location)
        stage.scene.collection.objects.unlink(ob)
        collection.objects.link(ob)
    empty = add_object("Instance", None, rotation=(0, 0, 0.7), scale=(-1.2, 1, 1))
    empty.instance_type, empty.instance_collection = 'COLLECTION', collection


@row('scene')
def light_in_instance(stage):
    """Lights inside a collection instance, twice."""
    stage.cube()
    stage.light.hide_render = True
    collection = bpy.data.collections.new("Lamp")
    lamp = add_light("Bulb", 'POINT', location=(0, 0, 1.8), energy=60, shadow_soft_size=0.1)
    stage.scene.collection.objects.unlink(lamp)
    collection.objects.link(lamp)
    for x in (-0.9, 0.9):
        empty = add_object("Instance", None, location=(x, 0, 0))
        empty.instance_type, empty.instance_collection = 'COLLECTION', collection


def _instanced(stage, ob):
    """An instance of a collection that holds the object only."""
    collection = bpy.data.collections.new("Group")
    stage.scene.collection.objects.unlink(ob)
    collection.objects.link(ob)
    empty = add_object("Instance", None)
    empty.instance_type, empty.instance_collection = 'COLLECTION', collection
    return empty


@row('scene')
def instance_not_seen(stage):
    """The instancing object is not seen by the camera, so what it instances is not."""
    _instanced(stage, stage.cube()).visible_camera = False


@row('scene')
def instance_without_shadow(stage):
    """The instancing object casts no shadow."""
    _instanced(stage, stage.cube()).visible_shadow = False


@row('scene')
def instance_holdout(stage):
    """The instancing object cuts a hole."""
    _instanced(stage, stage.cube()).is_holdout = True


@row('scene')
def instance_of_holdout(stage):
    """A holdout that is instanced is none: the instancing object decides."""
    cube = stage.cube()
    cube.is_holdout = True
    _instanced(stage, cube)


@row('scene')
def instance_indirect_only(stage):
    """The instancing object lies in a collection that is not seen but casts its shadow."""
    collect(stage, _instanced(stage, stage.cube())).indirect_only = True


@row('scene')
def instance_in_holdout_collection(stage):
    """The instancing object lies in a collection that cuts a hole."""
    collect(stage, _instanced(stage, stage.cube())).holdout = True


@row('scene')
def instance_shadow_catcher(stage):
    """The instancing object makes a shadow catcher of the floor."""
    refine(stage)   # see shadow_catcher
    stage.cube()
    _instanced(stage, stage.floor).is_shadow_catcher = True


@row('scene')
def particles_without_shadow(stage):
    """The emitter's switch is that of its particles, too."""
    particle_instances(stage)
    bpy.data.objects["Emitter"].visible_shadow = False


def _library(stage):
    """Path of a .blend with the object "Linked", which leaves this file."""
    ob = stage.cube()
    ob.name = "Linked"
    path = os.path.join(stage.folder, "library.blend")
    bpy.data.libraries.write(path, {ob})
    bpy.data.objects.remove(ob)
    return path


def _link(path):
    with bpy.data.libraries.load(path, link=True) as (_source, target):
        target.objects = ["Linked"]
    return target.objects[0]


@row('scene')
def library_linked(stage):
    """An object linked from another .blend."""
    stage.scene.collection.objects.link(_link(_library(stage)))


@row('scene')
def library_override(stage):
    """A library override that moves the object and gives it another material."""
    linked = _link(_library(stage))
    stage.scene.collection.objects.link(linked)
    ob = linked.override_create(remap_local_usages=True)
    ob.location = 0.5, -0.2, 0.6
    ob.material_slots[0].link = 'OBJECT'
    ob.material_slots[0].material = white_material("Override", (0.9, 0.4, 0.1))
