# SPDX-License-Identifier: GPL-3.0-or-later
"""Composite Soft Shadows over Workbench and EEVEE, which need a window in 3.4."""

from composite import CompositeMixin
from harness import eevee
from window import ViewportTest


class Composite(CompositeMixin, ViewportTest):
    def test_workbench(self):
        self.still_life()
        with self.window():
            self.check_composite('BLENDER_WORKBENCH')

    def test_eevee(self):
        self.still_life()
        self.scene.eevee.taa_render_samples = 1
        with self.window():
            self.check_composite(eevee())
