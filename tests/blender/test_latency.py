# SPDX-License-Identifier: GPL-3.0-or-later
"""The size of a viewport's first picture."""

import unittest

from penumbra import viewport


class FirstPicture(unittest.TestCase):
    def settle(self, speed, fixed_ms, pixels_ms, latency_ms, pictures):
        """Scales of so many pictures that take a fixed time and one for all pixels."""
        scales = []
        for _ in range(pictures):
            scale = speed.choose(latency_ms)
            speed.add('PCSS', scale, fixed_ms + pixels_ms * scale ** 2)
            scales.append(scale)
        return scales

    def test_meets_latency(self):
        for fixed, pixels, wanted in ((5, 50, 1.0), (45, 90, 0.7), (10, 300, 0.5), (10, 3000, 0.25), (500, 1, 0.25)):
            with self.subTest(fixed=fixed, pixels=pixels):
                speed = viewport.Speed()
                speed.add('PCSS', 0.5, 5000.0)      # compiling shaders
                scales = self.settle(speed, fixed, pixels, 100, 30)
                # The wanted scale, after at most one try of each that is too slow.
                self.assertEqual(scales[-20:], [wanted] * 20)

    def test_recovers(self):
        """After a time in which everything was slow."""
        speed = viewport.Speed()
        self.settle(speed, 5, 5000, 100, 20)
        self.assertEqual(self.settle(speed, 5, 50, 100, 100)[-1], 1.0)
