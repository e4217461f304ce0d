# SPDX-License-Identifier: GPL-3.0-or-later
"""Soft shadows over what other engines draw in a viewport: *Soft Shadows* in the overlay popover."""

import bpy

from . import capi, draw, geometry, pictures, view, viewport

_regions = {}           # address of a region: its ShadowViewport
_handler = None


class RegionHost:
    """What a viewport needs of a region, which Blender frees when it likes."""

    def __init__(self, region):
        self._address = region.as_pointer()

    def tag_redraw(self):
        region = _all_regions().get(self._address)
        if region:
            region.tag_redraw()
        return region is not None

    def pixel_scale(self, scene):
        size = scene.render.preview_pixel_size
        return 1.0 if size == 'AUTO' else 1.0 / int(size)

    def show_status(self, text):
        """Overlays have no place for one."""


class OverlayPicture(pictures.ShadowPicture):
    def draw(self, region):
        options = bpy.context.scene.penumbra
        draw.draw_shadow(self.texture, self.size, self.place(region), draw.MULTIPLY,
                         (*options.overlay_color, options.overlay_strength))


class ShadowViewport(viewport.Viewport):
    def __init__(self, host):
        super().__init__(host)
        self._stale = True
        self._changed = None    # see geometry.changed_data
        self._layer = None      # what the window shows

    def draw(self, context, depsgraph):
        """Blender tells nobody but its own engines that a window shows another view layer."""
        layer = context.scene.as_pointer(), context.view_layer.as_pointer()
        if layer != self._layer:
            self._layer = layer
            self.note(None)
        super().draw(context, depsgraph)

    def note(self, changed):
        """The scene changed since the last drawing."""
        self._stale = True
        self._changed = None if changed is None or self._changed is None else self._changed | changed

    def is_stale(self):
        return super().is_stale() or self._stale

    def changes(self, depsgraph):
        changed = self._changed
        self._stale, self._changed = False, set()
        return changed

    def read_view(self, context, scene):
        """Blender's own engines draw all of a viewport, whatever its border."""
        found = view.read(context, scene)
        has_border = context.space_data.shading.type == 'RENDERED' and not scene.render.engine.startswith('BLENDER_')
        return found if has_border else found._replace(border=view.WHOLE)

    def image_wanted(self, scene):
        return pictures.ImageWanted(capi.PASS_SHADOW, 0, OverlayPicture)


def _all_regions():
    return {region.as_pointer(): region for window in bpy.context.window_manager.windows
            for area in window.screen.areas if area.type == 'VIEW_3D' for region in area.regions}


def _is_wanted(context):
    space, scene = context.space_data, context.scene
    draws_itself = space.shading.type == 'RENDERED' and scene.render.engine == 'PENUMBRA'
    return scene.penumbra.use_overlay and space.overlay.show_overlays and not draws_itself and \
        space.shading.type != 'WIREFRAME'


def _draw():
    context = bpy.context
    address = context.region.as_pointer()
    if not _is_wanted(context):
        _close(address)
        return
    if address not in _regions:
        for gone in _regions.keys() - _all_regions().keys():
            _close(gone)
        _regions[address] = ShadowViewport(RegionHost(context.region))
    _regions[address].draw(context, context.evaluated_depsgraph_get())


def _close(address):
    if address in _regions:
        _regions.pop(address).close()


@bpy.app.handlers.persistent
def _updated(_scene, depsgraph=None):
    changed = geometry.changed_data(depsgraph) if depsgraph and _regions else None
    for shown in _regions.values():
        shown.note(changed)


@bpy.app.handlers.persistent
def _replaced(*_arguments):
    """Undo, another frame or another file: anything may have changed."""
    for shown in _regions.values():
        shown.note(None)


_HANDLERS = (('depsgraph_update_post', _updated), ('frame_change_post', _replaced), ('undo_post', _replaced),
             ('redo_post', _replaced), ('load_post', _replaced))


def draw_popover(self, context):
    options = context.scene.penumbra
    column = self.layout.column()
    column.active = context.space_data.overlay.show_overlays
    split = column.split(factor=0.45)   # a row would cut the name off
    split.prop(options, 'use_overlay')
    sub = split.row(align=True)
    sub.active = options.use_overlay
    sub.prop(options, 'overlay_strength', text="")
    sub.prop(options, 'overlay_color', text="")


def register():
    global _handler
    if bpy.app.background:
        return
    _handler = bpy.types.SpaceView3D.draw_handler_add(_draw, (), 'WINDOW', 'POST_VIEW')
    for name, function in _HANDLERS:
        getattr(bpy.app.handlers, name).append(function)
    bpy.types.VIEW3D_PT_overlay.append(draw_popover)


def unregister():
    global _handler
    if _handler is None:
        return
    bpy.types.VIEW3D_PT_overlay.remove(draw_popover)
    for name, function in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(function)
    bpy.types.SpaceView3D.draw_handler_remove(_handler, 'WINDOW')
    _handler = None
    for address in list(_regions):
        _close(address)
