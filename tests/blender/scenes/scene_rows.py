# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects, instances, visibility and lights."""

import os
from math import cos, pi, sin

from rows import *

BLENDER_4 = (4, 0)


# ---- Geometry ----

@row('scene')
def mesh_flat(stage):
    """A sphere of flat faces."""
    _sphere(stage, smooth=False)


@row('scene')
def mesh_smooth(stage):
    """A sphere of few smooth faces: normals are interpolated."""
    _sphere(stage, smooth=True)


def _sphere(stage, smooth, **place):
    rings, sectors = 6, 12
    points = [(0.5 * sin(pi * ring / rings) * cos(2 * pi * sector / sectors),
               0.5 * sin(pi * ring / rings) * sin(2 * pi * sector / sectors), 0.5 * cos(pi * ring / rings))
              for ring in range(1, rings) for sector in range(sectors)]
    points += [(0, 0, 0.5), (0, 0, -0.5)]
    faces = []
    for sector in range(sectors):
        after = (sector + 1) % sectors
        faces.append((len(points) - 2, sector, after))
        last = (rings - 2) * sectors
        faces.append((len(points) - 1, last + after, last + sector))
        for ring in range(rings - 2):
            start = ring * sectors
            faces.append((start + sector, start + sectors + sector, start + sectors + after, start + after))
    place.setdefault('location', (0, 0, 0.7))
    ob = stage.show(add_mesh("Sphere", points, faces, **place))
    ob.data.polygons.foreach_set('use_smooth', [smooth] * len(ob.data.polygons))
    return ob


@row('scene')
def mesh_custom_normals(stage):
    """Custom normals that lean to one side."""
    ob = stage.show(add_plane("Leaning", half=0.6, location=(0, 0, 0.4)))
    if hasattr(ob.data, 'use_auto_smooth'):
        ob.data.use_auto_smooth = True
    ob.data.normals_split_custom_set([(0.6, 0, 0.8)] * len(ob.data.loops))


@row('scene')
def modifiers(stage):
    """Subdivision, array and mirror modifiers."""
    ob = stage.cube(half=0.25, location=(-0.6, 0, 0.5))
    stage.modifier(ob, 'SUBSURF', render_levels=2, levels=0)
    stage.modifier(ob, 'ARRAY', count=3)


@row('scene')
def shape_keys(stage):
    """A shape key half way."""
    ob = stage.cube()
    ob.shape_key_add(name="Basis")
    key = ob.shape_key_add(name="High")
    for point in key.data[4:]:
        point.co.z += 1.0
    key.value = 0.5


def _curve(name, points, **settings):
    curve = bpy.data.curves.new(name, 'CURVE')
    curve.dimensions = '3D'
    for key, value in settings.items():
        setattr(curve, key, value)
    spline = curve.splines.new('POLY')
    spline.points.add(len(points) - 1)
    for target, point in zip(spline.points, points):
        target.co = *point, 1.0
    return curve


@row('scene')
def curve_bevel(stage):
    """A curve with a round bevel."""
    curve = _curve("Wire", [(-1, 0, 0.2), (-0.3, 0.5, 0.9), (0.4, -0.3, 0.5), (1, 0.3, 0.8)], bevel_depth=0.1)
    stage.show(add_object("Wire", curve))


@row('scene')
def curve_extruded(stage):
    """A curve extruded to a band."""
    curve = _curve("Band", [(-1, 0, 0.4), (0, 0.4, 0.4), (1, -0.2, 0.4)], extrude=0.3)
    stage.show(add_object("Band", curve))


@row('scene')
def surface(stage):
    """A NURBS surface."""
    data = bpy.data.curves.new("Surface", 'SURFACE')
    for y in range(4):
        spline = data.splines.new('NURBS')
        spline.points.add(3)
        for x, point in enumerate(spline.points):
            point.co = (x - 1.5) * 0.6, (y - 1.5) * 0.6, 0.4 + 0.3 * ((x + y) % 2), 1
    ob = stage.show(add_object("Surface", data))
    bpy.context.view_layer.objects.active = ob
    for spline in data.splines:
        for point in spline.points:
            point.select = True
    bpy.ops.object.mode_set(mode='EDIT')
    bpy.ops.curve.make_segment()
    bpy.ops.object.mode_set(mode='OBJECT')


