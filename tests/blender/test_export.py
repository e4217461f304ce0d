# SPDX-License-Identifier: GPL-3.0-or-later
"""What the library receives: captures of scenes are compared with captures written by hand, byte by byte."""

import math
from array import array
from ctypes import byref, c_void_p

import bpy
import mathutils

from harness import SceneTest, add_camera, add_cube, add_light, add_mesh, add_plane, output, white_material

from penumbra import capi, compat, export, mesh as mesh_export, report, settings


def read(path):
    """(capture handle, pnb_scene, pnb_settings); the handle keeps the others alive."""
    handle = c_void_p()
    capi.library().capture_read(path.encode(), byref(handle))
    return handle, capi.library().capture_scene(handle).contents, capi.library().capture_settings(handle).contents


def content(path):
    with open(path, 'rb') as file:
        return file.read()


class ExportTest(SceneTest):
    def captured(self):
        handle, scene, settings = read(self.capture())
        self.addCleanup(lambda: capi.library().destroy('capture', handle))
        return scene, settings

    def warnings(self):
        """Exports in the viewport's dependency graph."""
        with export.SceneExport(bpy.context.evaluated_depsgraph_get()) as exported:
            return exported.warnings

    def assert_close(self, actual, expected, delta=1e-6):
        actual, expected = list(actual), list(expected)
        self.assertEqual(len(actual), len(expected))
        for a, b in zip(actual, expected):
            self.assertAlmostEqual(a, b, delta=delta)


class Pyramid(ExportTest):
    """A mesh written twice: once by Blender, once by hand."""
    VERTICES = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    SLOTS = [0, 1, 0, 1]
    COLORS = [(0.5, 0.25, 0.125), (1.0, 0.0, 0.5)]

    def from_blender(self, smooth):
        ob = add_mesh("Pyramid", self.VERTICES, self.FACES, location=(1, 2, 3))
        layer = ob.data.uv_layers.new(name="Map")
        for index, corner in enumerate(layer.data):
            corner.uv = self.uv(index)
        for color in self.COLORS:
            ob.data.materials.append(white_material(color=color))
        ob.data.polygons.foreach_set('material_index', self.SLOTS)
        ob.data.polygons.foreach_set('use_smooth', [smooth] * 4)
        add_camera(location=(0, 0, 8), sensor_width=32, lens=32, clip_end=100)
        return self.capture("blender")

    @staticmethod
    def uv(corner):
        return corner / 16.0, 1.0 - corner / 32.0

    def normals(self, smooth):
        points = [mathutils.Vector(vertex) for vertex in self.VERTICES]
        flat = [(points[b] - points[a]).cross(points[c] - points[a]).normalized() for a, b, c in self.FACES]
        if not smooth:
            return [normal for normal in flat for _ in range(3)]
        # Blender weighs a vertex's normals by the angle of each face there.
        vertex = [mathutils.Vector() for _ in points]
        for face, normal in zip(self.FACES, flat):
            for k in range(3):
                a, b, c = face[k], face[(k + 1) % 3], face[(k + 2) % 3]
                vertex[a] += normal * (points[b] - points[a]).angle(points[c] - points[a])
        return [vertex[corner].normalized() for face in self.FACES for corner in face]

    def blender_s_normals(self, smooth):
        """Blender's, which differ from exact ones by its approximation of angles."""
        mesh = bpy.data.objects["Pyramid"].data
        compat.prepare_mesh(mesh)
        found = next(mesh_export.copy_of(source) for source in compat.mesh_arrays(mesh)
                     if source.member == 'corner_normals')
        compat.release_mesh(mesh)
        self.assert_close(found, [x for normal in self.normals(smooth) for x in normal], 1e-3)
        return found

    def by_hand(self, smooth):
        """The same scene from plain arrays."""
        keep = [array('f', [x for vertex in self.VERTICES for x in vertex]),
                array('I', [corner for face in self.FACES for corner in face]),
                self.blender_s_normals(smooth),
                array('f', [x for corner in range(12) for x in self.uv(corner)]), array('I', range(12)),
                array('i', self.SLOTS)]
        desc = capi.MeshDesc(name=b"Pyramid", vertex_count=4, corner_count=12, triangle_count=4)
        members = (desc.positions, desc.corner_vertices, desc.corner_normals, desc.corner_uvs, desc.triangles,
                   desc.polygon_materials)
        for member, values in zip(members, keep):
            member.data = values.buffer_info()[0]
        mesh = capi.library().create('mesh', desc)
        instance = capi.Instance(mesh=mesh, name=b"Pyramid", slot_count=2)
        instance.matrix[:] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]
        scene = capi.Scene(instance_count=1, material_count=2, slot_count=2)
        scene.instances = (capi.Instance * 1)(instance)
        scene.materials = (capi.Material * 2)(*[capi.Material(base_color=color) for color in self.COLORS])
        scene.slots = (capi.c_uint32 * 2)(0, 1)
        scene.camera = self.camera()
        path = output('by_hand.pnb')
        export.write_capture(path, scene, settings.for_still(bpy.context.evaluated_depsgraph_get(), 64, 48))
        capi.library().destroy('mesh', mesh)
        return path

    @staticmethod
    def camera():
        camera = capi.Camera(clip_start=0.1, clip_end=100.0)
        camera.matrix[:] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 8, 1]
        camera.window[:] = -0.5, 0.5, -0.375, 0.375
        return camera

    def test_flat(self):
        self.assertEqual(content(self.from_blender(False)), content(self.by_hand(False)))

    def test_smooth(self):
        self.assertEqual(content(self.from_blender(True)), content(self.by_hand(True)))


