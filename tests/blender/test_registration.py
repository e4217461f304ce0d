# SPDX-License-Identifier: GPL-3.0-or-later
"""Registration, and the mirror of the library's interface."""

import ctypes
import os
import shutil
import subprocess
import unittest
from types import SimpleNamespace

import addon_utils
import bpy

from harness import ADDON, output, run_blender

import penumbra
from penumbra import capi, props, ui

HEADER_FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), '../../core/include')


def registered():
    """Everything that registration may leave behind."""
    bases = (bpy.types.RenderEngine, bpy.types.AddonPreferences, bpy.types.PropertyGroup, bpy.types.Operator,
             bpy.types.Panel)
    found = {cls.__name__ for base in bases for cls in base.__subclasses__()
             if cls.__module__.startswith(ADDON) and cls.is_registered}
    found |= {panel.__name__ for panel in bpy.types.Panel.__subclasses__()
              if 'PENUMBRA' in getattr(panel, 'COMPAT_ENGINES', ()) and not panel.__module__.startswith(ADDON)}
    found |= {owner.__name__ for owner in (bpy.types.Scene, bpy.types.ViewLayer) if hasattr(owner, 'penumbra')}
    found |= {name for name in dir(bpy.types) if name.startswith('PENUMBRA_')}
    return found | {handler.__module__ for handler in bpy.app.handlers.render_init}


class Registration(unittest.TestCase):
    def test_repeatedly(self):
        before = registered()
        self.assertGreater(before, {'PenumbraEngine', 'PenumbraSceneSettings', 'PENUMBRA_PT_technique', 'DATA_PT_lens',
                                    'Scene', 'ViewLayer'})
        for _ in range(20):
            addon_utils.disable(ADDON)
            self.assertEqual(registered(), set())
            self.assertIsNotNone(addon_utils.enable(ADDON, default_set=True))
            self.assertEqual(registered(), before)

    def test_version_is_the_library_s(self):
        version = '.'.join(str(number) for number in addon_utils.module_bl_info(penumbra)['version'])
        self.assertEqual(version, capi.library().version().decode())
        with open(os.path.join(os.path.dirname(penumbra.__file__), 'blender_manifest.toml'), encoding='utf-8') as file:
            self.assertIn(f'version = "{version}"', file.read())


class Properties(unittest.TestCase):
    def setUp(self):
        self.settings = bpy.context.scene.penumbra

    def test_every_technique_and_parameter(self):
        table = capi.library().techniques()
        self.assertGreater(len(table), 0)
        items = self.settings.bl_rna.properties['technique'].enum_items
        self.assertEqual([item.identifier for item in items], [info.id.decode() for info, _ in table])
        self.assertEqual(len({item.value for item in items}), len(table))
        for info, parameters in table:
            group = getattr(self.settings, info.id.decode().lower())
            for parameter in parameters:
                self.check(group, parameter)

    def check(self, group, parameter):
        name = parameter.name.decode()
        prop = group.bl_rna.properties[name]
        self.assertEqual(prop.name, parameter.label.decode())
        self.assertEqual(prop.description, parameter.description.decode())
        if parameter.type == capi.ENUM:
            self.assertEqual([item.identifier for item in prop.enum_items],
                             [parameter.items[index].decode() for index in range(parameter.item_count)])
        elif parameter.type != capi.BOOL:
            self.assertAlmostEqual(prop.hard_min, parameter.minimum, places=5)
            self.assertAlmostEqual(prop.hard_max, parameter.maximum, delta=1e-6 * abs(parameter.maximum))
        self.assertAlmostEqual(props._number(group, parameter), parameter.default_value, places=6)

    def test_technique_is_stored_by_name(self):
        """The number in a .blend must not change when techniques are added: it is known here."""
        self.assertEqual(props.technique_number('PCSS'), 2108749567)