@row('scene')
def text(stage):
    """A text with depth."""
    refine(stage)
    data = bpy.data.curves.new("Text", 'FONT')
    data.body, data.extrude, data.size, data.align_x = "Aé", 0.1, 1.4, 'CENTER'
    stage.show(add_object("Text", data, location=(0, -0.4, 0.5), rotation=(0.4, 0, 0)))


@row('scene')
def metaballs(stage):
    """Two metaballs that flow together."""
    data = bpy.data.metaballs.new("Balls")
    data.render_resolution = data.resolution = 0.08
    for x in (-0.35, 0.35):
        element = data.elements.new()
        element.co, element.radius = (x, 0, 0), 0.6
    stage.show(add_object("Balls", data, location=(0, 0, 0.6)))


def _strands(count=14):
    """Arcs over the floor: points and radius by strand."""
    for number in range(count):
        x = -1.1 + 2.2 * number / (count - 1)
        points = [(x, -0.6 + 0.3 * step, 0.15 + 0.35 * sin(step * 0.7 + number)) for step in range(6)]
        yield points, 0.015 + 0.01 * (number % 3)


# Strands a pixel wide are all outline.
@row('scene', light=0.05)
def curves_object(stage):
    """A Curves object: hair as ribbons."""
    data = bpy.data.hair_curves.new("Fur")
    strands = list(_strands())
    if not hasattr(data, 'add_curves'):
        _fur_by_operator(stage, strands)
        return
    data.add_curves([len(points) for points, _radius in strands])
    _fill_curves(data, strands)
    stage.show(add_object("Fur", data))


def _fill_curves(data, strands):
    positions = [coordinate for points, _radius in strands for point in points for coordinate in point]
    data.attributes['position'].data.foreach_set('vector', positions)
    radii = data.attributes.get('radius') or data.attributes.new('radius', 'FLOAT', 'POINT')
    radii.data.foreach_set('value', [radius for points, radius in strands for _point in points])


def _fur_by_operator(stage, strands):
    """Before Blender 4 only an operator makes curves: 500 of 8 points each. Those too many are one point."""
    bpy.ops.object.curves_random_add()
    ob = bpy.context.active_object
    ob.location, ob.rotation_euler = (0, 0, 0), (0, 0, 0)
    count, length = len(ob.data.curves), len(ob.data.points) // len(ob.data.curves)
    strands = [(points + [points[-1]] * (length - len(points)), radius) for points, radius in strands]
    strands += [([(0, 0, 9)] * length, 0.001)] * (count - len(strands))
    _fill_curves(ob.data, strands)
    stage.show(ob)


@row('scene', light=0.05)
def hair_particles(stage):
    """Hair of a particle system with children and a tapered width."""
    ob = stage.show(add_plane("Head", half=0.7, location=(0, 0, 0.1)))
    bpy.context.view_layer.objects.active = ob
    stage.modifier(ob, 'PARTICLE_SYSTEM')
    settings = ob.particle_systems[0].settings
    settings.type, settings.count, settings.hair_length = 'HAIR', 40, 0.6
    settings.root_radius, settings.tip_radius, settings.radius_scale = 1.0, 0.3, 0.06
    settings.use_close_tip = False
    settings.child_type, settings.rendered_child_count = 'INTERPOLATED', 3
    settings.material = 1
    settings.render_step = settings.display_step = 3


@row('scene')
def point_cloud(stage):
    """A point cloud, from geometry nodes."""
    ob = stage.cube(half=0.5, location=(0, 0, 0.7))
    group = _geometry_nodes(stage, ob)
    points, material = group.nodes.new('GeometryNodeMeshToPoints'), group.nodes.new('GeometryNodeSetMaterial')
    points.inputs['Radius'].default_value = 0.16
    material.inputs['Material'].default_value = stage.material
    _chain(group, points, material)


def _geometry_nodes(stage, ob):
    group = bpy.data.node_groups.new("Geometry", 'GeometryNodeTree')
    group.nodes.new('NodeGroupInput')
    group.nodes.new('NodeGroupOutput')
    if hasattr(group, 'interface'):
        for direction in ('INPUT', 'OUTPUT'):
            group.interface.new_socket("Geometry", in_out=direction, socket_type='NodeSocketGeometry')
    else:
        group.inputs.new('NodeSocketGeometry', "Geometry")
        group.outputs.new('NodeSocketGeometry', "Geometry")
    stage.modifier(ob, 'NODES').node_group = group
    return group


