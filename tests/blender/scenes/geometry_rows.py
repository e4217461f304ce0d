# SPDX-License-Identifier: GPL-3.0-or-later
"""What objects are made of."""

from math import cos, pi, sin

from rows import *


@row('scene')
def mesh_flat(stage):
    """A sphere of flat faces."""
    sphere(stage, smooth=False)


@row('scene')
def mesh_smooth(stage):
    """A sphere of few smooth faces: normals are interpolated."""
    sphere(stage, smooth=True)


def sphere(stage, smooth, **place):
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
    group = geometry_nodes(stage, ob)
    points, material = group.nodes.new('GeometryNodeMeshToPoints'), group.nodes.new('GeometryNodeSetMaterial')
    points.inputs['Radius'].default_value = 0.16
    material.inputs['Material'].default_value = stage.material
    chain(group, points, material)


def geometry_nodes(stage, ob):
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


def chain(group, *nodes):
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
