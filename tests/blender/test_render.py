# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures: sizes, passes, transparency, errors."""

import os

import bpy

from harness import (ADDON, SceneTest, add_camera, add_cube, add_light, add_object, add_plane, add_world, output,
                     read_byte_image, white_material)

from penumbra import report, settings as penumbra_settings


def channels_by_pass(picture):
    """Pass name -> channel letters, of one view layer."""
    found = {}
    for name in picture:
        _layer, *parts, channel = name.split('.')
        found.setdefault('.'.join(parts), set()).add(channel)
    return found


def resident_bytes():
    with open('/proc/self/statm', encoding='ascii') as file:
        return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE')


class Sizes(SceneTest):
    def setUp(self):
        super().setUp()
        self.still_life()

    def size(self):
        width, height, _pixels = self.render()['ViewLayer.Combined.R']
        return width, height

    def test_full_percentage_and_one_pixel(self):
        render = self.scene.render
        self.assertEqual(self.size(), (64, 48))
        render.resolution_percentage = 50
        self.assertEqual(self.size(), (32, 24))
        render.resolution_percentage = 100
        render.resolution_x, render.resolution_y = 37, 51
        self.assertEqual(self.size(), (37, 51))

    def test_border(self):
        """A cropped picture is the same part of the full one, whatever the fractions."""
        render = self.scene.render
        render.resolution_x, render.resolution_y = 71, 47
        full = self.render("full")['ViewLayer.Combined.R']
        render.use_border = render.use_crop_to_border = True
        for left, right, bottom, top in ((0.3, 0.8, 0.1, 0.77), (0.25, 0.5, 0.0, 1.0), (0.7, 0.99, 0.33, 0.36)):
            with self.subTest(border=(left, right, bottom, top)):
                render.border_min_x, render.border_max_x = left, right
                render.border_min_y, render.border_max_y = bottom, top
                x, y, width, height = penumbra_settings.border(render, 71, 47)
                part = self.render("part")['ViewLayer.Combined.R']
                self.assertEqual(part[:2], (width, height))
                expected = [full[2][(y + row) * 71 + x + column] for row in range(height) for column in range(width)]
                self.assertEqual(list(part[2]), expected)

    def test_border_without_crop(self):
        render = self.scene.render
        full = self.render("full")['ViewLayer.Combined.G']
        render.use_border = True
        render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.25, 0.75
        x, y, width, height = penumbra_settings.border(render, 64, 48)
        part = self.render("part")['ViewLayer.Combined.G']
        self.assertEqual(part[:2], (64, 48))
        for row in range(48):
            for column in range(64):
                inside = x <= column < x + width and y <= row < y + height
                self.assertEqual(part[2][row * 64 + column], full[2][row * 64 + column] if inside else 0.0)