def _chain(group, *nodes):
    """Input through the first socket of each node to output."""
    first = next(node for node in group.nodes if node.type == 'GROUP_INPUT')
    last = next(node for node in group.nodes if node.type == 'GROUP_OUTPUT')
    for before, after in zip((first, *nodes), (*nodes, last)):
        group.links.new(before.outputs[0], after.inputs[0])


@row('scene')
def volume_reported(stage):
    """A volume cannot be drawn: left out, with a line in the report."""
    stage.cube()
    add_object("Fog", bpy.data.volumes.new("Fog"))


# ---- Instances ----

@row('scene')
def geometry_nodes_instances(stage):
    """Instances of an object on points, by geometry nodes."""
    source = stage.cube(half=0.15, location=(9, 9, 9))
    ob = stage.show(add_plane("Points", half=0.6, location=(0, 0, 0.5)))
    group = _geometry_nodes(stage, ob)
    instance, info = group.nodes.new('GeometryNodeInstanceOnPoints'), group.nodes.new('GeometryNodeObjectInfo')
    info.inputs['Object'].default_value = source
    instance.inputs['Rotation'].default_value = 0.3, 0.2, 0.4
    group.links.new(info.outputs['Geometry'], instance.inputs['Instance'])
    _chain(group, instance)


@row('scene')
def geometry_nodes_realized(stage):
    """Geometry of nodes with a material of its own."""
    group = _geometry_nodes(stage, stage.show(add_plane("Grid", half=0.5, location=(0, 0, 0.6))))
    extrude, material = group.nodes.new('GeometryNodeExtrudeMesh'), group.nodes.new('GeometryNodeSetMaterial')
    extrude.inputs['Offset Scale'].default_value = 0.3
    material.inputs['Material'].default_value = white_material("Blue", (0.1, 0.2, 0.9))
    _chain(group, extrude, material)


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


# ---- Transformations and materials ----

@row('scene', light=0.012, position=0.05)
def mirrored(stage):
    """A mirrored, smooth object."""
    ob = _sphere(stage, smooth=True)
    ob.scale = -1, 1, 0.6


@row('scene', light=0.012, position=0.05)
def scaled_unevenly(stage):
    """A sheared object: an uneven scale above a turned one."""
    parent = add_object("Parent", None, scale=(1.6, 0.5, 1))
    child = _sphere(stage, smooth=True)
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
    stage.for_cycles = lambda: _without_shadow(stage.light.data)


def _without_shadow(light):
    light.use_shadow = False
    if hasattr(light.cycles, 'cast_shadow'):
        light.cycles.cast_shadow = False


@row('scene', since=BLENDER_4)
def light_linking(stage):
    """A second light shines on the cube only."""
    cube = stage.cube()
    light = _second_light()
    collection = bpy.data.collections.new("Receivers")
    collection.objects.link(cube)
    light.light_linking.receiver_collection = collection


@row('scene', since=BLENDER_4)
def light_linking_excluded(stage):
    """A second light shines on all but the cube."""
    cube = stage.cube()
    light = _second_light()
    collection = bpy.data.collections.new("Receivers")
    collection.objects.link(cube)
    light.light_linking.receiver_collection = collection
    collection.collection_objects[0].light_linking.link_state = 'EXCLUDE'


@row('scene', since=BLENDER_4)
def shadow_linking(stage):
    """Of two cubes only one shadows the second light."""
    cube = stage.cube()
    stage.cube(location=(0.8, 0.2, 0.4), half=0.25)
    light = _second_light()
    collection = bpy.data.collections.new("Blockers")
    collection.objects.link(cube)
    light.light_linking.blocker_collection = collection


@row('scene', since=BLENDER_4)
def light_and_shadow_linking(stage):
    """Both kinds of links, with a collection of a collection."""
    cube = stage.cube()
    other = stage.cube(location=(0.8, 0.2, 0.4), half=0.25)
    light = _second_light()
    inner, receivers = bpy.data.collections.new("Inner"), bpy.data.collections.new("Receivers")
    receivers.children.link(inner)
    inner.objects.link(stage.floor)
    inner.objects.link(other)
    light.light_linking.receiver_collection = receivers
    blockers = bpy.data.collections.new("Blockers")
    blockers.objects.link(cube)
    light.light_linking.blocker_collection = blockers
    blockers.collection_objects[0].light_linking.link_state = 'EXCLUDE'


def _second_light():
    return add_light("Second", 'POINT', location=(-1.2, -1.2, 2.2), energy=120, color=(1, 0.5, 0.2),
                     shadow_soft_size=0.15)


