# SPDX-License-Identifier: GPL-3.0-or-later
"""Unshadowed light on a white floor, pixel by pixel against Cycles of the running Blender."""

import math

from harness import CyclesTest, add_camera, add_light, add_plane, white_material

SIDE = 24
# Below this share of the brightest pixel the error counts against that share: the rim of a spot is all gradient.
FLOOR = 0.05


class Radiometry(CyclesTest):
    def setUp(self):
        super().setUp()
        add_plane(half=20).data.materials.append(white_material())
        add_camera(type='ORTHO', ortho_scale=0.08 * SIDE)
        self.scene.render.resolution_x = self.scene.render.resolution_y = SIDE

    def check(self, tolerance, kind, **settings):
        settings.setdefault('location', (0.3, 0.2, 2.0))
        # The floor alone shadows nothing; how a technique's bias does at grazing angles is measured elsewhere.
        add_light("Light", kind, use_shadow=False, **settings)
        expected, actual = (picture['ViewLayer.Combined.R'][2] for picture in self.both())
        brightest = max(expected)
        self.assertGreater(brightest, 0.0)
        errors = [abs(a - e) / max(e, FLOOR * brightest) for a, e in zip(actual, expected)]
        print(f"{kind} {settings}: largest error {max(errors):.4f}, brightest {brightest:.4f}")
        self.assertLess(max(errors), tolerance)

    def test_point_small(self):
        self.check(0.02, 'POINT', shadow_soft_size=0.0)

    def test_point_large(self):
        self.check(0.02, 'POINT', shadow_soft_size=0.4, scale=(3, 1, 2))

    def test_point_colour(self):
        self.check(0.02, 'POINT', shadow_soft_size=0.1, color=(0.25, 0.5, 1.0))

    def test_spot_wide(self):
        self.check(0.02, 'SPOT', spot_size=math.radians(120), spot_blend=0.0, shadow_soft_size=0.05)

    def test_spot_blend(self):
        self.check(0.02, 'SPOT', spot_size=math.radians(60), spot_blend=1.0, shadow_soft_size=0.0)

    def test_spot_tilted_and_scaled(self):
        self.check(0.02, 'SPOT', spot_size=math.radians(90), spot_blend=0.8, shadow_soft_size=0.0,
                   rotation=(0.3, 0.4, 0.5), scale=(2, 1, 3))

    def test_spot_large_tilted_and_scaled(self):
        """Cycles averages the rim of the cone over the bulb, of which we take the centre: 5 % where a thirtieth of the
        light is left."""
        self.check(0.05, 'SPOT', spot_size=math.radians(90), spot_blend=0.8, shadow_soft_size=0.02,
                   rotation=(0.3, 0.4, 0.5), scale=(2, 1, 3))

    def test_sun_small(self):
        self.check(0.02, 'SUN', energy=2.0, angle=0.01, rotation=(0.5, 0.3, 0), scale=(2, 2, 2))

    def test_sun_wide(self):
        self.check(0.02, 'SUN', energy=2.0, angle=1.0, rotation=(0.5, 0.3, 0))

    def test_square(self):
        self.check(0.02, 'AREA', shape='SQUARE', size=1.0)

    def test_rectangle_tilted_and_scaled(self):
        self.check(0.02, 'AREA', shape='RECTANGLE', size=0.5, size_y=1.0, rotation=(0.4, 0.3, 0.2), scale=(2, -1, 3))

    def test_disk(self):
        self.check(0.03, 'AREA', shape='DISK', size=1.0)

    def test_ellipse_tilted_and_scaled(self):
        self.check(0.03, 'AREA', shape='ELLIPSE', size=1.0, size_y=0.5, rotation=(0.4, 0.3, 0.2), scale=(1, 2, 1))

    def test_square_seen_from_its_plane(self):
        """Half of the floor lies behind the light."""
        self.check(0.02, 'AREA', shape='SQUARE', size=0.5, location=(0.3, 0.2, 1.0), rotation=(math.radians(70), 0, 0))
