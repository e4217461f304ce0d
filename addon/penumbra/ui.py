# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels: our own, and Blender's that fit."""

import textwrap

import bpy
from bpy.types import Panel

from . import compat, compositing, presets, props, report, statistics

ENGINE = 'PENUMBRA'

# Blender's panels that fit in another place: the panel to be within, or ''.
_MOVED = {'DATA_PT_spot': 'PENUMBRA_PT_light',
          'RENDER_PT_eevee_performance_compositor': 'PENUMBRA_PT_performance',
          'RENDER_PT_simplify': '',     # it would come first
          'RENDER_PT_simplify_viewport': 'PENUMBRA_PT_simplify', 'RENDER_PT_simplify_render': 'PENUMBRA_PT_simplify',
          'RENDER_PT_simplify_greasepencil': 'PENUMBRA_PT_simplify'}
# Those that show settings we have our own panels for, or do not have.
_EXCLUDED = {'DATA_PT_light', 'DATA_PT_area', 'DATA_PT_falloff_curve', 'DATA_PT_preview', 'NODE_DATA_PT_light',
             'EEVEE_MATERIAL_PT_viewport_settings', 'VIEWLAYER_PT_filter', 'VIEWLAYER_PT_layer_passes', *_MOVED}


class _EnginePanel:
    bl_space_type = 'PROPERTIES'
    bl_region_type = 'WINDOW'
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def _column(self, animated=False):
        """As Blender's panels, those of scenes and view layers do not tell what is animated."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = animated
        return self.layout.column()


def _paragraph(layout, text, context):
    """Text in as many lines as the region's width needs."""
    characters = max(20, int(context.region.width / (7 * context.preferences.system.ui_scale)))
    column = layout.column(align=True)
    column.scale_y = 0.8
    for line in textwrap.wrap(text, characters):
        column.label(text=line)


def draw_technique(column, context):
    """The technique, what it is, its parameters, and the shadow maps."""
    settings = context.scene.penumbra
    column.prop(settings, 'technique')
    _draw_parameters(column, context, settings.technique)
    column.separator()
    column.prop(settings, 'shadow_map_size')


def _draw_parameters(column, context, technique):
    settings = context.scene.penumbra
    info, parameters = props.technique(settings, technique)
    _paragraph(column, info.description.decode(), context)
    if info.paper:
        _paragraph(column, info.paper.decode(), context)
    group = getattr(settings, info.id.decode().lower())
    for parameter in parameters:
        column.prop(group, parameter.name.decode())


class PENUMBRA_PT_technique(_EnginePanel, Panel):
    bl_label = "Soft Shadows"
    bl_context = 'render'

    def draw(self, context):
        row = self.layout.row(align=True)
        for name in presets.PRESETS:
            row.operator(presets.PENUMBRA_OT_preset.bl_idname, text=name.capitalize()).preset = name
        draw_technique(self._column(), context)


class PENUMBRA_PT_sampling(_EnginePanel, Panel):
    bl_label = "Sampling"
    bl_context = 'render'

    def draw(self, context):
        settings = context.scene.penumbra
        column = self._column()
        column.prop(settings, 'samples', text="Render")
        column.prop(settings, 'viewport_samples', text="Viewport")
        column.prop(settings, 'light_samples')


class PENUMBRA_PT_performance(_EnginePanel, Panel):
    bl_label = "Performance"
    bl_context = 'render'

    def draw(self, context):
        settings = context.scene.penumbra
        column = self._column()
        column.prop(settings, 'viewport_latency')
        column.prop(settings, 'use_refine')
        column.prop(context.scene.render, 'preview_pixel_size', text="Pixel Size")


class PENUMBRA_PT_debug(_EnginePanel, Panel):
    bl_label = "Viewport View"
    bl_context = 'render'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        settings = context.scene.penumbra
        column = self._column()
        column.prop(settings, 'viewport_view')
        if settings.viewport_view in {'LIGHT', 'PENUMBRA', 'BLOCKER', 'MAP'}:
            column.prop_search(settings, 'viewport_light', context.scene, 'objects', icon='LIGHT')


