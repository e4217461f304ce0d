# SPDX-License-Identifier: GPL-3.0-or-later
"""Soft shadows in real time, with or without a GPU."""

import bpy

from . import capi, compositing, device, engine, output, overlay, presets, props, report, textures, ui, viewport

bl_info = {
    "name": "Penumbra",
    "author": "The Penumbra authors",
    "description": "Render engine for soft shadow mapping, with or without a GPU",
    "blender": (3, 4, 0),
    "version": (0, 0, 0),  # set by the build
    "location": "Properties > Render > Render Engine > Penumbra",
    "category": "Render",
}

_CLASSES = (engine.PenumbraEngine, engine.PENUMBRA_OT_capture, presets.PENUMBRA_OT_preset, report.PENUMBRA_OT_report,
            *compositing.CLASSES)


@bpy.app.handlers.persistent
def _forget_textures(*_args):
    textures.cache.clear()


def _menu(self, _context):
    self.layout.operator(engine.PENUMBRA_OT_capture.bl_idname, text="Penumbra Capture (.pnb)")


def register():
    capi.library()  # before anything is registered: nothing remains if it cannot be loaded
    props.register()
    for cls in _CLASSES:
        bpy.utils.register_class(cls)
    ui.register()
    overlay.register()
    output.register()
    bpy.types.TOPBAR_MT_file_export.append(_menu)
    bpy.app.handlers.render_init.append(_forget_textures)
    bpy.app.handlers.render_pre.append(compositing.synchronize)
    bpy.app.handlers.depsgraph_update_pre.append(compositing.synchronize_objects)


def unregister():
    bpy.app.handlers.depsgraph_update_pre.remove(compositing.synchronize_objects)
    bpy.app.handlers.render_pre.remove(compositing.synchronize)
    bpy.app.handlers.render_init.remove(_forget_textures)
    bpy.types.TOPBAR_MT_file_export.remove(_menu)
    output.unregister()
    overlay.unregister()
    viewport.unregister()
    ui.unregister()
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
    props.unregister()
    textures.cache.clear()
    device.close()