class Passes(SceneTest):
    def setUp(self):
        super().setUp()
        self.still_life()

    def test_only_combined(self):
        self.layer.use_pass_z = False
        self.assertEqual(channels_by_pass(self.render()), {'Combined': set('RGBA')})

    def test_all(self):
        add_light("Fill.001", 'POINT', location=(-2, 1, 3), shadow_soft_size=0.1)
        hidden = add_light("Off", 'POINT')
        hidden.hide_render = True
        layer = self.layer
        layer.use_pass_z = layer.use_pass_normal = layer.use_pass_shadow = True
        layer.penumbra.use_pass_light_shadows = True
        picture = self.render()
        self.assertEqual(channels_by_pass(picture), {
            'Combined': set('RGBA'), 'Depth': set('Z'), 'Normal': set('XYZ'), 'Shadow': set('RGB'),
            'Shadow.Key': set('RGB'), 'Shadow.Fill.001': set('RGB'), 'Shadow.Off': set('RGB')})
        center = 24 * 64 + 32
        self.assertAlmostEqual(picture['ViewLayer.Depth.Z'][2][center], 7.0, delta=1e-4)
        self.assertAlmostEqual(picture['ViewLayer.Normal.Z'][2][center], 1.0, delta=1e-3)
        self.assertEqual(picture['ViewLayer.Combined.A'][2][center], 1.0)
        self.assertEqual(set(picture['ViewLayer.Shadow.Off.R'][2]), {1.0})
        for name in ('Shadow', 'Shadow.Key', 'Shadow.Fill.001'):
            values = picture[f'ViewLayer.{name}.R'][2]
            self.assertAlmostEqual(values[center], 1.0, delta=0.01)
            self.assertLess(min(values), 0.2 if name != 'Shadow' else 0.9)
            self.assertLessEqual(max(values), 1.0)
            self.assertGreaterEqual(min(values), 0.0)

    def test_passes_fit_together(self):
        """Without ambient light and with one light: what is shadowed is dark."""
        self.layer.use_pass_shadow = True
        self.layer.penumbra.use_pass_light_shadows = True
        picture = self.render()
        for both, key in zip(picture['ViewLayer.Shadow.R'][2], picture['ViewLayer.Shadow.Key.R'][2]):
            self.assertAlmostEqual(both, key, delta=1e-6)  # one is a quotient, the other was never multiplied
        dark = [color for color, shadow in zip(picture['ViewLayer.Combined.R'][2], picture['ViewLayer.Shadow.R'][2])
                if shadow == 0.0]
        self.assertGreater(len(dark), 20)
        self.assertEqual(max(dark), 0.0)

    def add_bulb(self, x):
        return add_light("Bulb", 'POINT', location=(x, 0, 3), shadow_soft_size=0.1, energy=30)

    def instance(self, name, ob, **place):
        """An instance of a collection of the object, which is only seen through it."""
        collection = bpy.data.collections.new(name)
        for user in list(ob.users_collection):
            user.objects.unlink(ob)
        collection.objects.link(ob)
        empty = add_object(name, None, **place)
        empty.instance_type, empty.instance_collection = 'COLLECTION', collection
        return empty

    def light_passes(self):
        """Channel R of the pass of each light."""
        self.layer.penumbra.use_pass_light_shadows = True
        picture = self.render()
        return {name.split('.', 2)[2].removesuffix('.R'): list(picture[name][2]) for name in picture
                if 'Shadow.' in name and name.endswith('.R')}

    def test_lights_of_instances(self):
        """Each instance of a light has a pass, as a light at its place has: one in a collection, one in two."""
        lamps = [self.add_bulb(x) for x in (-1.5, 1.5)]
        expected = self.light_passes()
        self.assertEqual(sorted(expected), ['Bulb', 'Bulb.001', 'Key'])
        for lamp in lamps:
            bpy.data.objects.remove(lamp)
        inner = self.instance("Lamp", self.add_bulb(0), location=(-1, 0, 0))
        other = add_object("Other", None, location=(1.5, 0, 0))
        other.instance_type, other.instance_collection = 'COLLECTION', inner.instance_collection
        self.instance("Group", inner, location=(-0.5, 0, 0))
        actual = self.light_passes()
        self.assertEqual(sorted(actual), sorted(expected))
        self.assertEqual(sorted(actual.values()), sorted(expected.values()))
        self.assertFalse([line for line in report.lines if "no pass" in line])

    def test_light_without_pass(self):
        """What only the dependency graph knows has none, and says so: a light on each corner of its parent."""
        parent = add_plane("Lamps", half=1.5, location=(0, 0, 1))
        parent.instance_type = 'VERTS'
        parent.show_instancer_for_render = False
        self.add_bulb(0).parent = parent
        self.assertEqual(sorted(self.light_passes()), ['Bulb', 'Key'])
        for number in (1, 2, 3):
            start = f"light 'Bulb.00{number}': its shadow has no pass"
            self.assertEqual(len([line for line in report.lines if line.startswith(start)]), 1)

    def test_two_view_layers(self):
        other = self.scene.view_layers.new("Other")
        other.use_pass_z = True
        self.layer.use_pass_z = False
        other.layer_collection.exclude = False
        picture = self.render()
        self.assertEqual({name for name in picture if 'Depth' in name}, {'Other.Depth.Z'})
        self.assertEqual(picture['Other.Combined.R'], picture['ViewLayer.Combined.R'])

    def test_material_override(self):
        self.layer.material_override = white_material("Red", (1, 0, 0))
        picture = self.render()
        self.assertGreater(max(picture['ViewLayer.Combined.R'][2]), 0.1)
        self.assertEqual(max(picture['ViewLayer.Combined.G'][2]), 0.0)