class Pointers(ExportTest):
    """Memory read by address equals what RNA says."""

    def build(self):
        material = white_material()
        for name, make in (("Grid", bpy.ops.mesh.primitive_grid_add), ("Ball", bpy.ops.mesh.primitive_uv_sphere_add),
                           ("Monkey", bpy.ops.mesh.primitive_monkey_add)):
            make()
            ob = bpy.context.object
            ob.name = name
            ob.data.materials.append(material)
            ob.data.materials.append(white_material("Other"))
            ob.data.polygons.foreach_set('material_index', [i % 2 for i in range(len(ob.data.polygons))])
            ob.data.polygons.foreach_set('use_smooth', [i % 3 > 0 for i in range(len(ob.data.polygons))])
        ob.modifiers.new("Subdivision", 'SUBSURF')
        add_camera()

    def written(self, name, use_pointers):
        depsgraph = bpy.context.evaluated_depsgraph_get()
        with export.SceneExport(depsgraph, use_pointers) as exported:
            camera = self.scene.camera
            exported.set_camera(camera, camera.matrix_world, 0.0, 64, 48, 1.0)
            export.write_capture(output(name), exported.scene, settings.for_still(depsgraph, 64, 48))
        return content(output(name))

    def test_equal_files(self):
        self.build()
        self.assertEqual(self.written('pointers.pnb', True), self.written('copies.pnb', False))

    def test_pointers_are_used(self):
        """Every array but the corner normals of 3.4 is reached in memory."""
        self.build()
        found = []
        depsgraph = bpy.context.evaluated_depsgraph_get()
        mesh = bpy.data.objects["Monkey"].evaluated_get(depsgraph).data
        compat.prepare_mesh(mesh)
        for source in compat.mesh_arrays(mesh):
            if source.memory is not None:
                found.append(source.member)
                place = mesh_export.memory_of(source)
                self.assertIsNotNone(place, source.member)
                self.assertEqual(self.walk(source, *place), mesh_export.copy_of(source), source.member)
        compat.release_mesh(mesh)
        self.assertGreaterEqual(set(found), {'positions', 'corner_vertices', 'corner_uvs', 'triangles',
                                             'triangle_polygons', 'polygon_materials'})

    @staticmethod
    def walk(source, address, stride):
        element = mesh_export._CTYPES[source.typecode] * source.width
        values = array(source.typecode)
        for index in range(len(source.rna)):
            values.extend(element.from_address(address + index * stride))
        return values

    def test_wrong_memory_is_noticed(self):
        """Claims that memory holds something else than it does."""
        self.build()
        mesh = bpy.data.objects["Ball"].data
        compat.prepare_mesh(mesh)
        honest = {source.member: source for source in compat.mesh_arrays(mesh)}
        for member in ('positions', 'triangles'):
            for change in ({'offset': 4}, {'memory': mesh.edges}, {'memory': mesh.loops}):
                mesh_export._verified.clear()
                self.assertIsNone(mesh_export.memory_of(honest[member]._replace(**change)), (member, change))
        mesh_export._verified.clear()


