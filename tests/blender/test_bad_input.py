# SPDX-License-Identifier: GPL-3.0-or-later
"""What nobody should have in a scene: a finite picture and a line that names the object, or an error."""

import contextlib
import math
import os
import subprocess
import sys
from unittest import mock

import bpy

from harness import (ADDON, SceneTest, add_camera, add_cube, add_light, add_mesh, add_object, add_plane, add_world,
                     output, run_blender, set_movie, white_material)

from penumbra import report


class BadInput(SceneTest):
    def setUp(self):
        super().setUp()
        self.still_life()

    def finite(self, *mentioned):
        """Renders; the picture has only finite numbers and the report mentions each text. Returns the red channel."""
        picture = self.render()
        for name, (_width, _height, values) in picture.items():
            self.assertTrue(all(map(math.isfinite, values)), name)
        for text in mentioned:
            self.assertTrue(any(text in line for line in report.lines), (text, report.lines))
        return picture['ViewLayer.Combined.R'][2]

    def test_nothing(self):
        for ob in list(bpy.data.objects):
            if ob.type != 'CAMERA':
                bpy.data.objects.remove(ob)
        self.scene.world = None
        self.assertEqual(set(self.finite()), {0.0})

    def test_empty_and_loose_meshes(self):
        add_mesh("Empty", [], [])
        add_mesh("Loose", [(0, 0, 1), (1, 0, 1)], [])
        self.finite()

    def test_not_a_number(self):
        add_mesh("Broken", [(0, 0, 1), (1, 0, 1), (0, 1, math.nan), (1, 1, math.inf)], [(0, 1, 2), (0, 1, 3)])
        self.finite("Broken")

    def test_faces_without_area(self):
        add_mesh("Flat", [(0, 0, 1), (1, 0, 1), (2, 0, 1), (0, 0, 1)], [(0, 1, 2), (0, 3, 1)])
        self.finite("Flat")

    def test_scales(self):
        for scale in (1e-4, 1e5):
            with self.subTest(scale=scale):
                add_cube(f"Scaled {scale}", location=(0, 0, -scale), scale=(scale,) * 3)
                self.finite()

    def test_scale_of_nothing(self):
        add_cube("Squashed", location=(1, 0, 1), scale=(1, 1, 0))
        add_cube("Gone", location=(1, 0, 1), scale=(0, 0, 0))
        add_light("Squashed Light", 'AREA', scale=(0, 1, 1))
        self.finite("Squashed Light")

    def test_a_thousand_kilometres_away(self):
        """Floats have steps of a sixteenth of a metre there: the picture must be a picture, not the same one."""
        for ob in bpy.data.objects:
            ob.location.x += 1e6
        red = self.finite()
        self.assertGreater(max(red), 0.1)

    def test_light_inside_and_on_a_wall(self):
        add_light("Inside", 'POINT', location=(0, 0, 0.5), shadow_soft_size=0.1)
        add_light("Flush", 'AREA', location=(0, 0, 0), rotation=(math.pi, 0, 0), size=1.0)
        self.finite()

    def test_what_is_no_camera(self):
        """Blender looks through any object, with a lens of 35 mm, or of a spot light's cone."""
        place = {'location': (1, -2, 6), 'rotation': (0.3, 0.1, 0.0)}
        spot = {'spot_size': 2 * math.atan(16 / 24), 'energy': 0.0}
        for lens, ob in ((35, add_object("Target", None, **place)), (35, add_cube("Block", **place)),
                         (35, add_light("Lamp", 'AREA', energy=0.0, **place)),
                         (24, add_light("Torch", 'SPOT', **place, **spot))):
            with self.subTest(name=ob.name):
                ob.visible_camera = ob.visible_shadow = False
                self.scene.camera = ob
                seen = self.finite(ob.name)
                add_camera(lens=lens, **place)
                self.assertLess(max(abs(a - b) for a, b in zip(seen, self.finite())), 1e-4)

    def test_too_many_lights(self):
        for number in range(70):
            add_light(f"Lamp {number:02}", 'POINT', location=(number % 8 - 4, number // 8 - 4, 2), energy=1)
        self.finite("Lamp 69")

    def test_missing_and_corrupted_images(self):
        with open(output("corrupted.png"), 'wb') as file:
            file.write(b'\x89PNG\r\n\x1a\n' + bytes(200))
        for name in ("nosuch.png", "corrupted.png"):
            material = white_material(name)
            tree = material.node_tree
            texture = tree.nodes.new('ShaderNodeTexImage')
            texture.image = bpy.data.images.new(name, 4, 4)
            texture.image.source, texture.image.filepath = 'FILE', output(name)
            diffuse = next(node for node in tree.nodes if node.type == 'BSDF_DIFFUSE')
            tree.links.new(texture.outputs['Color'], diffuse.inputs['Color'])
            add_plane(name, half=0.5, location=(1, 1, 1)).data.materials.append(material)
        self.finite("nosuch.png", "corrupted.png")

    def link_of_each_kind(self, path):
        """A scene that uses one of each kind of data-block from a library; {kind: name}."""
        data = bpy.data
        made = {'object': add_object("Linked", None), 'mesh': data.meshes.new("Shape"),
                'curve': data.curves.new("Wire", 'CURVE'), 'camera': data.cameras.new("View"),
                'point light': data.lights.new("Bulb", 'POINT'), 'world': data.worlds.new("Sky"),
                'material': white_material("Paint"), 'image': data.images.new("Picture", 4, 4),
                'collection': data.collections.new("Group"),
                'node tree': data.node_groups.new("Nodes", 'ShaderNodeTree')}
        made['image'].pack()
        data.libraries.write(path, set(made.values()))
        names = {kind: block.name for kind, block in made.items()}
        data.batch_remove(made.values())
        with data.libraries.load(path, link=True) as (source, target):
            for kind in dir(source):
                setattr(target, kind, getattr(source, kind))
        own = white_material("Own")
        own.node_tree.nodes.new('ShaderNodeGroup').node_tree = data.node_groups["Nodes"]
        own.node_tree.nodes.new('ShaderNodeTexImage').image = data.images["Picture"]
        for material in (own, data.materials["Paint"]):
            data.objects["Cube"].data.materials.append(material)
        for block in (data.meshes["Shape"], data.curves["Wire"], data.lights["Bulb"]):
            add_object("Own", block)
        self.scene.camera.data, self.scene.world = data.cameras["View"], data.worlds["Sky"]
        instance = add_object("Instance", None)
        instance.instance_type, instance.instance_collection = 'COLLECTION', data.collections["Group"]
        self.scene.collection.objects.link(data.objects["Linked"])
        return names

    def test_missing_library(self):
        """Each line once, in the window and on the console."""
        path = output("library.blend")
        names = self.link_of_each_kind(path)
        blend = self.save("links")
        self.finite()
        self.assertFalse([line for line in report.lines if "library" in line])
        os.remove(path)
        code, text = run_blender(blend, '-E', 'PENUMBRA', '-o', output("linked_"), '-F', 'PNG', '-f', '1')
        self.assertEqual(code, 0, text)
        self.assertTrue(os.path.exists(output("linked_0001.png")), text)
        bpy.ops.wm.open_mainfile(filepath=blend)
        self.scene = bpy.context.scene
        self.finite()
        told = [line for line in report.lines if "is missing from the library '//library.blend'" in line]
        self.assertEqual(sorted(line[:line.index(':')] for line in told),
                         sorted(f"{kind} '{name}'" for kind, name in names.items()))
        for line in told:
            self.assertIn(line, text)

    def test_missing_library_of_an_override(self):
        path = output("library.blend")
        bpy.data.libraries.write(path, {add_cube("Linked", location=(1, 0, 1))})
        bpy.data.objects.remove(bpy.data.objects["Linked"])
        with bpy.data.libraries.load(path, link=True) as (_source, target):
            target.objects = ["Linked"]
        self.scene.collection.objects.link(target.objects[0])
        target.objects[0].override_create(remap_local_usages=True)
        blend = self.save("override")
        os.remove(path)
        bpy.ops.wm.open_mainfile(filepath=blend)
        self.scene = bpy.context.scene
        self.finite("object 'Linked': it is missing")

    def test_sizes(self):
        render = self.scene.render
        for width, height, percentage in ((1, 1, 25), (1, 10, 25), (8193, 4, 100)):
            with self.subTest(size=(width, height)):    # Blender takes 4 pixels at least, but a share of them
                render.resolution_x = math.ceil(100 * width / percentage)
                render.resolution_y = math.ceil(100 * height / percentage)
                render.resolution_percentage = percentage
                self.assertEqual(len(self.finite()), width * height)

    def test_names(self):
        """Each name in the passes of the lights and in the report: a loose vertex is no face, and is told by name."""
        names = "Würfel ☂", "two\nlines", "dot.001", "'quoted' \"twice\"", "x" * 63
        for number, name in enumerate(names):
            cube = add_cube(name, location=(number - 2, 0, 1), half=0.2)
            cube.data.materials.append(white_material(name))
            cube.data.vertices[0].co.x = math.nan
            add_light(name, 'POINT', location=(number - 2, 0, 2), energy=5)
            self.assertEqual(cube.name, name)
        self.layer.penumbra.use_pass_light_shadows = True
        picture = self.render()
        self.finite(*(f"'{name}'".replace('\n', ' ') for name in names))
        self.assertEqual(len(report.lines), len(names))
        self.assertFalse([line for line in report.lines if '\n' in line])
        lights = [ob.name for ob in bpy.data.objects if ob.type == 'LIGHT']
        passes = {channel.split('.Shadow.')[1].rsplit('.', 1)[0] for channel in picture if '.Shadow.' in channel}
        # A file's channel has the first 47 bytes of a light's name, later the first 56.
        length = max(map(len, passes))
        self.assertGreaterEqual(length, 47)
        self.assertEqual(sorted(passes), sorted(name[:length] for name in lights))

    def test_names_that_are_no_text(self):
        """Old files may hold bytes that are not UTF-8: on an object, a light, a material, an image and the world."""
        cube = bpy.data.objects["Cube"]
        cube.name = "Wrong1"
        cube.data.vertices[0].co.x = math.nan
        cube.data.materials[0] = material = bpy.data.materials.new("Wrong2")
        material.use_nodes = True
        glossy = material.node_tree.nodes.new('ShaderNodeBsdfGlossy')
        surface = next(node for node in material.node_tree.nodes if node.type == 'OUTPUT_MATERIAL')
        material.node_tree.links.new(glossy.outputs[0], surface.inputs['Surface'])
        texture = material.node_tree.nodes.new('ShaderNodeTexImage')
        texture.image = bpy.data.images.new("Wrong3", 4, 4)
        texture.image.source, texture.image.filepath = 'FILE', output("nosuch.png")
        material.node_tree.links.new(texture.outputs['Color'], glossy.inputs['Color'])
        for ob in (cube, add_light("Wrong4", 'AREA', scale=(0, 1, 1))):
            ob.data.name = ob.name
        world = add_world((1, 1, 1))
        world.name = "Wrong5"
        world.node_tree.nodes["Background"].inputs['Strength'].default_value = -1
        self.layer.penumbra.use_pass_light_shadows = True
        path = output("names.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path, compress=False)
        with open(path, 'r+b') as file:
            data = file.read()
            file.seek(0)
            file.write(data.replace(b'Wrong', b'Wr\xf6ng'))
        bpy.ops.wm.open_mainfile(filepath=path)
        self.scene = bpy.context.scene
        picture = self.finite(*(rf"{kind} 'Wr\xf6ng{number}'" for number, kind in
                                enumerate(("mesh", "material", "image", "light", "world"), 1)))
        self.assertGreater(max(picture), 0.1)

    def save_for_output(self):
        self.scene.render.resolution_x, self.scene.render.resolution_y = 64, 48
        return self.save("unwritable")

    def assert_not_written(self, blend, path, kind='PNG'):
        """Exit code, message, and what is there afterwards."""
        code, text = run_blender(blend, '-E', 'PENUMBRA', '-o', path, '-F', kind, '-f', '1')
        self.assertNotEqual(code, 0, text)
        self.assertRegex(text, r"(?i)error|cannot|could not|unable")
        self.assertNotRegex(text, r'penumbra/\w+\.py')   # no exception of ours

    def test_unwritable_outputs(self):
        """A file, or a device, where a folder should be."""
        blend = self.save_for_output()
        with open(output("file"), 'wb'):
            pass
        for path in (output("file") + '/frame_', '/dev/full/frame_'):
            self.assert_not_written(blend, path)

    def mount(self, *options):
        """A disk of 64 KiB in memory, as root can mount one; its folder."""
        folder = output("disk")
        os.makedirs(folder, exist_ok=True)
        done = subprocess.run(['mount', '-t', 'tmpfs', '-o', ','.join(('size=64k', *options)), 'tmpfs', folder],
                              stderr=subprocess.PIPE, check=False)
        if done.returncode:
            self.skipTest(f"no disk can be mounted here: {done.stderr.decode(errors='replace').strip()}")
        self.addCleanup(subprocess.run, ['umount', folder], check=True)
        return folder

    def test_read_only_folder(self):
        folder = self.mount('ro')
        self.assert_not_written(self.save_for_output(), folder + '/frame_')
        self.assertEqual(os.listdir(folder), [])

    def fill(self, folder, room):
        """Leaves as many bytes free."""
        with open(folder + '/filler', 'wb', buffering=0) as filler:
            with contextlib.suppress(OSError):
                while filler.write(bytes(4096)):
                    pass
            filler.truncate(filler.tell() - room)

    def test_full_disk_of_a_movie(self):
        """Full from the beginning, and after some frames."""
        set_movie(self.scene)
        self.scene.penumbra.samples = 4
        blend = self.save_for_output()
        folder = self.mount()
        for room in (0, 8192):
            with self.subTest(room=room):
                self.fill(folder, room)
                code, text = run_blender(blend, '-E', 'PENUMBRA', '-o', folder + '/movie_', '-s', '1', '-e', '40', '-a')
                self.assertNotEqual(code, 0, text)
                self.assertIn("movie_0001-0040.mp4", text)
                self.assertEqual(os.listdir(folder), ['filler'])

    def test_full_disk(self):
        """Nothing that looks like a picture is left; with room again the same Blender goes on."""
        blend = self.save_for_output()
        folder = self.mount()
        self.fill(folder, 0)
        for kind in ('PNG', 'JPEG', 'OPEN_EXR', 'TIFF'):
            with self.subTest(kind=kind):
                self.assert_not_written(blend, folder + '/frame_', kind)
                self.assertEqual(os.listdir(folder), ['filler'])
        self.scene.render.image_settings.file_format = 'PNG'
        failures = sys.modules[ADDON].output.failures
        self.addCleanup(failures.clear)     # else this Blender would end with status 1
        for has_extension, name in ((False, 'bare'), (True, 'here.png')):
            self.scene.render.use_file_extension, self.scene.render.filepath = has_extension, f'{folder}/{name}'
            with contextlib.suppress(RuntimeError):
                bpy.ops.render.render(write_still=True)
            self.assertEqual(os.listdir(folder), ['filler'])
        os.remove(folder + '/filler')
        bpy.ops.render.render(write_still=True)
        self.assertGreater(os.path.getsize(folder + '/here.png'), 100)

    def test_cancelled_and_restarted(self):
        """Ten renders cancelled at other moments; each is followed by one that is the same as before."""
        engine = sys.modules[ADDON].engine.PenumbraEngine
        penumbra = self.scene.penumbra
        before = self.finite()
        for number in range(10):
            asked = []

            def is_cancelled(_self):
                asked.append(1)
                self.assertLess(len(asked), number + 1000, "the cancel is ignored")  # the render would take hours
                return len(asked) > number
            with mock.patch.object(engine, 'is_cancelled', is_cancelled):
                penumbra.technique, penumbra.light_samples, penumbra.samples = 'REFERENCE', 64, 4096
                bpy.ops.render.render()
            self.assertGreater(len(asked), number)
            penumbra.technique, penumbra.samples = 'PCSS', 1
            self.assertEqual(self.finite(), before)

    def test_cancelled_while_exporting(self):
        """Before an object is read: many or large ones take long."""
        addon = sys.modules[ADDON]
        for _number in range(9):
            add_cube()
        made, make = [], addon.geometry.MeshStore.of

        def of(*arguments):
            made.append(1)
            return make(*arguments)
        with mock.patch.object(addon.engine.PenumbraEngine, 'is_cancelled', lambda _self: len(made) > 2), \
                mock.patch.object(addon.geometry.MeshStore, 'of', of):
            bpy.ops.render.render()
        self.assertEqual(len(made), 3)
        self.finite()

    def test_handler_edits_the_scene(self):
        """Objects and lights that come and go while frames are rendered."""
        def edit(scene, *_arguments):
            if bpy.data.objects.get("Guest"):
                bpy.data.objects.remove(bpy.data.objects["Guest"])
            else:
                add_cube("Guest", location=(1, 1, scene.frame_current), half=0.3)
        self.scene.frame_end = 4
        self.scene.render.filepath, self.scene.render.image_settings.file_format = output("edited_"), 'PNG'
        bpy.app.handlers.frame_change_pre.append(edit)
        self.addCleanup(lambda: bpy.app.handlers.frame_change_pre.remove(edit))
        bpy.ops.render.render(animation=True)
        self.assertTrue(os.path.exists(output("edited_0004.png")))

    def test_capture_without_a_name(self):
        with self.assertRaisesRegex(RuntimeError, "No file name"):
            bpy.ops.penumbra.capture(filepath="")

    def test_again_after_a_failure(self):
        self.scene.camera = None
        with self.assertRaises(RuntimeError):
            self.render()
        self.scene.camera = bpy.data.objects["Camera"]
        self.finite()