# ---- Lights ----

def _only(stage, kind, **settings):
    """Another light instead of the stage's."""
    stage.cube()
    stage.light.hide_render = True
    settings.setdefault('location', (0.8, -0.5, 2.6))
    return add_light("Other", kind, **settings)


@row('scene')
def light_point(stage):
    """A point light with a radius."""
    _only(stage, 'POINT', shadow_soft_size=0.15)


@row('scene')
def light_spot(stage):
    """A spot with a soft edge."""
    _only(stage, 'SPOT', rotation=(0.1, 0.3, 0), spot_size=0.9, spot_blend=0.5, shadow_soft_size=0.04, energy=300)


@row('scene')
def light_sun(stage):
    """A sun of 6 degrees."""
    _only(stage, 'SUN', rotation=(0.3, 0.5, 0), energy=3, angle=0.105)


@row('scene')
def light_disk(stage):
    """A disk."""
    _only(stage, 'AREA', shape='DISK', size=0.8, rotation=(0.2, 0.3, 0))


@row('scene')
def light_ellipse_scaled(stage):
    """An ellipse, scaled and turned."""
    _only(stage, 'AREA', shape='ELLIPSE', size=0.6, size_y=0.3, rotation=(0.2, 0.3, 0.5), scale=(1.5, 2, 1))


@row('scene')
def light_spread(stage):
    """An area light that shines into a cone of 60 degrees."""
    refine(stage)
    _only(stage, 'AREA', size=0.7, spread=radians(60), rotation=(0.1, 0.2, 0))


@row('scene')
def light_without_shadow(stage):
    """A light whose shadow is switched off, beside one with a shadow."""
    stage.cube()
    _without_shadow(_second_light().data)


@row('scene')
def light_hidden_from_diffuse(stage):
    """A light that no diffuse surface sees."""
    stage.cube()
    _second_light().visible_diffuse = False


@row('scene')
def light_portal(stage):
    """An area light that only shows where the world's light comes in, beside one that lights."""
    stage.cube()
    portal = add_light("Portal", 'AREA', location=(-1.2, -1.2, 2.2), size=0.6, energy=200)
    portal.data.cycles.is_portal = True
    stage.scene.world = add_world((0, 0, 0))    # Cycles ends with a crash without one


@row('scene')
def lights_without_scale(stage):
    """Lights whose scale is 0 along all axes or one, beside one that lights."""
    refine(stage)   # Cycles chooses among them for each sample
    stage.cube()
    for number, scale in enumerate(((0, 0, 0), (1, 1, 0), (0, 1, 1))):
        place = {'location': (number - 1, -1.2, 2.2), 'scale': scale}
        add_light("Sun", 'SUN', angle=0, energy=0.5, **place)
        add_light("Spot", 'SPOT', shadow_soft_size=0, energy=60, **place)
        add_light("Area", 'AREA', size=0.4, energy=30, **place)


@row('scene', since=(4, 4))
def light_exposure(stage):
    """Exposure of a light."""
    _only(stage, 'POINT', shadow_soft_size=0.1, energy=25).data.exposure = 1.7


@row('scene', since=(4, 4))
def light_not_normalized(stage):
    """Normalize off: the energy is that of each square metre."""
    _only(stage, 'AREA', shape='DISK', size=0.8, rotation=(0.2, 0.3, 0), scale=(1, 2, 1)).data.normalize = False


@row('scene', since=(4, 4))
def light_temperature(stage):
    """Colour by temperature."""
    data = _only(stage, 'AREA', size=0.6).data
    data.use_temperature, data.temperature = True, 2700


@row('scene')
def light_nodes(stage):
    """An Emission node with colour and strength."""
    data = _only(stage, 'AREA', size=0.6).data
    data.use_nodes = True
    node = next(node for node in data.node_tree.nodes if node.type == 'EMISSION')
    node.inputs['Color'].default_value = 0.2, 0.6, 1, 1
    node.inputs['Strength'].default_value = 1.5


@row('scene')
def lights_many(stage):
    """Twelve lights."""
    stage.cube()
    stage.light.hide_render = True
    for number in range(12):
        angle = 2 * pi * number / 12
        add_light("Small", 'POINT', location=(1.5 * cos(angle), 1.5 * sin(angle), 1.5), energy=15,
                  shadow_soft_size=0.05, color=(1, number / 12, 0.5))
