# SPDX-License-Identifier: GPL-3.0-or-later
"""Draft, Preview, Final: settings that go together."""

from bpy.props import EnumProperty
from bpy.types import Operator

PRESETS = {
    'DRAFT': {'technique': 'PCSS', 'shadow_map_size': 512, 'samples': 4, 'viewport_samples': 1, 'light_samples': 4},
    'PREVIEW': {'technique': 'PCSS', 'shadow_map_size': 1024, 'samples': 16, 'viewport_samples': 16,
                'light_samples': 16},
    'FINAL': {'technique': 'PCSS', 'shadow_map_size': 2048, 'samples': 64, 'viewport_samples': 32, 'light_samples': 16},
}
_TEXTS = {'DRAFT': "Small maps, few samples: to find a light's place",
          'PREVIEW': "What a new scene has",
          'FINAL': "Large maps, many samples"}


class PENUMBRA_OT_preset(Operator):
    """Set technique, shadow maps and samples to values that go together"""
    bl_idname = 'penumbra.preset'
    bl_label = "Preset"
    bl_options = {'REGISTER', 'UNDO'}

    preset: EnumProperty(items=[(name, name.capitalize(), _TEXTS[name], number) for number, name in enumerate(PRESETS)])

    @classmethod
    def description(cls, _context, properties):
        return _TEXTS[properties.preset]

    def execute(self, context):
        for name, value in PRESETS[self.preset].items():
            setattr(context.scene.penumbra, name, value)
        return {'FINISHED'}
