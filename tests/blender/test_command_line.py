# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender -b`: exit codes and files."""

import glob
import os
import re
import signal
import subprocess
from ctypes import byref, c_void_p

import bpy

from harness import SceneTest, blender_command, output, run_blender, set_movie

from penumbra import capi, report


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

    def test_technique(self):
        code, log = self.blender(self.save(), '-f', '1', '--', '--penumbra-technique', 'pcf', '--penumbra-capture',
                                 output("cli_x.pnb"))
        self.assertEqual(code, 0, log)
        handle = c_void_p()
        capi.library().capture_read(output("cli_x.pnb").encode(), byref(handle))
        self.assertEqual(capi.library().capture_settings(handle).contents.technique, b'PCF')
        capi.library().destroy('capture', handle)

    def test_statistics(self):
        code, log = self.blender(self.save(), '-f', '1', '--', '--penumbra-stats')
        self.assertEqual(code, 0, log)
        for name in ("G-buffer", "Shadow map", "Visibility", "Shading"):
            self.assertRegex(log, f"Penumbra: {name} +[0-9]+ +[0-9.]+ +[0-9.]+ +[0-9.]+\n")
        _code, log = self.blender(self.save(), '-f', '1')
        self.assertNotIn("Penumbra: G-buffer", log)

    def test_wrong_options(self):
        blend = self.save()
        for options, words in ((('--penumbra-technique', 'VSMM'), ("VSMM", "PCSS")),
                               (('--penumbra-backend', 'egl:99'), ("egl:99",)),
                               (('--penumbra-stat',), ("--penumbra-stats",)),
                               (('--penumbra-technique',), ("needs a value",)),
                               (('--penumbra-technique', ''), ("needs a value",)),
                               (('--penumbra-backend', ''), ("needs a value",))):
            with self.subTest(options=options):
                self.assert_fails(*self.blender(blend, '-f', '1', '--', *options), *words)

    def movie(self, *arguments):
        """Renders three frames to one."""
        set_movie(self.scene)
        return self.blender(self.save(), '-s', '1', '-e', '3', *arguments, '-a')

    def test_movie(self):
        code, log = self.movie()
        self.assertEqual(code, 0, log)
        self.assertEqual(self.files(), ["cli_0001-0003.mp4"])

    def test_movie_that_fails_half_way(self):
        """No file, as after a still that failed: the camera goes with the last frame."""
        lose = ("import bpy; bpy.app.handlers.frame_change_pre.append(lambda scene, *_: "
                "scene.frame_current == 3 and setattr(scene, 'camera', None))")
        code, log = self.movie('--python-expr', lose)
        self.assert_fails(code, log, "has no camera", "cli_0001-0003.mp4' was removed")

    def test_report(self):
        """What is approximated is told on the console, once, by name."""
        glossy = bpy.data.materials.new("Chromé")
        glossy.use_nodes = True
        tree = glossy.node_tree
        surface = next(node for node in tree.nodes if node.type == 'OUTPUT_MATERIAL')
        tree.links.new(tree.nodes.new('ShaderNodeBsdfGlossy').outputs[0], surface.inputs['Surface'])
        for name in ("Cube", "Floor"):
            bpy.data.objects[name].data.materials[0] = glossy
        code, log = self.blender(self.save(), '-f', '1')
        self.assertEqual(code, 0, log)
        self.assertEqual(len(re.findall("material 'Chromé': .*diffuse", log)), 1, log)
        self.assertEqual(bpy.ops.penumbra.report(), {'FINISHED'})
        self.assertEqual([line for line in report.lines if "Chromé" in line], report.lines)
        self.assertEqual(len(report.lines), 1)

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
