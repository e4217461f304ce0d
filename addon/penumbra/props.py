# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings. The techniques and their parameters come from the library's table."""

from zlib import crc32

import bpy
from bpy.props import (BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty,
                       StringProperty)
from bpy.types import AddonPreferences, PropertyGroup

from . import capi
from .command_line import UsageError

DEFAULT_TECHNIQUE = 'PCSS'
# A light's technique that is not its own.
AS_SCENE = 'SCENE'


class PenumbraPreferences(AddonPreferences):
    bl_idname = __package__

    backend: StringProperty(
        name="Backend",
        description="OpenGL to render with: egl (any device), egl:N (device N), surfaceless or osmesa. Empty: the "
                    "environment variable PENUMBRA_BACKEND, else the first that works, GPUs first")

    def draw(self, _context):
        self.layout.prop(self, 'backend')


class PenumbraViewLayerSettings(PropertyGroup):
    use_pass_light_shadows: BoolProperty(
        name="Shadow of Each Light",
        description="One pass per light, 'Shadow.' and the light's name: how much of that light arrives")


class PenumbraObjectSettings(PropertyGroup):
    receive_shadows: BoolProperty(
        name="Receive Shadows", default=True, description="Other objects, and the object itself, shadow it")


def preferences():
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else None


def backend():
    settings = preferences()
    return settings.backend if settings else ''


# ---- Reflection ----

def _property(info):
    """Blender property of one parameter."""
    common = {'name': info.label.decode(), 'description': info.description.decode()}
    if info.type == capi.BOOL:
        return BoolProperty(default=info.default_value != 0.0, **common)
    if info.type == capi.ENUM:
        names = [info.items[index].decode() for index in range(info.item_count)]
        items = [(name, name.replace('_', ' ').title(), '', index) for index, name in enumerate(names)]
        return EnumProperty(items=items, default=names[int(info.default_value)], **common)
    if info.type == capi.INT:
        return IntProperty(default=int(info.default_value), min=int(info.minimum), max=int(info.maximum), **common)
    subtype = 'DISTANCE' if info.unit == b'm' else 'NONE'
    return FloatProperty(default=info.default_value, min=info.minimum, max=info.maximum, precision=3,
                         subtype=subtype, **common)


def technique_number(identifier):
    """What a .blend stores for a technique: independent of the order and number of techniques."""
    return crc32(identifier.encode()) >> 1


def _technique_class(info, parameters):
    annotations = {parameter.name.decode(): _property(parameter) for parameter in parameters}
    return type(f"Penumbra{info.id.decode()}Settings", (PropertyGroup,), {'__annotations__': annotations})


def _technique_items(table):
    return [(info.id.decode(), info.label.decode(), info.description.decode(), technique_number(info.id.decode()))
            for info, _parameters in table]


def _light_class(table):
    annotations = {
        'technique': EnumProperty(
            name="Technique", description="How this light's shadow is made",
            items=[(AS_SCENE, "As Scene", "As Render Properties say", 0), *_technique_items(table)]),
        'shadow_map_size': IntProperty(
            name="Shadow Map Size", default=0, min=0, max=16384, subtype='PIXEL',
            description="Texels per side of this light's shadow maps, 16 or more. 0: as the scene's"),
        'shadow_color': FloatVectorProperty(
            name="Shadow Color", size=3, subtype='COLOR', min=0.0, max=1.0,
            description="The share of this light that arrives in its full shadow. Black: none, as in nature"),
    }
    return type('PenumbraLightSettings', (PropertyGroup,), {'__annotations__': annotations})


