# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes, materials, lights and cameras for the sample scenes. Works alike in Blender 3.4 and newer."""
import math

import bmesh
import bpy
from mathutils import Matrix, Vector


def material(name, color, alpha=1.0):
    """A diffuse material, made once per name."""
    found = bpy.data.materials.get(name)
    if found:
        return found
    mat = bpy.data.materials.new(name)
    mat.use_nodes = True
    shader = mat.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Roughness"].default_value = 1.0
    shader.inputs["Alpha"].default_value = alpha
    specular = "Specular" if "Specular" in shader.inputs else "Specular IOR Level"
    shader.inputs[specular].default_value = 0.0
    mat.diffuse_color = (*color, 1.0)
    return mat


def image_material(name, width, height, texel):
    """A diffuse material whose base colour is an image; texel(u, v) returns sRGB in 0..1."""
    mat = material(name, (0.8, 0.8, 0.8))
    pixels = []
    for y in range(height):
        for x in range(width):
            pixels.extend((*texel((x + 0.5) / width, (y + 0.5) / height), 1.0))
    image = bpy.data.images.new(name, width, height)
    image.pixels.foreach_set(pixels)
    image.pack()
    nodes = mat.node_tree.nodes
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    mat.node_tree.links.new(texture.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    return mat


def transform(location=(0, 0, 0), rotation=(0, 0, 0), scale=1.0):
    """A matrix from metres, XYZ degrees and a factor or three."""
    factors = scale if isinstance(scale, (tuple, list)) else (scale, scale, scale)
    turn = Matrix.Identity(4)
    for angle, axis in zip(rotation, "XYZ"):
        turn = Matrix.Rotation(math.radians(angle), 4, axis) @ turn
    return Matrix.Translation(location) @ turn @ Matrix.Diagonal((*factors, 1.0))


def place(name, mesh, matrix=None):
    """Links a new object that uses `mesh`."""
    item = bpy.data.objects.new(name, mesh)
    if matrix is not None:
        item.matrix_world = matrix
    bpy.context.scene.collection.objects.link(item)
    return item


def finish(bm, name, mat, smooth=None):
    """Turns a bmesh into a mesh; `smooth` is the angle in degrees below which edges are smooth, None: flat."""
    mesh = bpy.data.meshes.new(name)
    bmesh.ops.recalc_face_normals(bm, faces=bm.faces)
    bm.to_mesh(mesh)
    bm.free()
    mesh.materials.append(mat)
    if smooth is not None:
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        if hasattr(mesh, "use_auto_smooth"):
            mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.radians(smooth)
        else:
            mesh.set_sharp_from_angle(angle=math.radians(smooth))
    return mesh


def box_mesh(name, size, mat, bevel=0.0):
    """A box standing on z = 0, centred in x and y."""
    bm = bmesh.new()
    bmesh.ops.create_cube(bm, size=1.0)
    bm.transform(Matrix.Diagonal((*size, 1.0)) @ Matrix.Translation((0, 0, 0.5)))
    if bevel:
        bmesh.ops.bevel(bm, geom=bm.edges[:], offset=bevel, segments=3, profile=0.5, affect="EDGES")
    return finish(bm, name, mat, 40 if bevel else None)


def grid_mesh(name, size, steps, mat, height=None):
    """A rectangle with UVs in 0..1; height(x, y) lifts its vertices."""
    bm = bmesh.new()
    bmesh.ops.create_grid(bm, x_segments=steps[0], y_segments=steps[1], size=0.5, calc_uvs=False)
    uvs = bm.loops.layers.uv.new("UVMap")
    for face in bm.faces:
        for loop in face.loops:
            loop[uvs].uv = loop.vert.co.x + 0.5, loop.vert.co.y + 0.5
    for vertex in bm.verts:
        x, y = vertex.co.x * size[0], vertex.co.y * size[1]
        vertex.co = x, y, height(x, y) if height else 0.0
    return finish(bm, name, mat, 180 if height else None)


def lathe_mesh(name, profile, mat, segments=64, smooth=40, bump=None):
    """Turns a profile of (radius, z) about Z; radius 0 closes it. bump(turn, step) scales the radius."""
    bm = bmesh.new()
    rings = []
    for step, (radius, z) in enumerate(profile):
        if radius == 0:
            rings.append([bm.verts.new((0, 0, z))] * segments)
            continue
        ring = []
        for i in range(segments):
            turn = 2 * math.pi * i / segments
            r = radius * (bump(turn, step) if bump else 1.0)
            ring.append(bm.verts.new((r * math.cos(turn), r * math.sin(turn), z)))
        rings.append(ring)
    for low, high in zip(rings, rings[1:]):
        for i in range(segments):
            j = (i + 1) % segments
            corners = list(dict.fromkeys((low[i], low[j], high[j], high[i])))
            if len(corners) > 2:
                bm.faces.new(corners)
    return finish(bm, name, mat, smooth)


def spline(points, steps):
    """Catmull-Rom points through `points`, `steps` per span."""
    points = [Vector(p) for p in points]
    ends = [2 * points[0] - points[1]] + points + [2 * points[-1] - points[-2]]
    result = []
    for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:]):
        for i in range(steps):
            t = i / steps
            result.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t
                                 + (3 * b - a - 3 * c + d) * t * t * t))
    return result + [points[-1]]


