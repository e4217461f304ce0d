# SPDX-License-Identifier: GPL-3.0-or-later
"""What a light has by itself: technique, size of maps and colour of its shadow."""

from array import array
from ctypes import byref, c_void_p

from harness import SceneTest, add_camera, add_cube, add_light, add_plane, output, run_blender, white_material

from penumbra import capi

LIGHTS = ("Left", "Right")


class LightOverrides(SceneTest):
    def setUp(self):
        super().setUp()
        material = white_material()
        for ob in (add_plane(), add_cube(location=(0, 0, 0.5))):
            ob.data.materials.append(material)
        add_camera(location=(0, 0, 8))
        self.scene.penumbra.technique = 'HARD'
        self.scene.penumbra.shadow_map_size = 256
        self.layer.penumbra.use_pass_light_shadows = True
        self.left, self.right = (add_light(name, 'AREA', location=(x, 0, 3), rotation=(0, angle, 0), size=0.5).data
                                 for name, x, angle in zip(LIGHTS, (-2, 2), (-0.6, 0.6)))

    def override(self):
        self.right.penumbra.technique = 'PCSS'
        self.right.penumbra.shadow_map_size = 100
        self.scene.penumbra.pcss.filter_samples = 40

    def read(self, path):
        """(pnb_scene, pnb_settings) of a capture."""
        handle = c_void_p()
        capi.library().capture_read(path.encode(), byref(handle))
        self.addCleanup(lambda: capi.library().destroy('capture', handle))
        return capi.library().capture_scene(handle).contents, capi.library().capture_settings(handle).contents

    def shadow(self, channels, light):
        return [channels[name][2] for name in sorted(channels) if f"Shadow.{light}." in name]

    def test_capture(self):
        self.override()
        self.right.penumbra.shadow_color = 0.5, 0.25, 0.125
        scene, settings = self.read(self.capture())
        left, right = sorted(scene.lights[:2], key=lambda light: light.name)
        self.assertEqual((left.technique, left.shadow_map_size, list(left.shadow_color)), (None, 0, [0.0] * 3))
        self.assertEqual((right.technique, right.shadow_map_size), (b'PCSS', 100))
        self.assertEqual(list(right.shadow_color), [0.5, 0.25, 0.125])
        values = {value.name: value.value for value in settings.values[:settings.value_count]}
        self.assertEqual(values[b'PCSS.filter_samples'], 40)

    def test_small_maps_are_as_small_as_can_be(self):
        self.right.penumbra.shadow_map_size = 3
        self.render()

    def test_each_light_as_if_all_were_so(self):
        self.override()
        mixed = self.render("mixed")
        self.right.penumbra.technique, self.right.penumbra.shadow_map_size = 'SCENE', 0
        hard = self.render("hard")
        self.scene.penumbra.technique, self.scene.penumbra.shadow_map_size = 'PCSS', 100
        soft = self.render("soft")
        self.assertEqual(self.shadow(mixed, "Left"), self.shadow(hard, "Left"))
        self.assertEqual(self.shadow(mixed, "Right"), self.shadow(soft, "Right"))
        self.assertNotEqual(self.shadow(hard, "Right"), self.shadow(soft, "Right"))

    def test_shadow_color(self):
        plain = self.render("plain")
        self.left.penumbra.shadow_color = 0.5, 0.5, 0.5
        tinted = self.render("tinted")
        for before, after in zip(self.shadow(plain, "Left"), self.shadow(tinted, "Left")):
            self.assertEqual(array('f', [0.5 + 0.5 * v for v in before]), array('f', after))
        self.assertLess(min(self.shadow(plain, "Left")[0]), 0.01)

    def test_command_line_wins(self):
        self.override()
        path = self.save("override")
        capture = output("forced.pnb")
        code, log = run_blender(path, '-f', '1', '--', '--penumbra-technique', 'ESM', '--penumbra-capture', capture)
        self.assertEqual(code, 0, log)
        scene, settings = self.read(capture)
        self.assertEqual(settings.technique, b'ESM')
        self.assertEqual([light.technique for light in scene.lights[:2]], [None, None])
        self.assertNotIn(b'.', b''.join(value.name for value in settings.values[:settings.value_count]))
