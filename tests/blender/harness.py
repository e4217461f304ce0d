# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes, renders and pictures for the tests."""

import os
import subprocess
import unittest
from array import array

import bpy

from exr import read_exr

OUTPUT = os.environ['TEST_OUTPUT']
ADDON = os.environ['TEST_ADDON']


def output(name):
    return os.path.join(OUTPUT, name)


def white_material(name="White", color=(1.0, 1.0, 1.0)):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    surface = tree.nodes.new('ShaderNodeOutputMaterial')
    diffuse = tree.nodes.new('ShaderNodeBsdfDiffuse')
    diffuse.inputs['Color'].default_value = *color, 1.0
    tree.links.new(diffuse.outputs['BSDF'], surface.inputs['Surface'])
    return material


def add_object(name, data, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)):
    ob = bpy.data.objects.new(name, data)
    ob.location, ob.rotation_euler, ob.scale = location, rotation, scale
    bpy.context.scene.collection.objects.link(ob)
    return ob


def add_mesh(name, vertices, faces, **place):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    return add_object(name, mesh, **place)


def add_plane(name="Floor", half=4.0, **place):
    corners = [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)]
    return add_mesh(name, corners, [(0, 1, 2, 3)], **place)


def add_cube(name="Cube", half=0.5, **place):
    vertices = [(x, y, z) for z in (-half, half) for y in (-half, half) for x in (-half, half)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return add_mesh(name, vertices, faces, **place)


def add_light(name, kind, location=(0, 0, 3), rotation=(0, 0, 0), scale=(1, 1, 1), energy=100.0, **settings):
    light = bpy.data.lights.new(name, kind)
    light.energy = energy
    for key, value in settings.items():
        setattr(light, key, value)
    return add_object(name, light, location, rotation, scale)


def add_camera(location=(0, 0, 10), rotation=(0, 0, 0), **settings):
    camera = bpy.data.cameras.new("Camera")
    for key, value in settings.items():
        setattr(camera, key, value)
    ob = add_object("Camera", camera, location, rotation)
    bpy.context.scene.camera = ob
    return ob


def add_world(color):
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == 'BACKGROUND')
    background.inputs['Color'].default_value = *color, 1.0
    bpy.context.scene.world = world
    return world


def eevee():
    """Identifier of EEVEE, which had another one while there were two."""
    return 'BLENDER_EEVEE_NEXT' if (4, 2) <= bpy.app.version < (5, 0) else 'BLENDER_EEVEE'


def turn_off_eevee_shadows(scene):
    """EEVEE's own, but not ours: in 3.4 the lamps' shadow maps begin behind everything."""
    if hasattr(scene.eevee, 'use_shadows'):
        scene.eevee.use_shadows = False
        return
    for light in bpy.data.lights:
        light.shadow_buffer_clip_start = 1000.0


def read_byte_image(path):
    """(width, height, RGBA floats as stored, rows bottom-up)."""
    image = bpy.data.images.load(path, check_existing=False)
    pixels = array('f', bytes(4 * len(image.pixels)))
    image.pixels.foreach_get(pixels)
    size = tuple(image.size)
    bpy.data.images.remove(image)
    return *size, pixels


def set_movie(scene):
    """Output to a movie without loss."""
    settings = scene.render.image_settings
    if hasattr(settings, 'media_type'):
        settings.media_type = 'VIDEO'
    settings.file_format = 'FFMPEG'
    movie = scene.render.ffmpeg
    movie.format, movie.codec, movie.constant_rate_factor = 'MPEG4', 'H264', 'LOSSLESS'


def render_exr(scene, path):
    """Renders the frame; the channels of the multilayer EXR it wrote."""
    settings = scene.render.image_settings
    if hasattr(settings, 'media_type'):
        settings.media_type = 'MULTI_LAYER_IMAGE'
    settings.file_format = 'OPEN_EXR_MULTILAYER'
    settings.color_depth = '32'
    settings.exr_codec = 'NONE'
    if hasattr(settings, 'use_exr_interleave'):
        settings.use_exr_interleave = True  # else one part per pass
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True, scene=scene.name)
    return read_exr(path)


class SceneTest(unittest.TestCase):
    """Starts from an empty scene for PENUMBRA with a small picture and 32-bit EXR output."""

    def setUp(self):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        self.scene = bpy.context.scene
        render = self.scene.render
        render.engine = 'PENUMBRA'
        render.resolution_x, render.resolution_y = 64, 48
        render.resolution_percentage = 100
        self.scene.penumbra.samples = 1
        self.layer = self.scene.view_layers[0]

    def still_life(self):
        """A cube over a floor under one area light, seen from above."""
        material = white_material()
        for ob in (add_plane(), add_cube(location=(0, 0, 0.5))):
            ob.data.materials.append(material)
        add_light("Key", 'AREA', location=(2, 0, 3), rotation=(0, 0.6, 0), size=0.5)
        add_camera(location=(0, 0, 8))

    def render(self, name="picture"):
        """Renders the frame and returns the channels of a multilayer EXR: name -> (width, height, floats)."""
        return render_exr(self.scene, output(name + '.exr'))

    def capture(self, name="scene"):
        path = output(name + '.pnb')
        self.assertEqual(bpy.ops.penumbra.capture(filepath=path), {'FINISHED'})
        return path

    def save(self, name="scene"):
        path = output(name + '.blend')
        bpy.ops.wm.save_as_mainfile(filepath=path)
        return path


class CyclesTest(SceneTest):
    """Renders the same scene with Cycles of the running Blender, light straight from the lamps only."""

    def setUp(self):
        super().setUp()
        self.scene.world = None
        cycles = self.scene.cycles
        cycles.max_bounces = 0
        cycles.samples = 1024
        cycles.use_adaptive_sampling = cycles.use_denoising = False
        cycles.light_sampling_threshold = 0.0
        cycles.filter_width = self.scene.render.filter_size = 1.0
        self.scene.penumbra.samples = 64

    def both(self):
        """The pictures of Cycles and of ours."""
        pictures = []
        for engine in ('CYCLES', 'PENUMBRA'):
            self.scene.render.engine = engine
            pictures.append(self.render(engine))
        return pictures


def blender_command(*arguments):
    """A fresh Blender with the add-on."""
    return [bpy.app.binary_path, '-b', '--factory-startup', '--addons', ADDON, *arguments]


def run_blender(*arguments, environment=None):
    """Runs one; (exit code, everything it printed)."""
    done = subprocess.run(blender_command(*arguments), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300,
                          check=False, env={**os.environ, **(environment or {})})
    return done.returncode, done.stdout.decode(errors='replace')


def write_image(path, red):
    """A PNG file of one colour, of bytes that are data. Returns the path."""
    image = bpy.data.images.new("Written", 4, 4)
    image.pixels.foreach_set([red, 0.6, 0.2, 1.0] * 16)
    image.filepath_raw, image.file_format = path, 'PNG'
    image.save()
    bpy.data.images.remove(image)
    return path
