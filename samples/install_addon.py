# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs the add-on and enables it for good: blender -b --factory-startup --python install_addon.py -- ZIP"""
import sys

import bpy

path = sys.argv[sys.argv.index("--") + 1]
if bpy.app.version >= (4, 2, 0):
    bpy.ops.extensions.package_install_files(filepath=path, repo="user_default", enable_on_install=True)
else:
    bpy.ops.preferences.addon_install(filepath=path, overwrite=True)
    bpy.ops.preferences.addon_enable(module="penumbra")
if not hasattr(bpy.types.Scene, "penumbra"):
    raise SystemExit("the add-on did not register")
bpy.ops.wm.save_userpref()
