# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender quits while a viewport, or F12, renders something that takes minutes."""

import os
import subprocess

import bpy
import gpu

from harness import ADDON, output
from window import ViewportTest

SCRIPT = """
import bpy
def begin():
    print("beginning", flush=True)
    window = bpy.context.window_manager.windows[0]
    scene = window.scene
    scene.render.engine = 'PENUMBRA'
    scene.penumbra.technique = 'REFERENCE'
    scene.penumbra.light_samples = 64
    scene.penumbra.viewport_latency = 2000
    if {still}:
        with bpy.context.temp_override(window=window):
            bpy.ops.render.render('INVOKE_DEFAULT')
    for area in window.screen.areas:
        if area.type == 'VIEW_3D':
            area.spaces.active.shading.type = 'RENDERED'
def end():
    print("quitting", flush=True)
    bpy.ops.wm.quit_blender()
bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(begin, first_interval=1.0)
bpy.app.timers.register(end, first_interval=4.0)
"""


class Quit(ViewportTest):
    def quit(self, still):
        path = output("quit.py")
        with open(path, 'w', encoding='ascii') as file:
            file.write(SCRIPT.format(still=still))
        vulkan = ['--gpu-backend', 'vulkan'] if gpu.platform.backend_type_get() == 'VULKAN' else []
        command = [bpy.app.binary_path, '--factory-startup', *vulkan, '-p', '0', '0', '640', '480', '--addons', ADDON,
                   '--python-exit-code', '1', '--python', path]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=600, check=False,
                              env=os.environ)
        text = done.stdout.decode(errors='replace')
        self.assertEqual(done.returncode, 0, text)
        self.assertIn("quitting", text)
        # Debian's Blender 5.2 has one of its own when it starts.
        self.assertNotIn("Traceback", text[text.index("beginning"):])
        self.assertNotIn("crash", text)

    def test_viewport(self):
        self.quit(still=False)

    def test_still(self):
        self.quit(still=True)