def tube_mesh(name, points, radius, mat, segments=8, tip=None):
    """A round tube along a path, thinning from `radius` to `tip`."""
    points = [Vector(p) for p in points]
    tip = radius if tip is None else tip
    bm = bmesh.new()
    rings = []
    for i, point in enumerate(points):
        along = (points[min(i + 1, len(points) - 1)] - points[max(i - 1, 0)]).normalized()
        side = along.orthogonal().normalized() if not rings else (side - along * side.dot(along)).normalized()
        up = along.cross(side)
        r = radius + (tip - radius) * i / (len(points) - 1)
        rings.append([bm.verts.new(point + r * (math.cos(a) * side + math.sin(a) * up))
                      for a in (2 * math.pi * k / segments for k in range(segments))])
    for low, high in zip(rings, rings[1:]):
        for k in range(segments):
            bm.faces.new((low[k], low[(k + 1) % segments], high[(k + 1) % segments], high[k]))
    bm.faces.new(rings[0])
    bm.faces.new(rings[-1])
    return finish(bm, name, mat, 60)


def leaf_mesh(name, length, width, mat, fold=0.25, droop=0.2, steps=6):
    """A pointed leaf along +X, folded along its rib."""
    bm = bmesh.new()
    rows = []
    for i in range(steps + 1):
        t = i / steps
        half = 0.5 * width * math.sin(math.pi * min(1.0, t ** 0.75))
        x, z = length * t, -droop * length * t * t
        rib = bm.verts.new((x, 0, z))
        sides = None if half < 1e-6 else [bm.verts.new((x, s * half, z + fold * half)) for s in (-1, 1)]
        rows.append((rib, sides))
    for (rib, sides), (next_rib, next_sides) in zip(rows, rows[1:]):
        for k in (0, 1):
            corners = [rib, next_rib] + ([next_sides[k]] if next_sides else []) + ([sides[k]] if sides else [])
            bm.faces.new(corners)
    return finish(bm, name, mat, 60)


def area_light(name, matrix, power, size, shape="RECTANGLE", color=(1, 1, 1)):
    light = bpy.data.lights.new(name, "AREA")
    light.shape, light.energy, light.color = shape, power, color
    light.size, light.size_y = size if isinstance(size, tuple) else (size, size)
    return _place_light(name, light, matrix)


def point_light(name, location, power, radius, color=(1, 1, 1)):
    light = bpy.data.lights.new(name, "POINT")
    light.energy, light.shadow_soft_size, light.color = power, radius, color
    return _place_light(name, light, Matrix.Translation(location))


def spot_light(name, matrix, power, radius, cone, blend, color=(1, 1, 1)):
    light = bpy.data.lights.new(name, "SPOT")
    light.energy, light.shadow_soft_size, light.color = power, radius, color
    light.spot_size, light.spot_blend = math.radians(cone), blend
    return _place_light(name, light, matrix)


def sun_light(name, matrix, irradiance, angle, color=(1, 1, 1)):
    light = bpy.data.lights.new(name, "SUN")
    light.energy, light.angle, light.color = irradiance, math.radians(angle), color
    return _place_light(name, light, matrix)


def _place_light(name, light, matrix):
    item = bpy.data.objects.new(name, light)
    item.matrix_world = matrix
    bpy.context.scene.collection.objects.link(item)
    return item


def aim(location, target, roll=0.0):
    """The matrix of a camera or light at `location` that looks at `target`."""
    turn = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_matrix().to_4x4()
    return Matrix.Translation(location) @ turn @ Matrix.Rotation(math.radians(roll), 4, "Z")


def camera(location, target, lens=50.0):
    data = bpy.data.cameras.new("Camera")
    data.lens = lens
    item = bpy.data.objects.new("Camera", data)
    item.matrix_world = aim(location, target)
    bpy.context.scene.collection.objects.link(item)
    bpy.context.scene.camera = item
    return item


def world(color):
    """The background, which is also the ambient light."""
    data = bpy.data.worlds.new("World")
    data.use_nodes = True
    data.node_tree.nodes["Background"].inputs["Color"].default_value = (*color, 1.0)
    data.color = color
    bpy.context.scene.world = data