class Instances(ExportTest):
    def test_instances_share_one_mesh(self):
        cube = add_cube()
        self.scene.collection.objects.unlink(cube)
        collection = bpy.data.collections.new("Cubes")
        collection.objects.link(cube)
        for index in range(5):
            ob = bpy.data.objects.new("Copy", None)
            ob.instance_type = 'COLLECTION'
            ob.instance_collection = collection
            ob.location.x = index
            self.scene.collection.objects.link(ob)
        add_camera()
        scene, _settings = self.captured()
        self.assertEqual(scene.instance_count, 5)
        self.assertEqual(len({scene.instances[i].mesh for i in range(5)}), 1)
        self.assertEqual(sorted(scene.instances[i].matrix[12] for i in range(5)), [0, 1, 2, 3, 4])

    def test_visibility(self):
        names = {"Seen": {}, "NoCamera": {'visible_camera': False}, "NoShadow": {'visible_shadow': False},
                 "Hidden": {'hide_render': True}}
        for name, flags in names.items():
            ob = add_cube(name)
            for key, value in flags.items():
                setattr(ob, key, value)
        bpy.data.objects["Seen"].hide_viewport = True
        add_camera()
        scene, _settings = self.captured()
        flags = {scene.instances[i].name: scene.instances[i].flags for i in range(scene.instance_count)}
        self.assertEqual(flags, {b"Seen": 0, b"NoCamera": capi.INSTANCE_HIDDEN_FROM_CAMERA,
                                 b"NoShadow": capi.INSTANCE_NO_SHADOW})

    def test_objects_that_become_meshes(self):
        """Each appears once."""
        bpy.ops.object.text_add()
        bpy.ops.surface.primitive_nurbs_surface_sphere_add()
        bpy.ops.object.metaball_add(type='BALL')
        bpy.ops.curve.primitive_bezier_circle_add()
        bpy.context.object.data.bevel_depth = 0.1
        bpy.context.object.name = "BezierCircle"    # with an accent since 4.0
        add_camera()
        scene, _settings = self.captured()
        names = sorted(scene.instances[i].name.decode() for i in range(scene.instance_count))
        self.assertEqual(names, ["BezierCircle", "Mball", "SurfSphere", "Text"])

    def test_modifiers_and_empty_meshes(self):
        ob = add_cube()
        ob.modifiers.new("Array", 'ARRAY').count = 3
        add_mesh("Empty", [], [])
        add_mesh("Wire", [(0, 0, 0), (1, 0, 0)], [])
        add_camera()
        scene, _settings = self.captured()
        self.assertEqual(scene.instance_count, 1)

    def test_edit_mode(self):
        ob = add_cube()
        add_camera()
        before = content(self.capture("object"))
        bpy.context.view_layer.objects.active = ob
        bpy.ops.object.mode_set(mode='EDIT')
        during = content(self.capture("edit"))
        bpy.ops.object.mode_set(mode='OBJECT')
        self.assertEqual(before, during)


class Cameras(ExportTest):
    def window(self, **settings):
        camera = add_camera(location=(1, 2, 3), rotation=(0.3, 0.2, 0.1), **settings)
        captured, _settings = self.captured()
        bpy.data.objects.remove(camera)
        return captured.camera

    def test_windows_match_blender_s_matrix(self):
        """Window corners project to the corners of clip space."""
        render = self.scene.render
        for size in ((64, 48), (48, 64)):
            for aspect in ((1, 1), (2, 1), (1, 1.5)):
                render.resolution_x, render.resolution_y = size
                render.pixel_aspect_x, render.pixel_aspect_y = aspect
                for fit in ('AUTO', 'HORIZONTAL', 'VERTICAL'):
                    for kind in ('PERSP', 'ORTHO'):
                        self.check_window(size, aspect, fit, kind)

    def check_window(self, size, aspect, fit, kind):
        with self.subTest(size=size, aspect=aspect, fit=fit, kind=kind):
            camera = add_camera(type=kind, sensor_fit=fit, shift_x=0.1, shift_y=-0.2, lens=35, ortho_scale=4,
                                sensor_width=36, sensor_height=20)
            matrix = camera.calc_matrix_camera(bpy.context.evaluated_depsgraph_get(), x=size[0], y=size[1],
                                               scale_x=aspect[0], scale_y=aspect[1])
            scene, _settings = self.captured()
            left, right, bottom, top = scene.camera.window
            for x, y, corner in ((left, bottom, (-1, -1)), (right, top, (1, 1))):
                point = matrix @ mathutils.Vector((x, y, -1, 1))
                self.assert_close((point.x / point.w, point.y / point.w), corner, 1e-5)
            bpy.data.objects.remove(camera)

    def test_place_and_clipping(self):
        camera = add_camera(location=(1, 2, 3), rotation=(0.3, 0.2, 0.1), clip_start=0.5, clip_end=50)
        scene, _settings = self.captured()
        self.assert_close(scene.camera.matrix, [x for column in camera.matrix_world.col for x in column])
        self.assert_close((scene.camera.clip_start, scene.camera.clip_end), (0.5, 50))

    def test_what_is_not_supported(self):
        """A line each, once, though both eyes of stereo look through the camera."""
        camera = add_camera()
        camera.data.dof.use_dof = True
        camera.data.clip_start, camera.data.clip_end = 5.0, 1.0
        self.scene.render.use_motion_blur = True
        self.scene.render.use_multiview = True
        bpy.ops.render.render()
        self.assertEqual([line[:line.index(':')] for line in report.lines],
                         ["scene 'Scene'", "camera 'Camera'", "camera 'Camera'"])
        for line, word in zip(report.lines, ("motion blur", "depth of field", "clip")):
            self.assertIn(word, line)


