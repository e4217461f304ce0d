# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last render or check approximated or left out, a line each, with the object's name."""

import bpy

from . import export
from .names import one_line

lines = []


def set_lines(warnings):
    """Each line once, in the order of the scene."""
    lines[:] = dict.fromkeys(map(one_line, warnings))


class PENUMBRA_OT_report(bpy.types.Operator):
    """List what Penumbra approximates or leaves out in this scene"""
    bl_idname = 'penumbra.report'
    bl_label = "Check Scene"

    def execute(self, context):
        with export.SceneExport(context.evaluated_depsgraph_get()) as exported:
            set_lines(exported.warnings)
        for line in lines:
            self.report({'WARNING'}, line)
        self.report({'INFO'}, f"{len(lines)} approximated or left out" if lines else "Everything is supported")
        return {'FINISHED'}
