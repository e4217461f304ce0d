# SPDX-License-Identifier: GPL-3.0-or-later
"""Composite Soft Shadows: the render of another engine times the Shadow pass, and its removal."""

import bpy

from composite import CompositeMixin
from harness import SceneTest, add_cube

from penumbra import compat, compositing


class Composite(CompositeMixin, SceneTest):
    def setUp(self):
        super().setUp()
        self.still_life()
        self.scene.cycles.samples = 4
        self.scene.cycles.use_denoising = False

    def test_cycles(self):
        self.check_composite('CYCLES')

    def test_penumbra_needs_none(self):
        with self.assertRaisesRegex(RuntimeError, "already"):
            bpy.ops.penumbra.composite()

    def test_twice(self):
        self.scene.render.engine = 'CYCLES'
        bpy.ops.penumbra.composite()
        with self.assertRaisesRegex(RuntimeError, "already"):
            bpy.ops.penumbra.composite()

    def test_nothing_else_changes(self):
        """A tree of the user's own is the same again afterwards, and no datablock remains."""
        self.scene.render.engine = 'CYCLES'
        tree, _is_new = compat.ensure_compositor_tree(self.scene)
        target = compat.compositor_outputs(tree)[0]
        source = tree.nodes.new('CompositorNodeRLayers')
        blur = tree.nodes.new('CompositorNodeBlur')
        tree.links.new(source.outputs['Image'], blur.inputs[0])
        tree.links.new(blur.outputs[0], target)
        before = self.state(tree)
        bpy.ops.penumbra.composite()
        self.assertNotEqual(self.state(tree), before)
        self.assertEqual(compositing.shadow_scene(self.scene).render.engine, 'PENUMBRA')
        bpy.ops.penumbra.composite_remove()
        self.assertEqual(self.state(tree), before)

    def test_output_removed(self):
        """An output node that had to be made goes with the others."""
        self.scene.render.engine = 'CYCLES'
        tree, _is_new = compat.ensure_compositor_tree(self.scene)
        tree.nodes.remove(compat.compositor_outputs(tree)[0].node)
        before = self.state(tree)
        bpy.ops.penumbra.composite()
        bpy.ops.penumbra.composite_remove()
        self.assertEqual(self.state(tree), before)

    def test_unlinked(self):
        """Links that the user took away in the meantime are not missed."""
        self.scene.render.engine = 'CYCLES'
        bpy.ops.penumbra.composite()
        tree = compat.compositor_tree(self.scene)
        tree.links.clear()
        self.assertEqual(bpy.ops.penumbra.composite_remove(), {'FINISHED'})
        self.assertFalse(compositing.is_set_up(self.scene))

    def test_compositing_off(self):
        """Where the compositor is not part of the render there would be no shadows, without a word."""
        self.scene.render.engine = 'CYCLES'
        self.scene.render.use_compositing = False
        with self.assertRaisesRegex(RuntimeError, "Post Processing"):
            bpy.ops.penumbra.composite()

    def state(self, tree):
        links = sorted((link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier)
                       for link in tree.links)
        collections = {name: sorted(item.name for item in getattr(bpy.data, name))
                       for name in ('scenes', 'objects', 'meshes', 'lights', 'materials', 'node_groups', 'collections')}
        return sorted(node.name for node in tree.nodes), links, collections

    def test_follows_scene(self):
        """The copy takes camera, size and settings from its scene at every render."""
        self.scene.render.engine = 'CYCLES'
        bpy.ops.penumbra.composite()
        self.scene.render.resolution_x, self.scene.render.resolution_y = 40, 30
        self.scene.penumbra.technique = 'HARD'
        self.scene.frame_current = 7
        self.combined("smaller")
        copy = compositing.shadow_scene(self.scene)
        self.assertEqual((copy.render.resolution_x, copy.penumbra.technique, copy.frame_current), (40, 'HARD', 7))

    def check_follows(self):
        """The picture is that of a copy made now."""
        followed = self.combined("followed")
        bpy.ops.penumbra.composite_remove()
        bpy.ops.penumbra.composite()
        # Cycles' own noise is the same.
        self.assertEqual(self.combined("anew"), followed)

    def test_follows_objects(self):
        """Objects and collections that come after the copy cast shadows too."""
        self.scene.render.engine = 'CYCLES'
        bpy.ops.penumbra.composite()
        before = self.combined("before")
        added = add_cube("Added", location=(-1.5, 0, 0.5))
        self.assertNotEqual(self.combined("added"), before)
        self.check_follows()
        collection = bpy.data.collections.new("Group")
        self.scene.collection.children.link(collection)
        collection.objects.link(added)
        self.scene.collection.objects.unlink(added)
        self.check_follows()
        self.layer.layer_collection.children["Group"].exclude = True
        self.check_follows()

    def test_follows_simplify(self):
        self.scene.render.engine = 'CYCLES'
        bpy.data.objects["Cube"].modifiers.new("Smooth", 'SUBSURF').render_levels = 3
        bpy.ops.penumbra.composite()
        self.scene.render.use_simplify, self.scene.render.simplify_subdivision_render = True, 0
        self.check_follows()

    def test_copy_deleted(self):
        """Its counterpart still mends what is left."""
        self.scene.render.engine = 'CYCLES'
        alone = self.combined("alone")
        bpy.ops.penumbra.composite()
        bpy.data.scenes.remove(compositing.shadow_scene(self.scene))
        self.assertIsNone(compositing.shadow_scene(self.scene))
        bpy.ops.penumbra.composite_remove()
        self.assertEqual(self.combined("mended"), alone)
        self.assertEqual(bpy.ops.penumbra.composite(), {'FINISHED'})

    def test_copied_scene(self):
        """Both have shadows, and one keeps them when the other's are removed."""
        self.scene.render.engine = 'CYCLES'
        bpy.ops.penumbra.composite()
        tree_is_shared = compat.compositor_tree(self.scene.copy()) == compat.compositor_tree(self.scene)
        other = next(scene for scene in bpy.data.scenes if scene != self.scene and compositing.is_set_up(scene))
        bpy.ops.penumbra.composite_remove()
        self.assertFalse(compositing.is_set_up(self.scene))
        self.assertEqual(compositing.shadow_scene(other) is None, tree_is_shared)

    def test_shared_nodes(self):
        """A node group of several scenes is not changed."""
        self.scene.render.engine = 'CYCLES'
        tree, _is_new = compat.ensure_compositor_tree(self.scene)
        other = bpy.data.scenes.new("Other")
        if not hasattr(other, 'compositing_node_group'):
            self.skipTest("before Blender 5 each scene has nodes of its own")
        other.compositing_node_group = tree
        with self.assertRaisesRegex(RuntimeError, "single user"):
            bpy.ops.penumbra.composite()

    def test_idle_nodes(self):
        """Nodes that are off do not begin to work."""
        self.scene.render.engine = 'CYCLES'
        if hasattr(self.scene, 'compositing_node_group'):
            self.skipTest("since Blender 5 a scene's nodes are never off")
        tree, _is_new = compat.ensure_compositor_tree(self.scene)
        invert = tree.nodes.new('CompositorNodeInvert')
        invert.name = "Negative"    # its own differs between versions
        self.scene.use_nodes = False
        with self.assertRaisesRegex(RuntimeError, "'Negative'.*Use Nodes"):
            bpy.ops.penumbra.composite()
        invert.mute = True
        bpy.ops.penumbra.composite()
        bpy.ops.penumbra.composite_remove()
        self.assertFalse(self.scene.use_nodes)

    def test_single_layer(self):
        """Blender takes the other scene's last picture then, or black."""
        self.scene.render.engine = 'CYCLES'
        self.scene.render.use_single_layer = True
        with self.assertRaisesRegex(RuntimeError, "Single Layer"):
            bpy.ops.penumbra.composite()

    def test_view_layers(self):
        """The copy renders one, whose shadows count."""
        self.scene.render.engine = 'CYCLES'
        self.scene.view_layers.new("Second")
        bpy.ops.penumbra.composite()
        self.assertEqual([layer.name for layer in compositing.shadow_scene(self.scene).view_layers], ["ViewLayer"])