class Materials(ExportTest):
    def setUp(self):
        super().setUp()
        self.ob = add_plane()
        add_camera()

    def material(self, *nodes):
        material = bpy.data.materials.new("Test")
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        self.ob.data.materials.append(material)
        return tree, [tree.nodes.new(kind) for kind in nodes]

    def exported(self):
        scene, _settings = self.captured()
        self.assertEqual(scene.material_count, 1)
        return scene.materials[0]

    def image(self, name="Picture", alpha=True, **settings):
        return bpy.data.images.new(name, 4, 4, alpha=alpha, **settings)

    def test_principled_values(self):
        tree, (surface, shader) = self.material('ShaderNodeOutputMaterial', 'ShaderNodeBsdfPrincipled')
        shader.inputs['Base Color'].default_value = 0.5, 0.25, 0.125, 1
        shader.inputs['Alpha'].default_value = 0.75
        tree.links.new(shader.outputs[0], surface.inputs[0])
        material = self.exported()
        self.assert_close(material.base_color, (0.5, 0.25, 0.125))
        self.assertAlmostEqual(material.transparency, 0.25)
        self.assertFalse(material.base_color_texture or material.alpha_texture)

    def test_images_through_groups_and_reroutes(self):
        group = bpy.data.node_groups.new("Group", 'ShaderNodeTree')
        if hasattr(group, 'interface'):
            group.interface.new_socket("Color", in_out='INPUT', socket_type='NodeSocketColor')
            group.interface.new_socket("Shader", in_out='OUTPUT', socket_type='NodeSocketShader')
        else:
            group.inputs.new('NodeSocketColor', "Color")
            group.outputs.new('NodeSocketShader', "Shader")
        inside = [group.nodes.new(kind) for kind in ('NodeGroupInput', 'ShaderNodeBsdfPrincipled', 'NodeGroupOutput')]
        group.links.new(inside[0].outputs[0], inside[1].inputs['Base Color'])
        group.links.new(inside[1].outputs[0], inside[2].inputs[0])
        tree, (surface, shader, reroute, picture) = self.material(
            'ShaderNodeOutputMaterial', 'ShaderNodeGroup', 'NodeReroute', 'ShaderNodeTexImage')
        shader.node_tree = group
        picture.image = self.image()
        tree.links.new(picture.outputs['Color'], reroute.inputs[0])
        tree.links.new(reroute.outputs[0], shader.inputs[0])
        tree.links.new(shader.outputs[0], surface.inputs[0])
        material = self.exported()
        self.assertTrue(material.base_color_texture)
        self.assert_close(material.base_color, (1, 1, 1))
        self.assertEqual(self.warnings(), [])

    def test_transparent_mixed_by_image(self):
        tree, (surface, mix, clear, diffuse, picture) = self.material(
            'ShaderNodeOutputMaterial', 'ShaderNodeMixShader', 'ShaderNodeBsdfTransparent', 'ShaderNodeBsdfDiffuse',
            'ShaderNodeTexImage')
        picture.image = self.image()
        tree.links.new(picture.outputs['Alpha'], mix.inputs[0])
        tree.links.new(clear.outputs[0], mix.inputs[1])
        tree.links.new(diffuse.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], surface.inputs[0])
        material = self.exported()
        self.assertTrue(material.alpha_texture)
        self.assertEqual(material.transparency, 0.0)

    def test_transparent_mixed_by_value(self):
        tree, (surface, mix, clear, diffuse) = self.material(
            'ShaderNodeOutputMaterial', 'ShaderNodeMixShader', 'ShaderNodeBsdfTransparent', 'ShaderNodeBsdfDiffuse')
        mix.inputs[0].default_value = 0.25
        diffuse.inputs['Color'].default_value = 0.5, 0.5, 0.5, 1
        tree.links.new(clear.outputs[0], mix.inputs[1])
        tree.links.new(diffuse.outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], surface.inputs[0])
        material = self.exported()
        self.assertAlmostEqual(material.transparency, 0.75)
        self.assert_close(material.base_color, (0.5, 0.5, 0.5))

    def test_unsupported_names_the_material(self):
        tree, (surface, shader, noise) = self.material('ShaderNodeOutputMaterial', 'ShaderNodeBsdfGlossy',
                                                       'ShaderNodeTexNoise')
        tree.links.new(noise.outputs[1], shader.inputs['Color'])
        tree.links.new(shader.outputs[0], surface.inputs[0])
        warnings = self.warnings()
        self.assertEqual(len(warnings), 2)
        for warning in warnings:
            self.assertIn("material 'Test'", warning)

    def test_missing_image_is_named(self):
        tree, (surface, shader, picture) = self.material('ShaderNodeOutputMaterial', 'ShaderNodeBsdfDiffuse',
                                                         'ShaderNodeTexImage')
        picture.image = bpy.data.images.new("Lost", 4, 4)
        picture.image.source = 'FILE'
        picture.image.filepath = output("no such file.png")
        tree.links.new(picture.outputs[0], shader.inputs[0])
        tree.links.new(shader.outputs[0], surface.inputs[0])
        self.assertTrue(any("'Lost' is missing" in warning for warning in self.warnings()))
        self.assertFalse(self.exported().base_color_texture)

    def test_without_nodes_and_without_material(self):
        scene, _settings = self.captured()
        self.assertEqual((scene.material_count, scene.instances[0].slot_count), (0, 0))
        if not bpy.app.version >= (5, 0):
            material = bpy.data.materials.new("Plain")
            material.diffuse_color = 0.1, 0.2, 0.3, 1
            self.ob.data.materials.append(material)
            self.assert_close(self.exported().base_color, (0.1, 0.2, 0.3))

    def test_slots_of_the_object_count(self):
        self.ob.data.materials.append(white_material(color=(1, 0, 0)))
        self.ob.material_slots[0].link = 'OBJECT'
        self.ob.material_slots[0].material = white_material(color=(0, 1, 0))
        self.assert_close(self.exported().base_color, (0, 1, 0))


