# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender -b`: exit codes and files."""

import glob
import os
import signal
import subprocess

import bpy

from harness import SceneTest, blender_command, output, run_blender


class CommandLine(SceneTest):
    def setUp(self):
        super().setUp()
        self.still_life()
        self.scene.render.image_settings.file_format = 'PNG'
        for path in glob.glob(output("cli_*")):
            os.remove(path)

    def blender(self, blend, *arguments, **environment):
        return run_blender(blend, '-E', 'PENUMBRA', '-o', output("cli_"), *arguments, environment=environment)

    def files(self):
        return sorted(os.path.basename(path) for path in glob.glob(output("cli_*")))

    def test_still(self):
        code, log = self.blender(self.save(), '-f', '1')
        self.assertEqual(code, 0, log)
        self.assertEqual(self.files(), ["cli_0001.png"])
        self.assertNotIn("Traceback", log)

    def test_animation(self):
        code, log = self.blender(self.save(), '-s', '1', '-e', '3', '-a')
        self.assertEqual(code, 0, log)
        self.assertEqual(self.files(), ["cli_0001.png", "cli_0002.png", "cli_0003.png"])

    def assert_fails(self, code, log, *words):
        self.assertNotEqual(code, 0, log)
        self.assertEqual(self.files(), [])
        for word in words:
            self.assertIn(word, log)

    def test_no_camera(self):
        bpy.data.objects.remove(self.scene.camera)
        self.assert_fails(*self.blender(self.save(), '-f', '1'), "camera")

    def test_no_backend(self):
        self.assert_fails(*self.blender(self.save(), '-f', '1', PENUMBRA_BACKEND='egl:99'), "egl:99")

    def test_no_backend_in_animation(self):
        self.assert_fails(*self.blender(self.save(), '-s', '1', '-e', '3', '-a', PENUMBRA_BACKEND='egl:99'), "egl:99")

    def test_too_large(self):
        self.scene.render.resolution_x = 60000
        self.scene.render.resolution_y = 4
        self.assert_fails(*self.blender(self.save(), '-f', '1'), "60000")

    def test_capture(self):
        code, log = self.blender(self.save(), '-s', '1', '-e', '2', '-a', '--', '--penumbra-capture',
                                 output("cli_##.pnb"))
        self.assertEqual(code, 0, log)
        self.assertEqual(self.files(), ["cli_0001.png", "cli_0002.png", "cli_01.pnb", "cli_02.pnb"])

    def test_capture_by_environment(self):
        code, log = self.blender(self.save(), '-f', '1', PENUMBRA_CAPTURE=output("cli_x.pnb"))
        self.assertEqual(code, 0, log)
        self.assertEqual(self.files(), ["cli_0001.png", "cli_x.pnb"])

    def test_capture_that_cannot_be_written(self):
        self.assert_fails(*self.blender(self.save(), '-f', '1', PENUMBRA_CAPTURE=output("no/such/folder/x.pnb")),
                          "no/such/folder")

    def test_cancel(self):
        """An interrupt (Esc in the window) ends a render that would take hours."""
        self.scene.render.resolution_x, self.scene.render.resolution_y = 960, 540
        self.scene.penumbra.samples = 4096
        command = blender_command(self.save(), '-E', 'PENUMBRA', '-o', output("cli_"), '-f', '1')
        with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
            try:
                line = next(line for line in process.stdout if b"Sample " in line)
                self.assertIn(b"/4096", line)
                process.send_signal(signal.SIGINT)
                rest, _ = process.communicate(timeout=120)
            finally:
                process.kill()
        self.assert_fails(process.returncode, rest.decode())
        self.assertNotIn(b"Sample 4096/4096", rest)
        self.assertNotIn(b"Traceback", rest)