class PENUMBRA_PT_statistics(_EnginePanel, Panel):
    bl_label = "Statistics"
    bl_context = 'render'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        last = statistics.last
        if last is None:
            self.layout.label(text="Nothing was rendered yet")
            return
        _paragraph(self.layout, f"{last.what}: {last.size[0]} x {last.size[1]} pixels, {last.samples} samples, "
                                f"{last.triangles} triangles, {last.lights} lights", context)
        _paragraph(self.layout, last.renderer, context)
        table = self.layout.column(align=True)
        table.scale_y = 0.8
        self._row(table, "Pass", "Times", "ms", "MiB")
        for item in last.passes:
            self._row(table, item.name, str(item.count), f"{item.gpu_ms:.1f}", f"{item.megabytes:.1f}")
        self._row(table, "Sum", "", f"{last.milliseconds():.1f}", f"{last.megabytes():.1f}")

    def _row(self, layout, name, *numbers):
        split = layout.split(factor=0.46)
        split.label(text=name)
        grid = split.grid_flow(columns=len(numbers), even_columns=True, align=True)
        for number in numbers:
            cell = grid.row()
            cell.alignment = 'RIGHT'
            cell.label(text=number)


class PENUMBRA_PT_film(_EnginePanel, Panel):
    bl_label = "Film"
    bl_context = 'render'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        column = self._column()
        column.prop(context.scene.render, 'filter_size')
        column.prop(context.scene.render, 'film_transparent', text="Transparent")


class PENUMBRA_PT_report(_EnginePanel, Panel):
    bl_label = "Report"
    bl_context = 'render'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        self.layout.operator(report.PENUMBRA_OT_report.bl_idname)
        for line in report.lines:
            _paragraph(self.layout, line, context)


class PENUMBRA_PT_passes(_EnginePanel, Panel):
    bl_label = "Passes"
    bl_context = 'view_layer'

    def draw(self, context):
        view_layer = context.view_layer
        column = self._column()
        for name in ('use_pass_combined', 'use_pass_z', 'use_pass_normal', 'use_pass_shadow'):
            column.prop(view_layer, name)
        column.prop(view_layer.penumbra, 'use_pass_light_shadows')


class PENUMBRA_PT_override(_EnginePanel, Panel):
    bl_label = "Override"
    bl_context = 'view_layer'
    bl_options = {'DEFAULT_CLOSED'}

    def draw(self, context):
        column = self._column()
        for name in compat.VIEW_LAYER_OVERRIDES:
            column.prop(context.view_layer, name)


class PENUMBRA_PT_material(_EnginePanel, Panel):
    bl_label = "Settings"
    bl_context = 'material'

    @classmethod
    def poll(cls, context):
        return context.material and not context.material.grease_pencil and super().poll(context)

    def draw(self, context):
        compat.draw_material_settings(self._column(), context.material)


class PENUMBRA_PT_light(_EnginePanel, Panel):
    bl_label = "Light"
    bl_context = 'data'

    @classmethod
    def poll(cls, context):
        return context.light and super().poll(context)

    def draw(self, context):
        light = context.light
        self.layout.row().prop(light, 'type', expand=True)
        column = self._column(animated=True)
        self._draw_color(column, light)
        column.separator()
        for name in compat.LIGHT_POWER:
            column.prop(light, name)
        column.separator()
        if light.type == 'AREA':
            column.prop(light, 'shape')
            two_sided = light.shape in {'RECTANGLE', 'ELLIPSE'}
            sub = column.column(align=True)
            sub.prop(light, 'size', text="Size X" if two_sided else "Size")
            if two_sided:
                sub.prop(light, 'size_y', text="Y")
            column.prop(light, 'spread')
        elif light.type == 'SUN':
            column.prop(light, 'angle')
        else:
            column.prop(light, 'shadow_soft_size', text="Radius")
        column.prop(light, 'use_shadow', text="Cast Shadow")

    def _draw_color(self, column, light):
        if not compat.HAS_LIGHT_TEMPERATURE:
            column.prop(light, 'color')
            return
        row = column.row(align=True, heading="Temperature")
        row.use_property_decorate = False
        row.prop(light, 'use_temperature', text="")
        sub = row.row()
        sub.active = light.use_temperature
        sub.prop(light, 'temperature', text="")
        row.prop_decorator(light, 'temperature')
        column.prop(light, 'color', text="Tint" if light.use_temperature else "Color")


