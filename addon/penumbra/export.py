# SPDX-License-Identifier: GPL-3.0-or-later
"""Dependency graph -> pnb_scene. Nothing of Blender is kept after the call that made the export."""

from array import array
from ctypes import byref, c_uint32
from typing import NamedTuple

import bpy

from . import camera, capi, compat, emission, lights, materials, settings, surfaces, textures
from .geometry import MeshStore
from .links import LightLinks
from .mesh import NO_NEEDS
from .names import name_of


class Cancelled(Exception):
    """The user ended the render during the export."""


class ExportedMaterial(NamedTuple):
    index: int
    needs: object       # mesh.Needs


class Template:
    """All bytes of a capi.Instance but its matrix."""

    def __init__(self, instance, is_hair, triangles):
        content = bytes(instance)
        field = capi.Instance.matrix
        self.head, self.tail = content[:field.offset], content[field.offset + field.size:]
        self.is_hair = is_hair
        self.triangles = triangles
        self._instance = instance   # keeps the name


# What is drawn of a light.
LIGHT = ()


class SceneExport:
    """A pnb_scene and all it points to; `close` it when the library has copied it."""

    def __init__(self, depsgraph, use_pointers=True, kept=None, shown_in=None, is_cancelled=lambda: False):
        """`kept`: a Kept that outlives this export; `shown_in`: only what this 3D view shows;
        `is_cancelled`: asked before each object, True raises Cancelled."""
        self.scene = capi.Scene(camera=capi.Camera())
        self.warnings = []
        self.triangle_count = 0     # of all instances
        self._kept = kept
        self._meshes = MeshStore(depsgraph.mode == 'RENDER', use_pointers, kept, self.warnings)
        self._shown_in = shown_in
        self._is_cancelled = is_cancelled
        self._templates = {}        # addresses of object, data and instancing object: what is drawn of it
        self._links = LightLinks()
        self._texture_cache = kept.textures if kept else textures.cache
        self._textures = {}         # (address of the image, file, use, flags): (handle, whether it is ours)
        self._materials = {}        # address: ExportedMaterial; None: no material
        self._slots = {}            # tuple of material indices: first slot
        self._material_list, self._slot_list, self._lights = [], [], []
        self._owners = {}           # what the library gives no name in its messages: how ours call it
        self._view_layer = depsgraph.view_layer
        override, world = compat.view_layer_overrides(depsgraph.view_layer_eval)
        self._override = override
        try:
            self._check_libraries(depsgraph)
            self._add_instances(depsgraph)
            self._set_arrays()
            self._set_world(world or depsgraph.scene_eval.world)
            if depsgraph.scene_eval.render.use_motion_blur:
                self.warnings.append(f"scene '{name_of(depsgraph.scene)}': motion blur is not supported")
        except BaseException:
            self.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_error):
        self.close()

    def close(self):
        self._meshes.close()
        for handle, is_ours in self._textures.values():
            if is_ours and handle:
                capi.library().destroy('texture', handle)
        self._textures = {}
        if not self._kept:
            self._texture_cache.end_export()

    def set_camera(self, ob, matrix, shift_x, width, height, aspect):
        self._owners['camera'] = f"camera '{name_of(ob)}'"
        camera.fill_camera(self.scene.camera, ob, matrix, shift_x, width, height, aspect, self.warnings)

    def add_message(self, text):
        """One of the library."""
        owner, colon, rest = text.partition(':')
        self.warnings.append(self._owners.get(owner, owner) + colon + rest)

    def use_own_techniques(self, used, share=1.0):
        """Whether lights have the techniques of their own, or all the settings'; share: of the size of their maps."""
        for target, light in zip(self.scene.lights[:self.scene.light_count], self._lights):
            target.technique = light.technique if used else None
            target.shadow_map_size = light.shadow_map_size and settings.map_size(light.shadow_map_size, share)

    # ---- Instances ----

    def _add_instances(self, depsgraph):
        """Matrices and flags of all instances come in one call each; what an object's instances share is made once."""
        instances = depsgraph.object_instances
        count = len(instances)
        matrices = array('f', bytes(64 * count))
        shown, particles = array('b', bytes(count)), array('b', bytes(count))
        instances.foreach_get('matrix_world', matrices)
        instances.foreach_get('show_self', shown)
        instances.foreach_get('show_particles', particles)
        places = memoryview(matrices).cast('B')
        shows_all = self._shown_in is None
        pieces, numbers = [], []
        for number, instance in enumerate(instances):
            if not (shown[number] or particles[number]) or not (shows_all or self._is_shown(instance)):
                continue
            for template in self._templates_of(instance):
                if particles[number] if template.is_hair else shown[number]:
                    pieces += template.head, places[64 * number:64 * number + 64], template.tail
                    numbers.append(number)
                    self.triangle_count += template.triangles
        self._instances = (capi.Instance * len(numbers)).from_buffer(bytearray(b''.join(pieces)))
        self.scene.instance_count = len(numbers)
        if self._links:
            self._link_lights(instances, numbers)

    def _is_shown(self, instance):
        return (instance.parent or instance.object).visible_in_viewport_get(self._shown_in)

    def _templates_of(self, instance):
        """What is drawn of an object. Instances of geometry come as one object with changing data."""
        ob, parent = instance.object, instance.parent
        data = ob.data
        if data is None:
            return ()
        key = ob.as_pointer(), data.as_pointer(), parent and parent.as_pointer()
        templates = self._templates.get(key)
        if templates is None:
            if self._is_cancelled():
                raise Cancelled
            templates = self._templates[key] = LIGHT if ob.type == 'LIGHT' else \
                list(self._make_templates(ob, self._flags(ob, parent)))
        if templates is LIGHT:
            self._add_light(ob, parent, instance.matrix_world)
        return templates

    def _make_templates(self, ob, flags):
        slots = [self._material(slot.material) for slot in ob.material_slots]
        mesh = self._meshes.of(ob, tuple(material.needs for material in slots))
        indices = tuple(material.index for material in slots)
        if mesh:
            triangles = len(ob.data.loop_triangles) if ob.type == 'MESH' else 0
            yield Template(self._instance(name_of(ob), mesh, flags, indices), False, triangles)
        for name, mesh, slot in self._meshes.hair(ob):
            slots = indices[min(slot, len(indices) - 1):][:1]
            yield Template(self._instance(name, mesh, flags, slots), True, 0)

    def _instance(self, name, mesh, flags, slots):
        return capi.Instance(mesh=mesh, name=name.encode(), flags=flags, first_slot=self._first_slot(slots),
                             slot_count=len(slots))

    def _flags(self, ob, parent):
        """Of an object and of its `parent`, the one that instances it, or None: its collections count then."""
        owner = parent or ob
        flags = _switches(ob) | (_switches(parent) if parent else 0)
        if owner.is_holdout or owner.original.holdout_get(view_layer=self._view_layer):
            return flags | capi.INSTANCE_HOLDOUT
        if owner.original.indirect_only_get(view_layer=self._view_layer):
            return flags | capi.INSTANCE_HIDDEN_FROM_CAMERA
        return flags

    # ---- Lights ----

    def _add_light(self, ob, parent, matrix):
        if not ob.visible_diffuse or not lights.gives_light(ob.data, name_of(ob), matrix, self.warnings):
            return
        light = capi.Light()
        lights.fill_light(light, ob, matrix, self.warnings)
        self._links.add_light(len(self._lights), parent or ob)
        self._lights.append(light)

    def _link_lights(self, instances, numbers):
        """When all lights are known. `numbers`: of the dependency graph's instances, for each of ours."""
        targets = {}
        for target, number in zip(self._instances, numbers):
            targets.setdefault(number, []).append(target)
        for number, instance in enumerate(instances):
            for target in targets.get(number, ()):
                target.unlit_by, target.unshadowed_by = self._links.of(instance.parent or instance.object)

    # ---- Materials ----

    def _first_slot(self, slots):
        if slots not in self._slots:
            self._slots[slots] = len(self._slot_list)
            self._slot_list.extend(slots)
        return self._slots[slots]

    def _material(self, material):
        material = self._override or material
        key = material.as_pointer() if material else None
        if key not in self._materials:
            target = capi.Material(base_color=tuple(surfaces.GREY))
            needs = materials.fill_material(target, material, self._texture, self.warnings) if material else NO_NEEDS
            index = len(self._material_list)
            self._materials[key] = ExportedMaterial(index, needs)
            if material:
                self._owners[f'material {index}'] = f"material '{name_of(material)}'"
            self._material_list.append(target)
        return self._materials[key]

    def _texture(self, picture):
        key = (picture.image.as_pointer(), picture.file, picture.use, picture.flags)
        if key not in self._textures:
            self._textures[key] = self._texture_cache.get(picture.image, *key[1:], self.warnings)
        return self._textures[key][0]

    # ---- The rest ----

    def _check_libraries(self, depsgraph):
        """Of all that the view layer needs. What stands for a missing data-block is empty."""
        for block in depsgraph.ids if bpy.data.libraries else ():
            path = compat.missing_from(block)
            if path:
                kind = block.bl_rna.name.lower()
                self.warnings.append(f"{kind} '{name_of(block)}': it is missing from the library '{path}'")

    def _set_arrays(self):
        scene = self.scene
        for light in self._lights[capi.MAX_LIGHTS:]:
            self.warnings.append(
                f"light '{light.name.decode()}': it is left out, there are more than {capi.MAX_LIGHTS}")
        del self._lights[capi.MAX_LIGHTS:]
        scene.instances = self._instances
        scene.materials = (capi.Material * len(self._material_list))(*self._material_list)
        scene.material_count = len(self._material_list)
        scene.slots = (c_uint32 * len(self._slot_list))(*self._slot_list)
        scene.slot_count = len(self._slot_list)
        scene.lights = (capi.Light * len(self._lights))(*self._lights)
        scene.light_count = len(self._lights)

    def _set_world(self, world):
        if world is None:
            return
        self._owners['world'] = f"world '{name_of(world)}'"
        self.scene.world_color[:] = emission.of_world(world, self.warnings)
        for node in world.node_tree.nodes if world.node_tree else ():
            if getattr(node, 'image', None):
                self._texture_cache.watch(node.image)


def _switches(ob):
    """What an object says of itself, and of all that it instances."""
    return ((0 if ob.visible_camera else capi.INSTANCE_HIDDEN_FROM_CAMERA)
            | (0 if ob.visible_shadow else capi.INSTANCE_NO_SHADOW)
            | (0 if ob.original.penumbra.receive_shadows else capi.INSTANCE_NO_RECEIVE)
            | (capi.INSTANCE_SHADOW_CATCHER if ob.is_shadow_catcher else 0))


def write_capture(path, scene, settings):
    """Writes what the library would render to a .pnb file."""
    capi.library().capture_write(path.encode(), byref(scene), byref(settings))
