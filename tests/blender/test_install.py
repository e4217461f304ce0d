# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip installs into an empty profile, renders, and leaves nothing behind when it is removed."""

import os
import subprocess
import tempfile
import unittest

import bpy

IS_EXTENSION = bpy.app.version >= (4, 2)
ZIP = os.environ['TEST_ZIP']

# What the buttons of the preferences do.
PREFERENCES = """
import bpy, os
def done(result):
    assert result == {'FINISHED'}, result
if %(is_extension)r:
    done(bpy.ops.extensions.package_install_files(filepath=%(zip)r, repo='user_default', enable_on_install=True))
else:
    done(bpy.ops.preferences.addon_install(filepath=%(zip)r))
    done(bpy.ops.preferences.addon_enable(module='penumbra'))
bpy.context.scene.render.engine = 'PENUMBRA'
bpy.context.scene.render.resolution_percentage = 2
bpy.ops.render.render()
bpy.context.scene.render.engine = 'CYCLES'
if %(is_extension)r:
    done(bpy.ops.extensions.package_uninstall(repo_index=[r.module for r in bpy.context.preferences.extensions.repos]
                                              .index('user_default'), pkg_id='penumbra'))
else:
    done(bpy.ops.preferences.addon_disable(module='penumbra'))
    try:
        done(bpy.ops.preferences.addon_remove(module='penumbra'))
    except RuntimeError as error:   # once all is removed the operator redraws an area, of which there is none
        assert 'tag_redraw' in str(error), error
"""


class Install(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.profile = folder.name
        os.makedirs(os.path.join(self.profile, 'scripts', 'addons'))
        self.environment = {**os.environ, 'BLENDER_USER_RESOURCES': self.profile,
                            'BLENDER_USER_SCRIPTS': os.path.join(self.profile, 'scripts'),
                            'BLENDER_USER_CONFIG': os.path.join(self.profile, 'config')}

    def blender(self, *arguments):
        done = subprocess.run([bpy.app.binary_path, '-b', '--factory-startup', *arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env=self.environment, timeout=600, check=False)
        self.assertEqual(done.returncode, 0, done.stdout.decode(errors='replace'))

    def installed(self):
        return [os.path.join(folder, name) for folder, _folders, names in os.walk(self.profile) for name in names
                if 'penumbra' in os.path.join(folder, name)[len(self.profile):]]

    def test_by_preferences(self):
        self.blender('--python-exit-code', '1', '--python-expr',
                     PREFERENCES % {'is_extension': IS_EXTENSION, 'zip': ZIP})
        self.assertEqual(self.installed(), [])

    @unittest.skipUnless(IS_EXTENSION, "before Blender 4.2")
    def test_by_command_line(self):
        self.blender('--command', 'extension', 'install-file', '--repo', 'user_default', ZIP)
        self.assertTrue(self.installed())
        self.blender('--command', 'extension', 'remove', 'penumbra')
        self.assertEqual(self.installed(), [])
