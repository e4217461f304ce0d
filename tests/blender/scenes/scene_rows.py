# SPDX-License-Identifier: GPL-3.0-or-later
"""Transformations, materials of objects, and visibility."""

from geometry_rows import sphere
from rows import *

BLENDER_4 = (4, 0)


# ---- Transformations and materials ----

@row('scene', light=0.012, position=0.05)
def mirrored(stage):
    """A mirrored, smooth object."""
    ob = sphere(stage, smooth=True)
    ob.scale = -1, 1, 0.6


@row('scene', light=0.012, position=0.05)
def scaled_unevenly(stage):
    """A sheared object: an uneven scale above a turned one."""
    parent = add_object("Parent", None, scale=(1.6, 0.5, 1))
    child = sphere(stage, smooth=True)
    child.parent, child.rotation_euler = parent, (0.3, 0.4, 0.8)


@row('scene')
def several_materials(stage):
    """Faces of a mesh in three materials."""
    cube = stage.cube(material=white_material("Red", (0.9, 0.1, 0.1)))
    for name, color in (("Green", (0.1, 0.8, 0.2)), ("Blue", (0.1, 0.2, 0.9))):
        cube.data.materials.append(white_material(name, color))
    for number, polygon in enumerate(cube.data.polygons):
        polygon.material_index = number % 3


@row('scene')
def material_of_object(stage):
    """A slot that belongs to the object instead of the mesh."""
    cube = stage.cube()
    cube.material_slots[0].link = 'OBJECT'
    cube.material_slots[0].material = white_material("Own", (0.2, 0.8, 0.7))


# ---- Visibility ----

@row('scene')
def hidden_in_render(stage):
    """Hidden in renders, hidden in the viewport, and hidden by the eye."""
    stage.cube()
    stage.cube(location=(0.8, 0.2, 0.5)).hide_render = True
    stage.cube(location=(-0.9, 0.4, 0.5)).hide_viewport = True
    stage.cube(location=(-0.9, -0.6, 0.5), half=0.2).hide_set(True)


@row('scene')
def visible_camera_off(stage):
    """Not seen by the camera; its shadow is."""
    stage.cube().visible_camera = False


@row('scene')
def visible_shadow_off(stage):
    """Seen, without a shadow."""
    stage.cube().visible_shadow = False


@row('scene')
def holdout(stage):
    """An object that cuts a hole."""
    stage.cube().is_holdout = True


@row('scene')
def shadow_catcher(stage):
    """The floor shows nothing but the shadow on it."""
    refine(stage)   # only the cube gives light, a tenth of the picture's
    stage.cube()
    stage.floor.is_shadow_catcher = True


@row('scene')
def receive_shadows_off(stage):
    """Receive Shadows off: Cycles renders the floor by a light without shadow."""
    stage.cube().visible_camera = False
    stage.for_penumbra = lambda: setattr(stage.floor.penumbra, 'receive_shadows', False)
    stage.for_cycles = lambda: without_shadow(stage.light.data)


def without_shadow(light):
    light.use_shadow = False
    if hasattr(light.cycles, 'cast_shadow'):
        light.cycles.cast_shadow = False


@row('scene', since=BLENDER_4)
def light_linking(stage):
    """A second light shines on the cube only."""
    cube = stage.cube()
    light = second_light()
    collection = bpy.data.collections.new("Receivers")
    collection.objects.link(cube)
    light.light_linking.receiver_collection = collection


@row('scene', since=BLENDER_4)
def light_linking_excluded(stage):
    """A second light shines on all but the cube."""
    cube = stage.cube()
    light = second_light()
    collection = bpy.data.collections.new("Receivers")
    collection.objects.link(cube)
    light.light_linking.receiver_collection = collection
    collection.collection_objects[0].light_linking.link_state = 'EXCLUDE'


@row('scene', since=BLENDER_4)
def shadow_linking(stage):
    """Of two cubes only one shadows the second light."""
    cube = stage.cube()
    stage.cube(location=(0.8, 0.2, 0.4), half=0.25)
    light = second_light()
    collection = bpy.data.collections.new("Blockers")
    collection.objects.link(cube)
    light.light_linking.blocker_collection = collection


@row('scene', since=BLENDER_4)
def light_and_shadow_linking(stage):
    """Both kinds of links, with a collection of a collection."""
    cube = stage.cube()
    other = stage.cube(location=(0.8, 0.2, 0.4), half=0.25)
    light = second_light()
    inner, receivers = bpy.data.collections.new("Inner"), bpy.data.collections.new("Receivers")
    receivers.children.link(inner)
    inner.objects.link(stage.floor)
    inner.objects.link(other)
    light.light_linking.receiver_collection = receivers
    blockers = bpy.data.collections.new("Blockers")
    blockers.objects.link(cube)
    light.light_linking.blocker_collection = blockers
    blockers.collection_objects[0].light_linking.link_state = 'EXCLUDE'


def second_light():
    return add_light("Second", 'POINT', location=(-1.2, -1.2, 2.2), energy=120, color=(1, 0.5, 0.2),
                     shadow_soft_size=0.15)
