# SPDX-License-Identifier: GPL-3.0-or-later
"""What nobody should have in a scene: a finite picture and a line that names the object, or an error."""

import math
import os

import bpy

from harness import (SceneTest, add_camera, add_cube, add_light, add_mesh, add_plane, output, run_blender,
                     white_material)

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

    def test_missing_library(self):
        path = output("library.blend")
        bpy.data.libraries.write(path, {add_cube("Linked")})
        with bpy.data.libraries.load(path, link=True) as (_source, target):
            target.objects = ["Linked"]
        self.scene.collection.objects.link(target.objects[0])
        blend = self.save("links")
        os.remove(path)
        code, text = run_blender(blend, '-E', 'PENUMBRA', '-o', output("linked_"), '-F', 'PNG', '-f', '1')
        self.assertEqual(code, 0, text)
        self.assertTrue(os.path.exists(output("linked_0001.png")), text)

    def test_sizes(self):
        render = self.scene.render
        for width, height, percentage in ((1, 1, 25), (1, 10, 25), (8193, 4, 100)):
            with self.subTest(size=(width, height)):    # Blender takes 4 pixels at least, but a share of them
                render.resolution_x, render.resolution_y = (math.ceil(100 * side / percentage) for side in (width, height))
                render.resolution_percentage = percentage
                self.assertEqual(len(self.finite()), width * height)

    def test_names(self):
        for number, name in enumerate(("Würfel ☂", "two\nlines", "dot.001", "'quoted' \"twice\"", "x" * 63)):
            cube = add_cube(name, location=(number - 2, 0, 1), half=0.2)
            cube.data.materials.append(white_material(name))
            add_light(name, 'POINT', location=(number - 2, 0, 2), energy=5)
        self.layer.penumbra.use_pass_light_shadows = True
        self.finite()

    def test_unwritable_outputs(self):
        """As root every folder is writable: a file stands where a folder should be, and a disk that is full."""
        blend = self.save("unwritable")
        with open(output("file"), 'wb'):
            pass
        for path in (output("file") + '/frame_', '/dev/full/frame_'):
            code, text = run_blender(blend, '-E', 'PENUMBRA', '-o', path, '-F', 'PNG', '-f', '1')
            self.assertNotEqual(code, 0, text)
            self.assertNotRegex(text, r'penumbra/\w+\.py')   # no exception of ours

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

    def test_again_after_a_failure(self):
        self.scene.camera = None
        with self.assertRaises(RuntimeError):
            self.render()
        self.scene.camera = bpy.data.objects["Camera"]
        self.finite()
