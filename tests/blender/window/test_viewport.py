# SPDX-License-Identifier: GPL-3.0-or-later
"""The rendered viewport shows what F12 renders, and after every edit what a viewport opened afterwards would show."""

import bpy

from harness import add_cube, add_light, add_world, output, white_material, write_image
from window import ViewportTest, psnr, read_picture


class Picture(ViewportTest):
    def test_equals_still(self):
        """With as many samples; 8 bits and the rounding of half floats in Blender's viewport leave about 50 dB."""
        self.still_life()
        bpy.data.objects["Camera"].rotation_euler = 0.5, 0.1, 0.2
        bpy.data.objects["Camera"].location = 0, -4, 6
        self.scene.penumbra.samples = self.scene.penumbra.viewport_samples = 8
        self.scene.penumbra.shadow_map_size = 1024
        self.look_through_camera()
        shown = yield from self.shown("viewport")
        value = psnr(shown, read_picture(self.still("still")))
        print(f"viewport against still: {value:.1f} dB")
        self.assertGreaterEqual(value, 40.0)


class EditTest(ViewportTest):
    """After each edit the picture has changed, and equals that of a new engine bit by bit."""

    def setUp(self):
        super().setUp()
        self.scene.render.preview_pixel_size = '4'      # faster
        self.still_life()
        self.look()
        self.before = None

    def check(self, name):
        after = yield from self.shown(name)
        yield from self.start_anew()
        fresh = yield from self.shown(name + "-fresh")
        self.assertTrue(after == fresh, f"{name}: stale")
        if self.before:
            self.assertFalse(after == self.before, f"{name}: nothing happened")
        self.before = after

    def push_undo(self, name):
        with self.window():
            bpy.ops.ed.undo_push(message=name)


class Edits(EditTest):
    def test_objects(self):
        cube = bpy.data.objects["Cube"]
        yield from self.check("begin")
        cube.location.x += 1.0
        yield from self.check("move object")
        cube.data.vertices[7].co.z += 1.0
        cube.data.update()
        yield from self.check("edit mesh")
        bpy.data.lights["Key"].size = 2.0
        yield from self.check("lamp size")
        cube.hide_viewport = True
        yield from self.check("hide")
        cube.hide_viewport = False
        yield from self.check("unhide")
        cube.hide_set(True)
        yield from self.check("hide with the eye")
        cube.hide_set(False)
        cube.data.materials[0] = white_material("Red", (1.0, 0.0, 0.0))
        yield from self.check("material")
        self.scene.penumbra.technique = 'HARD'
        yield from self.check("technique")
        bpy.data.objects.remove(bpy.data.objects["Key"])
        yield from self.check("delete last lamp")

    def test_light_linking(self):
        if not hasattr(bpy.data.objects["Key"], 'light_linking'):
            self.skipTest("this Blender has no light linking")
        cube, linking = bpy.data.objects["Cube"], bpy.data.objects["Key"].light_linking
        yield from self.check("links-begin")
        linking.receiver_collection = bpy.data.collections.new("Receivers")     # while empty it changes nothing
        linking.receiver_collection.objects.link(cube)
        yield from self.check("links-cube")
        linking.receiver_collection.collection_objects[0].light_linking.link_state = 'EXCLUDE'
        yield from self.check("links-all-but-cube")
        linking.receiver_collection = None
        yield from self.check("links-gone")
        linking.blocker_collection = bpy.data.collections.new("Blockers")
        linking.blocker_collection.objects.link(cube)
        linking.blocker_collection.collection_objects[0].light_linking.link_state = 'EXCLUDE'
        yield from self.check("links-no-shadow")

    def test_undo(self):
        self.push_undo("begin")
        yield from self.check("undo-first")
        first = self.before
        bpy.data.objects["Cube"].location.x += 1.0
        bpy.data.objects["Cube"].data.vertices[7].co.z += 1.0
        self.push_undo("edit")
        yield from self.check("undo-second")
        second = self.before
        with self.in_viewport():
            bpy.ops.ed.undo()
        yield from self.check("undone")
        self.assertTrue(first == self.before)
        with self.in_viewport():
            bpy.ops.ed.redo()
        yield from self.check("redone")
        self.assertTrue(second == self.before)

    def test_undo_burst(self):
        """Many steps back without a drawing between them."""
        self.push_undo("begin")
        yield from self.check("undo-burst-begin")
        first = self.before
        for _ in range(12):
            cube = bpy.data.objects["Cube"]
            cube.location.x += 0.1
            cube.data.vertices[7].co.z += 0.1
            self.push_undo("move")
            yield 'draw'
        yield from self.check("undo-burst-moved")
        with self.in_viewport():
            for _ in range(12):
                bpy.ops.ed.undo()
        yield from self.check("undo-burst-undone")
        self.assertTrue(first == self.before)

    def test_shading_switch(self):
        """What happened while the viewport was drawn by another engine."""
        yield from self.check("rendered")
        for shading in ('SOLID', 'WIREFRAME'):
            self.space().shading.type = shading
            yield from self.settle()
            bpy.data.objects["Cube"].location.x += 0.3
            bpy.data.lights["Key"].size += 0.2
            self.space().shading.type = 'RENDERED'
            yield from self.check(f"after {shading}")

    def test_frame_change(self):
        cube = bpy.data.objects["Cube"]
        cube.keyframe_insert('location', frame=1)
        cube.location.x += 2.0
        cube.keyframe_insert('location', frame=20)
        cube.shape_key_add(name="Basis")
        key = cube.shape_key_add(name="Tall")
        key.data[7].co.z += 1.0
        key.value = 0.0
        key.keyframe_insert('value', frame=1)
        key.value = 1.0
        key.keyframe_insert('value', frame=20)
        self.scene.frame_set(1)
        yield from self.check("frame 1")
        self.scene.frame_set(20)
        yield from self.check("frame 20")

    def test_collection(self):
        collection = bpy.data.collections.new("Group")
        self.scene.collection.children.link(collection)
        cube = bpy.data.objects["Cube"]
        collection.objects.link(cube)
        self.scene.collection.objects.unlink(cube)
        yield from self.check("linked")
        bpy.context.view_layer.layer_collection.children["Group"].exclude = True
        yield from self.check("excluded")
        bpy.context.view_layer.layer_collection.children["Group"].exclude = False
        yield from self.check("included")

    def test_new_file(self):
        yield from self.shown("old file")
        with self.window():
            bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        bpy.context.scene.render.engine = 'PENUMBRA'
        self.show()
        add_cube()
        add_light("Sun", 'SUN', energy=2.0)
        self.look()
        self.before = None
        yield from self.check("new file")

    def test_edit_mode(self):
        cube = bpy.data.objects["Cube"]
        bpy.context.view_layer.objects.active = cube
        cube.select_set(True)
        yield from self.check("object mode")
        with self.in_viewport():
            bpy.ops.object.mode_set(mode='EDIT')
            bpy.ops.mesh.select_all(action='SELECT')
            bpy.ops.transform.translate(value=(0.0, 0.0, 1.0))
        yield from self.check("moved in edit mode")
        with self.in_viewport():
            bpy.ops.object.mode_set(mode='OBJECT')
        self.assertTrue(self.before == (yield from self.shown("object mode again")))


