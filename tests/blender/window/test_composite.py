# SPDX-License-Identifier: GPL-3.0-or-later
"""Composite Soft Shadows over Workbench, which needs a window in 3.4."""

from composite import CompositeMixin
from window import ViewportTest


class Composite(CompositeMixin, ViewportTest):
    def test_workbench(self):
        self.still_life()
        with self.window():
            self.check_composite('BLENDER_WORKBENCH')
