# SPDX-License-Identifier: GPL-3.0-or-later
"""When a viewport stops asking to be drawn."""

import unittest

from penumbra import viewport


class Host:
    """A region that is there, or is gone."""

    def __init__(self, there):
        self.there = there

    def tag_redraw(self):
        return self.there


class Rest(unittest.TestCase):
    def waiting(self, there):
        """A viewport that has something to render."""
        waiting = viewport.Viewport(Host(there))
        self.addCleanup(waiting.close)
        waiting._next = viewport._FIRST, 0.0
        return waiting

    def test_waits_for_its_region(self):
        waiting = self.waiting(True)
        self.assertTrue(waiting.poll())
        self.assertFalse(waiting.is_at_rest())

    def test_rests_without_a_region(self):
        """Blender may drop a region's engine before the picture is made."""
        waiting = self.waiting(False)
        self.assertFalse(waiting.poll())
        self.assertTrue(waiting.is_at_rest())
        self.assertTrue(viewport.all_at_rest())
