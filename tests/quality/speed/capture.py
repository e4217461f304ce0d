# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a capture of the open scene without its ambient light: blender -b FILE --python capture.py -- OUT.pnb"""
import os
import sys

import bpy

os.environ["PENUMBRA_CAPTURE"] = sys.argv[sys.argv.index("--") + 1]
scene, layer = bpy.context.scene, bpy.context.view_layer
scene.world = None
layer.use_pass_normal = layer.use_pass_shadow = True
scene.render.engine = "PENUMBRA"
scene.penumbra.technique, scene.penumbra.samples, scene.penumbra.shadow_map_size = "PCSS", 1, 1024
bpy.ops.render.render()