class Lights(ExportTest):
    """Numbers against Cycles are in test_radiometry; here is what depends on switches."""

    def light(self, *arguments, **settings):
        ob = add_light("Light", *arguments, **settings)
        add_camera()
        scene, _settings = self.captured()
        light = scene.lights[0]
        copy = capi.Light.from_buffer_copy(light)
        bpy.data.objects.remove(ob)
        return copy, scene.light_count

    def test_shadow_switches(self):
        self.assertEqual(self.light('POINT')[0].flags, 0)
        self.assertEqual(self.light('POINT', use_shadow=False)[0].flags, capi.LIGHT_NO_SHADOW)

    def test_cycles_shadow_switch(self):
        light = bpy.data.lights.new("Light", 'POINT')
        if not hasattr(getattr(light, 'cycles', None), 'cast_shadow'):
            self.skipTest("Cycles has no switch of its own")
        light.cycles.cast_shadow = False
        self.assertFalse(compat.light_casts_shadow(light))

    def test_sizes(self):
        area, _count = self.light('AREA', shape='ELLIPSE', size=2, size_y=0.5, scale=(3, 1, 1))
        self.assertEqual((area.type, area.shape), (capi.AREA, capi.ELLIPSE))
        self.assert_close(area.size, (2, 0.5))
        self.assert_close(area.matrix[0:3], (3, 0, 0))
        spot, _count = self.light('SPOT', spot_size=1.0, spot_blend=0.25, shadow_soft_size=0.125)
        self.assert_close((spot.spot_angle, spot.spot_blend, spot.radius), (1.0, 0.25, 0.125))
        sun, _count = self.light('SUN', angle=0.01, energy=3)
        self.assert_close((sun.angle, *sun.emission), (0.01, 3, 3, 3), 1e-4)

    def test_light_nodes(self):
        light = add_light("Light", 'POINT', energy=4 * math.pi).data
        light.use_nodes = True
        light.node_tree.nodes['Emission'].inputs['Strength'].default_value = 2
        light.node_tree.nodes['Emission'].inputs['Color'].default_value = 1, 0.5, 0, 1
        add_camera()
        scene, _settings = self.captured()
        self.assert_close(scene.lights[0].emission, (2, 1, 0))

    def test_no_area(self):
        for settings in ({'size': 0}, {'shape': 'ELLIPSE', 'size_y': 0}):
            add_light("Flat", 'AREA', **settings)
        add_camera()
        self.assertEqual(self.captured()[0].light_count, 0)
        self.assertEqual(self.warnings(),
                         [f"light '{name}' has no area and gives no light" for name in ("Flat", "Flat.001")])

    def test_no_scale(self):
        """Against Cycles in the scene rows dark_lights."""
        for kind in ('AREA', 'SUN', 'SPOT', 'POINT'):
            add_light(kind, kind, scale=(0, 0, 0))
        self.assertEqual(self.warnings(), [f"light '{kind}' has a scale of 0 and gives no light"
                                           for kind in ('AREA', 'SUN', 'SPOT')])
        add_camera()
        scene, _settings = self.captured()
        self.assertEqual([scene.lights[i].name for i in range(scene.light_count)], [b'POINT'])

    def test_portal(self):
        for kind in ('AREA', 'POINT'):
            add_light(kind, kind).data.cycles.is_portal = True
        add_camera()
        scene, _settings = self.captured()
        self.assertEqual([scene.lights[i].name for i in range(scene.light_count)], [b'POINT'])
        self.assertEqual(self.warnings(), [])


