# SPDX-License-Identifier: GPL-3.0-or-later
"""Images that change from frame to frame, and what is kept of those that do not."""

import os
import time
from unittest import mock

import bpy

from exr import read_exr
from harness import SceneTest, add_camera, add_plane, output, render_exr, write_image

from penumbra import export, images, report, textures


class TextureTest(SceneTest):
    """A plane that emits an image's colour fills the picture."""

    def setUp(self):
        super().setUp()
        self.scene.render.resolution_x = self.scene.render.resolution_y = 8
        plane = add_plane()
        plane.data.uv_layers.new(name="Map")
        add_camera(type='ORTHO', ortho_scale=2)
        material = bpy.data.materials.new("Test")
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        surface, emission, self.node = (tree.nodes.new('ShaderNode' + kind)
                                        for kind in ('OutputMaterial', 'Emission', 'TexImage'))
        tree.links.new(self.node.outputs['Color'], emission.inputs['Color'])
        tree.links.new(emission.outputs[0], surface.inputs['Surface'])
        plane.data.materials.append(material)
        textures.cache.clear()
        self.addCleanup(textures.cache.clear)

    def load(self, path):
        self.node.image = bpy.data.images.load(path, check_existing=False)
        self.node.image.colorspace_settings.name = 'Non-Color'
        return self.node.image

    def reds(self, count, handler=None):
        """The red of the frames of an animation; `handler` is called at each change of the frame."""
        self.scene.frame_start, self.scene.frame_end = 1, count
        render_exr(self.scene, output('first.exr'))     # sets the format
        self.scene.render.filepath = output('frame####.exr')
        if handler:
            bpy.app.handlers.frame_change_post.append(handler)
            self.addCleanup(bpy.app.handlers.frame_change_post.remove, handler)
        bpy.ops.render.render(animation=True)
        pictures = [read_exr(output(f'frame{frame:04d}.exr')) for frame in range(1, count + 1)]
        return [round(picture['ViewLayer.Combined.R'][2][27], 3) for picture in pictures]


class Animation(TextureTest):
    def test_sequence(self):
        for frame in (1, 2, 3):
            path = write_image(output(f'picture.{frame:04d}.png'), frame / 5)
        self.load(path).source = 'SEQUENCE'
        user = self.node.image_user
        user.frame_duration, user.use_auto_refresh = 3, True
        self.assertEqual(self.reds(5), [0.2, 0.4, 0.6, 0.6, 0.6])
        self.assertEqual([line for line in report.lines if "missing" in line], [])
        self.assertLessEqual(len(textures.cache._kept), 1)
        self.assertEqual({image.name for image in bpy.data.images} - {"Render Result"}, {self.node.image.name})

    def test_sequence_with_a_gap(self):
        for frame in (1, 3):
            self.load(write_image(output(f'gap.{frame:04d}.png'), frame / 5)).source = 'SEQUENCE'
        self.node.image_user.frame_duration, self.node.image_user.use_auto_refresh = 3, True
        self.assertEqual(self.reds(3), [0.2, 1.0, 0.6])
        self.scene.frame_set(2)
        with export.SceneExport(bpy.context.evaluated_depsgraph_get()) as exported:
            self.assertTrue(any("gap.0002.png" in line for line in exported.warnings), exported.warnings)

    def test_reloaded(self):
        """A handler writes the file anew and reloads it."""
        image = self.load(write_image(output('written.png'), 0.2))

        def reload(scene, *_):
            write_image(image.filepath, scene.frame_current / 5)
            image.reload()
        self.assertEqual(self.reds(3, reload), [0.2, 0.4, 0.6])

    def test_reloaded_later(self):
        """Other software wrote the file; a handler reloads it after the frame that was rendered with the old pixels."""
        image = self.load(write_image(output('later.png'), 0.2))

        def change(scene, *_):
            if scene.frame_current == 1:
                self.assertAlmostEqual(image.pixels[1], 0.6)    # in memory from now on
                write_image(image.filepath, 0.6)
            elif scene.frame_current == 2:
                image.reload()
        self.assertEqual(self.reds(2, change), [0.2, 0.6])

    def test_other_file(self):
        image = self.load(write_image(output('one.png'), 0.2))
        write_image(output('two.png'), 0.4)
        with mock.patch.object(textures, '_start', time.time() + 1000.0):
            self.assertEqual(self.reds(2, lambda scene, *_: setattr(
                image, 'filepath', output('one.png' if scene.frame_current == 1 else 'two.png'))), [0.2, 0.4])

    def test_packed(self):
        """A handler packs other content into the image."""
        image = self.load(write_image(output('packed.png'), 0.2))
        image.pack()
        os.remove(image.filepath)       # a reload would pack it again

        def pack(scene, *_):
            with open(write_image(output('content.png'), scene.frame_current / 5), 'rb') as file:
                content = file.read()
            image.pack(data=content, data_len=len(content))
            image.reload()
        self.assertEqual(self.reds(3, pack), [0.2, 0.4, 0.6])

    def test_painted(self):
        image = self.load(write_image(output('painted.png'), 0.2))
        self.assertEqual(self.reds(3, lambda scene, *_: image.pixels.foreach_set(
            [scene.frame_current / 5, 0.6, 0.2, 1.0] * 16)), [0.2, 0.4, 0.6])

    def test_only_what_may_differ_is_read(self):
        """Of a file that is as old as Blender nothing but its date is looked at."""
        image = self.load(write_image(output('old.png'), 0.2))
        with mock.patch.object(textures, '_start', time.time() + 1000.0), \
                mock.patch.object(images, 'read', wraps=images.read) as read:
            self.reds(4)
            self.assertEqual(read.call_count, 2)    # in the first render and in the animation
            os.utime(image.filepath, (1, 1))
            image.reload()
            self.reds(1)
            self.assertEqual(read.call_count, 4)


class Kinds(TextureTest):
    def lines(self):
        with export.SceneExport(bpy.context.evaluated_depsgraph_get()) as exported:
            return exported.warnings

    def test_movie(self):
        """Its first picture, and a line."""
        self.scene.frame_start, self.scene.frame_end = 1, 2
        settings = self.scene.render.image_settings
        if hasattr(settings, 'media_type'):
            settings.media_type = 'VIDEO'
        settings.file_format = 'FFMPEG'
        self.scene.render.ffmpeg.format, self.scene.render.ffmpeg.codec = 'MKV', 'FFV1'
        self.scene.render.resolution_x = self.scene.render.resolution_y = 64
        self.scene.render.filepath = output('movie.mkv')
        self.scene.view_settings.view_transform = 'Standard'
        self.load(write_image(output('film.png'), 0.5))
        bpy.ops.render.render(animation=True)
        self.load(output('movie.mkv')).colorspace_settings.name = 'sRGB'
        self.assertEqual(self.node.image.source, 'MOVIE')
        lines = self.lines()
        self.assertTrue(any("of a movie only the first picture" in line for line in lines), lines)
        red = self.render()['ViewLayer.Combined.R'][2]
        self.assertAlmostEqual(red[len(red) // 2], 0.5, delta=0.05)

    def test_projection(self):
        self.load(write_image(output('boxed.png'), 0.5))
        self.node.projection = 'BOX'
        self.assertTrue(any("material 'Test'" in line and "projection BOX" in line for line in self.lines()))