class Textures(EditTest):
    """Images that change while a viewport shows them."""

    def setUp(self):
        super().setUp()
        material = white_material("Picture")
        tree = material.node_tree
        self.node = tree.nodes.new('ShaderNodeTexImage')
        diffuse = next(node for node in tree.nodes if node.type == 'BSDF_DIFFUSE')
        tree.links.new(self.node.outputs['Color'], diffuse.inputs['Color'])
        floor = bpy.data.objects["Floor"]
        floor.data.uv_layers.new(name="Map")
        floor.data.materials[0] = material

    def test_painting(self):
        image = self.node.image = bpy.data.images.new("Painted", 4, 4)
        for red in (0.2, 0.8):
            image.pixels.foreach_set([red, 0.6, 0.2, 1.0] * 16)
            image.update()
            yield from self.check(f"painted {red}")

    def test_painted_world(self):
        world = add_world((0.0, 0.0, 0.0))
        node = world.node_tree.nodes.new('ShaderNodeTexEnvironment')
        image = node.image = bpy.data.images.new("Sky", 8, 4)
        background = next(each for each in world.node_tree.nodes if each.type == 'BACKGROUND')
        world.node_tree.links.new(node.outputs['Color'], background.inputs['Color'])
        for red in (0.2, 0.8):
            image.pixels.foreach_set([red, 0.6, 0.2, 1.0] * 32)
            image.update()
            yield from self.check(f"painted world {red}")

    def test_reload(self):
        path = write_image(output("reloaded.png"), 0.2)
        image = self.node.image = bpy.data.images.load(path)
        yield from self.check("loaded")
        write_image(path, 0.8)
        image.reload()
        yield from self.check("reloaded")

    def test_sequence(self):
        """Loading a picture does not make the viewport export again and again."""
        for frame in (1, 2, 3):
            path = write_image(output(f"sequence.{frame:04d}.png"), frame / 4)
        self.node.image = bpy.data.images.load(path)
        self.node.image.source = 'SEQUENCE'
        self.node.image_user.frame_duration, self.node.image_user.use_auto_refresh = 3, True
        for frame in (1, 2, 3):
            self.scene.frame_set(frame)
            yield from self.check(f"sequence {frame}")
