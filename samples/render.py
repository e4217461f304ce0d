# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the open file with Penumbra: blender -b FILE --python render.py -- TECHNIQUE WIDTH HEIGHT SAMPLES OUT.png"""
import sys

import bpy

technique, width, height, samples, path = sys.argv[sys.argv.index("--") + 1:]
scene = bpy.context.scene
scene.render.engine = "PENUMBRA"
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = int(width), int(height), 100
scene.render.image_settings.file_format = "PNG"
scene.render.filepath = path
scene.penumbra.technique, scene.penumbra.samples = technique, int(samples)
bpy.ops.render.render(write_still=True)