class Film(SceneTest):
    def picture(self, transparent):
        add_cube()
        add_light("Sun", 'SUN', energy=3)
        add_camera(location=(0, 0, 5))
        add_world((0.25, 0.5, 0.75))
        self.scene.render.film_transparent = transparent
        picture = self.render()
        return [[picture['ViewLayer.Combined.' + channel][2][index] for channel in 'RGBA'] for index in
                (0, 24 * 64 + 32)]

    def test_world_behind(self):
        corner, center = self.picture(False)
        self.assertEqual(corner, [0.25, 0.5, 0.75, 1.0])
        self.assertEqual(center[3], 1.0)

    def test_transparent(self):
        corner, center = self.picture(True)
        self.assertEqual(corner, [0.0, 0.0, 0.0, 0.0])
        self.assertEqual(center[3], 1.0)
        self.assertGreater(center[0], 0.1)


class Textures(SceneTest):
    def floor(self, image, use_alpha=False):
        material = bpy.data.materials.new("Textured")
        material.use_nodes = True
        tree = material.node_tree
        picture = tree.nodes.new('ShaderNodeTexImage')
        picture.image = image
        shader = next(node for node in tree.nodes if node.type == 'BSDF_PRINCIPLED')
        shader.inputs['Base Color'].default_value = 1, 1, 1, 1
        tree.links.new(picture.outputs['Alpha' if use_alpha else 'Color'],
                       shader.inputs['Alpha' if use_alpha else 'Base Color'])
        floor = add_plane(half=2)
        layer = floor.data.uv_layers.new(name="Map")
        for corner, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
            corner.uv = uv
        floor.data.materials.append(material)
        add_light("Sun", 'SUN', energy=3.14159265, angle=0)
        add_camera(type='ORTHO', ortho_scale=4)
        self.scene.render.resolution_x = self.scene.render.resolution_y = 32

    def quarters(self, picture, channel='R'):
        """Centres of lower left, lower right, upper left, upper right."""
        values = picture['ViewLayer.Combined.' + channel][2]
        return [values[y * 32 + x] for y in (8, 24) for x in (8, 24)]

    def image(self, values, **settings):
        """Four quarters of 16 x 16 texels."""
        image = bpy.data.images.new("Quarters", 32, 32, alpha=True, **settings)
        pixels = []
        for y in range(32):
            for x in range(32):
                pixels.extend(values[2 * (y // 16) + x // 16])
        image.pixels.foreach_set(pixels)
        image.update()
        return image

    def test_srgb_colour_and_orientation(self):
        self.floor(self.image([(0, 0, 0, 1), (0.5, 0, 0, 1), (0.75, 0, 0, 1), (1, 0, 0, 1)]))
        # 128 / 255 and 191 / 255 decoded from sRGB; a byte image rounds to them.
        for value, expected in zip(self.quarters(self.render()), (0.0, 0.2158, 0.5210, 1.0)):
            self.assertAlmostEqual(value, expected, delta=0.004)

    def test_non_color_and_float(self):
        image = self.image([(0, 0, 0, 1), (0.25, 0, 0, 1), (0.5, 0, 0, 1), (1, 0, 0, 1)], float_buffer=True)
        self.floor(image)
        for value, expected in zip(self.quarters(self.render()), (0.0, 0.25, 0.5, 1.0)):
            self.assertAlmostEqual(value, expected, delta=0.004)

    def test_alpha(self):
        self.scene.render.film_transparent = True
        self.scene.penumbra.samples = 64
        self.floor(self.image([(1, 1, 1, 0), (1, 1, 1, 0.5), (1, 1, 1, 0.75), (1, 1, 1, 1)]), use_alpha=True)
        alpha = self.quarters(self.render(), 'A')
        self.assertEqual((alpha[0], alpha[3]), (0.0, 1.0))
        # 64 samples, each opaque or not: five standard deviations are 0.31.
        self.assertAlmostEqual(alpha[1], 0.5, delta=0.32)
        self.assertAlmostEqual(alpha[2], 0.75, delta=0.32)

    def test_file_edited_between_renders(self):
        """A texture is not kept beyond a render."""
        image = self.image([(1, 0, 0, 1)] * 4)
        path = output("texture.png")
        image.filepath_raw, image.file_format = path, 'PNG'
        image.save()
        loaded = bpy.data.images.load(path)
        self.floor(loaded)
        self.assertAlmostEqual(self.quarters(self.render())[0], 1.0, delta=0.004)
        other = self.image([(0, 1, 0, 1)] * 4)
        other.filepath_raw, other.file_format = path, 'PNG'
        other.save()
        loaded.reload()
        self.assertAlmostEqual(self.quarters(self.render())[0], 0.0, delta=0.004)


class Robustness(SceneTest):
    def test_empty_scene(self):
        add_camera()
        self.assertEqual(set(self.render()['ViewLayer.Combined.R'][2]), {0.0})

    def test_no_light_no_object(self):
        self.still_life()
        for name in ("Key", "Floor", "Cube"):
            bpy.data.objects.remove(bpy.data.objects[name])
            self.render()

    def test_exception_inside(self):
        """A defect of ours is an error message, not a crash."""
        self.still_life()
        original = penumbra_settings.for_still
        self.addCleanup(lambda: setattr(penumbra_settings, 'for_still', original))

        def broken(*_arguments):
            raise KeyError("planted")
        penumbra_settings.for_still = broken
        with self.assertRaisesRegex(RuntimeError, "planted"):
            self.render()

    def test_unknown_backend(self):
        self.still_life()
        preferences = bpy.context.preferences.addons[ADDON].preferences
        preferences.backend = 'nosuch'
        with self.assertRaisesRegex(RuntimeError, "nosuch"):
            self.render()
        preferences.backend = ''
        self.render()

    def test_no_growth(self):
        """Memory stays where it is: 100 renders may add 4 MB, what one picture of each size class costs."""
        self.still_life()
        for _ in range(10):
            bpy.ops.render.render()
        before = resident_bytes()
        for _ in range(100):
            bpy.ops.render.render()
        self.assertLess(resident_bytes() - before, 4e6)

    def test_stereo(self):
        self.still_life()
        render = self.scene.render
        render.use_multiview = True
        render.image_settings.file_format = 'PNG'
        render.filepath = output("stereo")
        bpy.ops.render.render(write_still=True)
        left, right = (read_byte_image(output(f"stereo_{eye}.png")) for eye in 'LR')
        self.assertEqual(left[:2], right[:2])
        self.assertNotEqual(left[2], right[2])

    def test_animation(self):
        """Three frames of a moving cube: three files that differ."""
        self.still_life()
        cube = bpy.data.objects["Cube"]
        for frame in (1, 3):
            cube.location.x = frame - 2
            cube.keyframe_insert('location', frame=frame)
        scene = self.scene
        scene.frame_start, scene.frame_end = 1, 3
        scene.render.image_settings.file_format = 'PNG'
        scene.render.filepath = output("frame_")
        bpy.ops.render.render(animation=True)
        pictures = [read_byte_image(output(f"frame_{frame:04}.png")) for frame in (1, 2, 3)]
        self.assertEqual({picture[:2] for picture in pictures}, {(64, 48)})
        self.assertEqual(len({picture[2].tobytes() for picture in pictures}), 3)
        self.assertFalse(os.path.exists(output("frame_0004.png")))