class PENUMBRA_PT_light_shadow(_EnginePanel, Panel):
    """What one light has by itself; with other engines where their pictures get our shadows."""
    bl_label = "Soft Shadow"
    bl_context = 'data'

    @classmethod
    def poll(cls, context):
        scene = context.scene
        return context.light and (super().poll(context) or scene.penumbra.use_overlay or
                                  compositing.shadow_scene(scene) is not None)

    def draw(self, context):
        options = context.light.penumbra
        column = self._column(animated=True)
        column.prop(options, 'shadow_color', text="Color")
        column.prop(options, 'shadow_map_size', text="Map Size")
        column.prop(options, 'technique')
        if options.technique not in {props.AS_SCENE, context.scene.penumbra.technique}:
            column.use_property_decorate = False
            _draw_parameters(column, context, options.technique)
            _paragraph(column, "All lights of this technique share its parameters.", context)


class PENUMBRA_PT_object_visibility(_EnginePanel, Panel):
    bl_label = "Ray Visibility"
    bl_context = 'object'
    bl_parent_id = 'OBJECT_PT_visibility'

    @classmethod
    def poll(cls, context):
        """Lights and cameras are not seen, and shadow nothing."""
        return super().poll(context) and context.object.type not in {'LIGHT', 'CAMERA', 'LIGHT_PROBE', 'SPEAKER'}

    def draw(self, context):
        column = self._column(animated=True)
        column.prop(context.object, 'visible_camera', text="Camera")
        column.prop(context.object, 'visible_shadow', text="Shadow")
        column.prop(context.object.penumbra, 'receive_shadows')


class PENUMBRA_PT_composite(Panel):
    """Among the render settings of other engines."""
    bl_label = "Penumbra Soft Shadows"
    bl_space_type = 'PROPERTIES'
    bl_region_type = 'WINDOW'
    bl_context = 'render'
    bl_options = {'DEFAULT_CLOSED'}

    @classmethod
    def poll(cls, context):
        return context.engine != ENGINE

    def draw(self, context):
        column = self.layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        has_shadows = compositing.is_set_up(context.scene)
        operator = compositing.PENUMBRA_OT_composite_remove if has_shadows else compositing.PENUMBRA_OT_composite
        column.operator(operator.bl_idname)
        if has_shadows:
            draw_technique(column, context)
            column.prop(context.scene.penumbra, 'samples')


CLASSES = (PENUMBRA_PT_technique, PENUMBRA_PT_sampling, PENUMBRA_PT_performance, PENUMBRA_PT_film, PENUMBRA_PT_passes,
           PENUMBRA_PT_override, PENUMBRA_PT_material, PENUMBRA_PT_light, PENUMBRA_PT_light_shadow,
           PENUMBRA_PT_object_visibility, PENUMBRA_PT_composite)
# Below those that are moved.
_LAST = PENUMBRA_PT_debug, PENUMBRA_PT_statistics, PENUMBRA_PT_report
_moved = []


def _adopted():
    for panel in Panel.__subclasses__():
        engines = getattr(panel, 'COMPAT_ENGINES', ())
        if panel.__name__ in compat.ADOPTED_PANELS or 'BLENDER_RENDER' in engines and panel.__name__ not in _EXCLUDED:
            yield panel


def _move():
    """Panels of our own that draw what Blender's do. Not subclasses, which would replace them."""
    for name, parent in _MOVED.items():
        original = getattr(bpy.types, name, None)
        if original:
            members = {key: value for key, value in vars(original).items()
                       if key.startswith('bl_') and key != 'bl_rna' or key in {'poll', 'draw', 'draw_header'}}
            members.update({'COMPAT_ENGINES': {ENGINE}, '__module__': __name__})
            if parent:
                members['bl_parent_id'] = parent
            _moved.append(type('PENUMBRA' + name[name.index('_PT_'):], original.__bases__, members))


def register():
    _move()
    for panel in _adopted():
        panel.COMPAT_ENGINES.add(ENGINE)
    for cls in (*CLASSES, *_moved, *_LAST):
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed((*CLASSES, *_moved, *_LAST)):
        bpy.utils.unregister_class(cls)
    _moved.clear()
    for panel in _adopted():
        panel.COMPAT_ENGINES.discard(ENGINE)
