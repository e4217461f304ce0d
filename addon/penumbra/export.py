# SPDX-License-Identifier: GPL-3.0-or-later
"""Dependency graph -> pnb_scene. Nothing of Blender is kept after the call that made the export."""

import ctypes
from array import array
from ctypes import addressof, byref, c_uint32, memmove

import bpy

from . import camera, capi, compat, lights, materials, nodes, textures
from .mesh import create_mesh

# Object types that can be seen in other engines but are not exported.
_UNSUPPORTED = {'CURVES': "hair curves", 'POINTCLOUD': "a point cloud", 'VOLUME': "a volume"}


class SceneExport:
    """A pnb_scene and all it points to; `close` it when the library has copied it."""

    def __init__(self, depsgraph, use_pointers=True, kept=None, shown_in=None):
        """`kept`: a Kept that outlives this export; `shown_in`: only what this 3D view's local view shows."""
        self.scene = capi.Scene(camera=capi.Camera())
        self.warnings = []
        self._use_pointers = use_pointers
        self._kept = kept
        self._shown_in = shown_in
        self._meshes = {}           # address of the evaluated data: handle, or None if it has no mesh
        self._textures = {}         # (image name, use): (handle, whether it is ours)
        self._materials = {}        # address: index; None: no material
        self._slots = {}            # tuple of material indices: first slot
        self._material_list, self._slot_list, self._lights = [], [], []
        self._view_layer = depsgraph.view_layer
        override, world = compat.view_layer_overrides(depsgraph.view_layer_eval)
        self._override = override
        try:
            self._add_instances(depsgraph)
            self._set_arrays()
            self._set_world(world or depsgraph.scene_eval.world)
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_error):
        self.close()

    def close(self):
        library = capi.library()
        if self._kept is None:
            for handle in filter(None, self._meshes.values()):
                library.destroy('mesh', handle)
        for handle, is_ours in self._textures.values():
            if is_ours and handle:
                library.destroy('texture', handle)
        self._meshes, self._textures = {}, {}

    def set_camera(self, ob, matrix, shift_x, width, height, aspect):
        camera.fill_camera(self.scene.camera, ob, matrix, shift_x, width, height, aspect, self.warnings)

    # ---- Instances ----

    def _add_instances(self, depsgraph):
        """Matrices and flags of all instances come in one call each; only objects need a loop."""
        count = len(depsgraph.object_instances)
        matrices = array('f', bytes(64 * count))
        shown = array('b', bytes(count))
        depsgraph.object_instances.foreach_get('matrix_world', matrices)
        depsgraph.object_instances.foreach_get('show_self', shown)
        self._instances = (capi.Instance * count)()
        used = 0
        for number, instance in enumerate(depsgraph.object_instances):
            if not shown[number] or not self._is_shown(instance):
                continue
            ob = instance.object
            if ob.type == 'LIGHT':
                self._add_light(ob, instance.matrix_world)
                continue
            mesh = self._mesh_of(ob)
            if mesh is None:
                continue
            target = self._instances[used]
            self._fill_instance(target, ob, mesh)
            memmove(addressof(target) + capi.Instance.matrix.offset, matrices.buffer_info()[0] + 64 * number, 64)
            used += 1
        self.scene.instance_count = used

    def _is_shown(self, instance):
        if self._shown_in is None:
            return True
        return (instance.parent or instance.object).original.visible_in_viewport_get(self._shown_in)

    def _fill_instance(self, target, ob, mesh):
        target.struct_size = ctypes.sizeof(capi.Instance)
        target.mesh = mesh
        target.name = ob.name.encode()
        target.flags = self._flags(ob)
        slots = tuple(self._material_index(slot.material) for slot in ob.material_slots)
        target.first_slot = self._first_slot(slots)
        target.slot_count = len(slots)

    def _flags(self, ob):
        """Of the object, and of its collections in this view layer."""
        original = ob.original
        is_seen = ob.visible_camera and not original.indirect_only_get(view_layer=self._view_layer)
        is_holdout = ob.is_holdout or original.holdout_get(view_layer=self._view_layer)
        return ((0 if is_seen else capi.INSTANCE_HIDDEN_FROM_CAMERA)
                | (0 if ob.visible_shadow else capi.INSTANCE_NO_SHADOW)
                | (capi.INSTANCE_HOLDOUT if is_holdout else 0)
                | (capi.INSTANCE_SHADOW_CATCHER if ob.is_shadow_catcher else 0))

    def _add_light(self, ob, matrix):
        if not ob.visible_diffuse:
            return
        light = capi.Light()
        lights.fill_light(light, ob, matrix, self.warnings)
        self._lights.append(light)

    def _mesh_of(self, ob):
        """Handle of the object's mesh, shared by all instances of the same evaluated data; None without one.
        Curves, surfaces, texts and metaballs come as instances of their evaluated mesh beside themselves."""
        if ob.type != 'MESH':
            if ob.type in _UNSUPPORTED:
                self.warnings.append(f"object '{ob.name}': {_UNSUPPORTED[ob.type]} cannot be rendered")
            return None
        key = ob.data.as_pointer()
        if key not in self._meshes:
            self._meshes[key] = self._kept.mesh(ob, self._create_mesh) if self._kept else self._create_mesh(ob)
        return self._meshes[key]

    def _create_mesh(self, ob):
        if not ob.data.is_editmode:
            return create_mesh(ob.data, ob.name, self._use_pointers, self.warnings)
        try:
            return create_mesh(ob.to_mesh(), ob.name, self._use_pointers, self.warnings)
        finally:
            ob.to_mesh_clear()

    # ---- Materials ----

    def _first_slot(self, slots):
        if slots not in self._slots:
            self._slots[slots] = len(self._slot_list)
            self._slot_list.extend(slots)
        return self._slots[slots]

    def _material_index(self, material):
        material = self._override or material
        key = material.as_pointer() if material else None
        if key not in self._materials:
            target = capi.Material(base_color=tuple(materials.GREY))
            if material:
                materials.fill_material(target, material, self._texture, self.warnings)
            self._materials[key] = len(self._material_list)
            self._material_list.append(target)
        return self._materials[key]

    def _texture(self, image, use):
        key = (image.as_pointer(), use)
        if key not in self._textures:
            cache = self._kept.textures if self._kept else textures.cache
            self._textures[key] = cache.get(image, use, self.warnings)
        return self._textures[key][0]

    # ---- The rest ----

    def _set_arrays(self):
        scene = self.scene
        scene.instances = self._instances
        scene.materials = (capi.Material * len(self._material_list))(*self._material_list)
        scene.material_count = len(self._material_list)
        scene.slots = (c_uint32 * len(self._slot_list))(*self._slot_list)
        scene.slot_count = len(self._slot_list)
        scene.lights = (capi.Light * len(self._lights))(*self._lights)
        scene.light_count = len(self._lights)

    def _set_world(self, world):
        if world is None:
            color = [0.0] * 3
        elif compat.uses_nodes(world):
            color = nodes.emission(world.node_tree, f"world '{world.name}'", self.warnings)
        else:
            color = world.color
        self.scene.world_color[:] = color