def _scene_class(table, technique_classes):
    items = _technique_items(table)
    identifiers = [item[0] for item in items]
    annotations = {
        'technique': EnumProperty(
            name="Technique", description="How soft shadows are made", items=items,
            default=DEFAULT_TECHNIQUE if DEFAULT_TECHNIQUE in identifiers else identifiers[0]),
        'shadow_map_size': IntProperty(
            name="Shadow Map Size", default=1024, min=16, max=16384, subtype='PIXEL',
            description="Texels per side of each shadow map"),
        'samples': IntProperty(
            name="Samples", default=16, min=1, max=4096, description="Anti-aliasing samples per pixel of a still"),
        'light_samples': IntProperty(
            name="Light Samples", default=16, min=1, max=64,
            description="Reference: N, for N x N samples of each light"),
        'viewport_samples': IntProperty(
            name="Viewport Samples", default=16, min=1, max=4096,
            description="Anti-aliasing samples per pixel of a viewport at rest"),
        'viewport_latency': IntProperty(
            name="Latency (ms)", default=100, min=10, max=2000,
            description="How soon a viewport shall follow input: its first picture has as many pixels as fit into that "
                        "time"),
        'viewport_view': EnumProperty(
            name="View", description="What rendered viewports show", items=[
                ('FINAL', "Final", "The picture", 0),
                ('SHADOW', "Shadow", "How much of the light arrives", 1),
                ('LIGHT', "Shadow of One Light", "How much of one light arrives", 2),
                ('CLASSES', "Lit, Penumbra, Umbra", "Yellow: lit; red: penumbra; blue: umbra", 3),
                ('PENUMBRA', "Penumbra Width", "How wide one light's penumbra is, from dark to bright; "
                                               "black: no blocker", 4),
                ('BLOCKER', "Average Blocker", "How far one light's average blocker is from it, from dark to bright; "
                                               "black: no blocker", 5),
                ('MAP', "Shadow Map", "What one light sees: near is dark, far is bright", 6)]),
        'viewport_light': StringProperty(name="Light", description="The light whose shadow is shown"),
        'use_overlay': BoolProperty(
            name="Soft Shadows",
            description="Multiply Penumbra's soft shadows over what other engines draw in viewports"),
        'overlay_strength': FloatProperty(
            name="Strength", default=1.0, min=0.0, max=1.0, subtype='FACTOR', description="1: as dark as they are"),
        'overlay_color': FloatVectorProperty(
            name="Color", size=3, subtype='COLOR', min=0.0, max=1.0, description="What a whole shadow looks like"),
        'use_refine': BoolProperty(
            name="Refine", description="Let a viewport at rest go on to the reference, the ground truth"),
    }
    for (info, _parameters), cls in zip(table, technique_classes):
        annotations[info.id.decode().lower()] = PointerProperty(type=cls)
    return type('PenumbraSceneSettings', (PropertyGroup,), {'__annotations__': annotations})


def technique(settings, identifier=None):
    """(TechniqueInfo, [ParameterInfo]) of the technique so named, else of the chosen one."""
    table = {row[0].id.decode(): row for row in capi.library().techniques()}
    found = table.get((identifier or settings.technique).upper())
    if found is None:
        raise UsageError(f"there is no technique {identifier}; there are: {', '.join(table)}")
    return found


def parameter_values(settings, row, of_lights=False):
    """[(name, number)] of a technique's parameters; of techniques that lights have by themselves, qualified."""
    info, parameters = row
    group = getattr(settings, info.id.decode().lower())
    prefix = info.id.decode() + '.' if of_lights else ''
    return [(prefix + parameter.name.decode(), _number(group, parameter)) for parameter in parameters]


def light_techniques():
    """Identifiers of what lights of the file have by themselves."""
    return sorted({light.penumbra.technique for light in bpy.data.lights} - {AS_SCENE})


def _number(group, parameter):
    value = getattr(group, parameter.name.decode())
    if parameter.type == capi.ENUM:
        return group.bl_rna.properties[parameter.name.decode()].enum_items[value].value
    return float(value)


_classes = []


def register():
    table = capi.library().techniques()
    technique_classes = [_technique_class(*row) for row in table]
    light_class = _light_class(table)
    _classes.extend([PenumbraPreferences, PenumbraViewLayerSettings, PenumbraObjectSettings, light_class,
                     *technique_classes, _scene_class(table, technique_classes)])
    for cls in _classes:
        bpy.utils.register_class(cls)
    bpy.types.Scene.penumbra = PointerProperty(type=_classes[-1])
    bpy.types.ViewLayer.penumbra = PointerProperty(type=PenumbraViewLayerSettings)
    bpy.types.Object.penumbra = PointerProperty(type=PenumbraObjectSettings)
    bpy.types.Light.penumbra = PointerProperty(type=light_class)


def unregister():
    del bpy.types.Light.penumbra
    del bpy.types.Object.penumbra
    del bpy.types.ViewLayer.penumbra
    del bpy.types.Scene.penumbra
    while _classes:
        bpy.utils.unregister_class(_classes.pop())