class Panels(unittest.TestCase):
    def test_ray_visibility(self):
        """Of what rays can meet."""
        for kind, wanted in (('MESH', True), ('CURVE', True), ('EMPTY', True), ('LIGHT', False), ('CAMERA', False)):
            context = SimpleNamespace(engine='PENUMBRA', object=SimpleNamespace(type=kind))
            self.assertEqual(ui.PENUMBRA_PT_object_visibility.poll(context), wanted, kind)

    def test_parents_are_shown(self):
        """A panel within one of another engine is never seen."""
        shown = {name: getattr(bpy.types, name) for name in dir(bpy.types) if '_PT_' in name}
        shown = {name: panel for name, panel in shown.items()
                 if 'PENUMBRA' in getattr(panel, 'COMPAT_ENGINES', {'PENUMBRA'})}
        lost = [name for name, panel in shown.items() if getattr(panel, 'COMPAT_ENGINES', None)
                and getattr(panel, 'bl_parent_id', '') not in {'', *shown}]
        self.assertEqual(lost, [])
        self.assertIn('PENUMBRA_PT_spot', shown)

    def test_words_are_blender_s(self):
        for owner in (bpy.types.Scene, bpy.types.Light, bpy.types.Object):
            for item in owner.bl_rna.properties['penumbra'].fixed_type.properties:
                self.assertNotIn('Colour', item.name)


class Layout(unittest.TestCase):
    STRUCTURES = {
        'pnb_context_desc': capi.ContextDesc, 'pnb_context_info': capi.ContextInfo, 'pnb_array': capi.Array,
        'pnb_mesh_desc': capi.MeshDesc, 'pnb_texture_desc': capi.TextureDesc, 'pnb_material': capi.Material,
        'pnb_instance': capi.Instance, 'pnb_light': capi.Light, 'pnb_camera': capi.Camera, 'pnb_scene': capi.Scene,
        'pnb_parameter_info': capi.ParameterInfo, 'pnb_technique_info': capi.TechniqueInfo, 'pnb_value': capi.Value,
        'pnb_settings': capi.Settings, 'pnb_progress': capi.Progress, 'pnb_image': capi.Image,
        'pnb_timing': capi.Timing,
    }

    @unittest.skipUnless(shutil.which('cc'), "needs a C compiler")
    def test_as_the_compiler_sees_it(self):
        lines = ['#include "penumbra.h"', '#include <stdio.h>', 'int main(void) {']
        expected = [f'PNB_API_VERSION {capi.API_VERSION}']
        lines.append('printf("PNB_API_VERSION %d\\n", (int)PNB_API_VERSION);')
        for name, cls in self.STRUCTURES.items():
            expected.append(f'{name} {ctypes.sizeof(cls)}')
            lines.append(f'printf("{name} %zu\\n", sizeof({name}));')
            for member, *_ in cls._fields_:
                field = getattr(cls, member)
                expected.append(f'{name}.{member} {field.offset} {field.size}')
                lines.append(f'printf("{name}.{member} %zu %zu\\n", offsetof({name}, {member}), '
                             f'sizeof((({name} *)0)->{member}));')
        lines.append('return 0; }')
        with open(output('layout.c'), 'w', encoding='utf-8') as file:
            file.write('\n'.join(lines))
        subprocess.run(['cc', '-I', HEADER_FOLDER, '-o', output('layout'), output('layout.c')], check=True)
        printed = subprocess.run([output('layout')], check=True, stdout=subprocess.PIPE).stdout.decode()
        self.assertEqual(printed.split('\n')[:-1], expected)


class WrongLibrary(unittest.TestCase):
    def assert_message(self, library, *words):
        code, log = run_blender('--python-expr', 'import bpy; print("has", hasattr(bpy.types.Scene, "penumbra"))',
                                environment={'PENUMBRA_LIBRARY': library})
        self.assertEqual(code, 0, log)
        self.assertIn("has False", log)
        for word in words:
            self.assertIn(word, log)

    def test_missing(self):
        self.assert_message(output('nowhere.so'), "cannot be loaded", "nowhere.so")

    @unittest.skipUnless(shutil.which('cc'), "needs a C compiler")
    def test_other_interface(self):
        with open(output('other.c'), 'w', encoding='utf-8') as file:
            file.write('unsigned pnb_api_version(void) { return 999; }\n')
        subprocess.run(['cc', '-shared', '-fPIC', '-o', output('other.so'), output('other.c')], check=True)
        self.assert_message(output('other.so'), "interface 999", "reinstall the add-on")