class World(ExportTest):
    def color(self, world):
        self.scene.world = world
        add_camera()
        return list(self.captured()[0].world_color)

    def test_none(self):
        self.assertEqual(self.color(None), [0, 0, 0])

    def test_background(self):
        world = bpy.data.worlds.new("World")
        world.use_nodes = True
        background = next(node for node in world.node_tree.nodes if node.type == 'BACKGROUND')
        background.inputs['Color'].default_value = 0.5, 0.25, 1, 1
        background.inputs['Strength'].default_value = 2
        self.assertEqual(self.color(world), [1, 0.5, 2])


class Settings(ExportTest):
    def test_all(self):
        options = self.scene.penumbra
        options.technique = 'PCSS'
        options.samples, options.shadow_map_size, options.light_samples = 5, 512, 7
        self.scene.render.filter_size = 2.0
        self.scene.render.film_transparent = True
        self.scene.render.resolution_percentage = 50
        self.scene.render.use_border = True
        self.scene.render.border_min_x, self.scene.render.border_max_x = 0.25, 0.5
        self.layer.use_pass_z = self.layer.use_pass_shadow = True
        number = next(info for info in capi.library().techniques() if info[0].id == b'PCSS')[1]
        parameter = next(info for info in number if info.type == capi.INT)
        name = parameter.name.decode()
        setattr(options.pcss, name, int(parameter.minimum) + 1)
        add_camera()
        _scene, settings = self.captured()
        self.assertEqual(settings.technique, b'PCSS')
        self.assertEqual((settings.samples, settings.shadow_map_size, settings.light_samples), (5, 512, 7))
        self.assertEqual((settings.width, settings.height), (32, 24))
        self.assertEqual(list(settings.crop), [8, 0, 8, 24])
        self.assertEqual(settings.filter_width, 2.0)
        self.assertEqual(settings.flags, capi.SETTINGS_FILM_TRANSPARENT)
        self.assertEqual(settings.passes, capi.PASS_COMBINED | capi.PASS_DEPTH | capi.PASS_SHADOW)
        values = {settings.values[i].name.decode(): settings.values[i].value for i in range(settings.value_count)}
        self.assertEqual(values[name], parameter.minimum + 1)