def changed_data(depsgraph):
    """Addresses of the originals whose geometry or pixels changed. Undo and frame changes come without a list of
    updates: None, which stands for anything."""
    updates = list(depsgraph.updates)
    if not updates:
        return None
    return {update.id.original.as_pointer() for update in updates
            if update.is_updated_geometry or isinstance(update.id, bpy.types.Image)}


class Kept:
    """Meshes and textures kept from one export of a viewport to the next while Blender says that they did not change."""

    def __init__(self):
        self.textures = textures.TextureCache()
        self._meshes = {}       # address of the evaluated data: (what identifies its content, handle)
        self._used = set()
        self._changed = None    # see changed_data

    def begin(self, changed):
        """Before an export, which must be the only one from then on."""
        self._used = set()
        self._changed = changed
        if changed is None or any(image.as_pointer() in changed for image in bpy.data.images):
            self.textures.clear()

    def mesh(self, ob, create):
        data = ob.data
        key = data.as_pointer()
        content = (ob.name_full, len(data.vertices), len(data.loops), len(data.polygons))
        kept = self._meshes.get(key)
        if kept is None or kept[0] != content or self._may_differ(ob):
            self._drop(key)
            self._meshes[key] = content, create(ob)
        self._used.add(key)
        return self._meshes[key][1]

    def _may_differ(self, ob):
        if self._changed is None or ob.data.is_editmode:
            return True
        original = ob.original
        return original.as_pointer() in self._changed or original.data and original.data.as_pointer() in self._changed

    def end(self):
        """After the export: what it did not use is dropped."""
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


def write_capture(path, scene, settings):
    """Writes what the library would render to a .pnb file."""
    capi.library().capture_write(path.encode(), byref(scene), byref(settings))
