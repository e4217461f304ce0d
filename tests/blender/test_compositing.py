# SPDX-License-Identifier: GPL-3.0-or-later
"""Composite Soft Shadows: the render of another engine times the Shadow pass, and its removal."""

import bpy

from composite import CompositeMixin
from harness import SceneTest

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
