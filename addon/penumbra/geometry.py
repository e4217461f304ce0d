# SPDX-License-Identifier: GPL-3.0-or-later
"""The meshes of an export: made once for all that share their data, and kept from export to export if wanted."""

import bpy

from . import capi, strands, textures
from .mesh import NO_NEEDS, create_mesh
from .names import name_of

_POINTS = {'CURVES': strands.create_curves, 'POINTCLOUD': strands.create_points}


class MeshStore:
    """Handles of an export."""

    def __init__(self, is_render, use_pointers, kept, warnings):
        self._is_render = is_render
        self._use_pointers = use_pointers
        self._kept = kept           # Kept, or None
        self._warnings = warnings
        self._found = {}            # (address of the evaluated data, needs): handle, or None if it has no mesh
        self._own = []              # handles that end with the export

    def of(self, ob, needs):
        """Handle of the object's mesh, for materials with these needs; None without one. Curves, surfaces, texts and
        metaballs come as instances of their evaluated mesh beside themselves."""
        if ob.type == 'VOLUME':
            self._warnings.append(f"object '{name_of(ob)}': a volume cannot be rendered")
        if ob.type != 'MESH' and ob.type not in _POINTS:
            return None
        if all(need == NO_NEEDS for need in needs):
            needs = ()
        key = ob.data.as_pointer(), needs
        if key not in self._found:
            self._found[key] = self._make(ob, needs)
        return self._found[key]

    def hair(self, ob):
        """(name, handle, material slot) of each hair system of the object."""
        if ob.type != 'MESH':
            return
        for system in strands.hair_systems(ob):
            handle = self._keep(strands.create_hair(ob, system, self._is_render, self._warnings))
            if handle:
                yield f"{name_of(ob)}, {name_of(system)}", handle, strands.hair_slot(system)

    def _make(self, ob, needs):
        if ob.type in _POINTS:
            return self._keep(_POINTS[ob.type](ob.data, name_of(ob), self._warnings))
        if self._kept is not None:
            return self._kept.mesh(ob, needs, self._create)
        return self._keep(self._create(ob, needs))

    def _keep(self, handle):
        if handle:
            self._own.append(handle)
        return handle

    def _create(self, ob, needs):
        if not ob.data.is_editmode:
            return create_mesh(ob.data, name_of(ob), needs, self._use_pointers, self._warnings)
        try:
            return create_mesh(ob.to_mesh(), name_of(ob), needs, self._use_pointers, self._warnings)
        finally:
            ob.to_mesh_clear()

    def close(self):
        for handle in self._own:
            capi.library().destroy('mesh', handle)
        self._own, self._found = [], {}


def changed_data(depsgraph):
    """Addresses of the originals whose geometry or pixels changed. Undo and frame changes come without a list of
    updates: None, which stands for anything."""
    updates = list(depsgraph.updates)
    if not updates:
        return None
    return {update.id.original.as_pointer() for update in updates
            if update.is_updated_geometry or isinstance(update.id, bpy.types.Image)}


class Kept:
    """Meshes and textures kept from one export of a viewport to the next while Blender says that they are unchanged."""

    def __init__(self):
        self.textures = textures.TextureCache(watches=True)
        self._meshes = {}       # (address of the evaluated data, needs): (what identifies its content, handle)
        self._used = set()
        self._changed = None    # see changed_data
        self._changed_images = set()

    def begin(self, changed):
        """Before an export, which must be the only one from then on."""
        self._used = set()
        self._changed = changed
        self.textures.forget(self._changed_images)
        self._changed_images = set()
        if changed is None or any(image.as_pointer() in changed for image in bpy.data.images):
            self.textures.clear()

    def has_changed_images(self):
        """Whether there is anything to export for which Blender sends no update."""
        self._changed_images = self.textures.changed()
        return bool(self._changed_images)

    def mesh(self, ob, needs, create):
        """`needs`: see mesh.Needs."""
        data = ob.data
        key = data.as_pointer(), needs
        content = (name_of(ob, 'name_full'), len(data.vertices), len(data.loops), len(data.polygons))
        kept = self._meshes.get(key)
        if kept is None or kept[0] != content or self._may_differ(ob):
            self._drop(key)
            self._meshes[key] = content, create(ob, needs)
        self._used.add(key)
        return self._meshes[key][1]

    def _may_differ(self, ob):
        if self._changed is None or ob.data.is_editmode:
            return True
        original = ob.original
        return original.as_pointer() in self._changed or original.data and original.data.as_pointer() in self._changed

    def end(self):
        """After the export: what it did not use is dropped."""
        self.textures.end_export()
        for key in self._meshes.keys() - self._used:
            self._drop(key)

    def close(self):
        for key in list(self._meshes):
            self._drop(key)
        self.textures.clear()

    def _drop(self, key):
        _content, handle = self._meshes.pop(key, (None, None))
        if handle:
            capi.library().destroy('mesh', handle)
