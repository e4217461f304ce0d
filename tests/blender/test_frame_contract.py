# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender promises of a frame: borders to the last bit, and machines that share an animation."""

import os
import random
import re
import subprocess
import sys
import threading
from array import array

import bpy

from harness import ADDON, OUTPUT, SceneTest, blender_command, output


class Borders(SceneTest):
    """Blender itself places the pixels of a border that is not cropped: they are those of the full picture."""
    # Width, height, percentage, pixel aspect; odd, cut and stretched.
    SIZES = ((71, 47, 100, 1.0), (64, 48, 53, 1.0), (33, 97, 100, 2.0), (101, 29, 87, 0.5), (55, 55, 71, 1.25))
    PER_SIZE = 10

    def test_random(self):
        self.still_life()
        self.layer.use_pass_z = self.layer.use_pass_normal = self.layer.use_pass_shadow = True
        self.scene.penumbra.samples = 3
        numbers = random.Random(1)
        for width, height, percentage, aspect in self.SIZES:
            render = self.scene.render
            render.use_border = render.use_crop_to_border = False
            render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, percentage
            render.pixel_aspect_x, render.pixel_aspect_y = max(aspect, 1.0), max(1.0 / aspect, 1.0)
            full = self.render("full")
            render.use_border = True
            for _ in range(self.PER_SIZE):
                self.check(full, numbers)

    def check(self, full, numbers):
        render = self.scene.render
        left, right = sorted(numbers.random() for _ in range(2))
        bottom, top = sorted(numbers.random() for _ in range(2))
        render.border_min_x, render.border_max_x = left, max(right, left + 0.05)
        render.border_min_y, render.border_max_y = bottom, max(top, bottom + 0.05)
        border = left, right, bottom, top
        render.use_crop_to_border = False
        placed = self.render("placed")
        render.use_crop_to_border = True
        cropped = self.render("cropped")
        width, _height, alpha = placed['ViewLayer.Combined.A']
        inside = [index for index, value in enumerate(alpha) if value != 0.0]   # the film is opaque where rendered
        columns, rows = {index % width for index in inside}, {index // width for index in inside}
        self.assertEqual(cropped['ViewLayer.Combined.A'][:2], (len(columns), len(rows)), border)
        self.assertEqual(len(inside), len(columns) * len(rows), border)
        for name, (_width, _height, expected) in full.items():
            part = array('f', [expected[index] for index in inside])
            self.assertEqual(array('f', [placed[name][2][index] for index in inside]), part, (border, name))
            self.assertEqual(cropped[name][2], part, (border, name))


class SharedFolder(SceneTest):
    """Placeholders let several machines render one animation."""
    FRAMES = 40
    # Blender looks for the picture and then makes its placeholder. Processes that look in the same instant, as these do
    # when they start together, both render the frame. Without placeholders nearly all frames are rendered twice.
    TAKEN_TWICE = 1

    def start(self, blend, folder):
        return subprocess.Popen(blender_command(blend, '-o', output(folder) + '/', '-F', 'PNG', '-a'),
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def saved(self, process):
        """Names of the files that a process wrote."""
        text = process.communicate(timeout=600)[0].decode(errors='replace')
        self.assertEqual(process.returncode, 0, text)
        return re.findall(r"Saved: '.*?(\w+\.png)'", text)

    def test_two_processes(self):
        self.still_life()
        cube = bpy.data.objects["Cube"]
        for frame in (1, self.FRAMES):
            cube.location.x = frame / self.FRAMES - 0.5
            cube.keyframe_insert('location', frame=frame)
        scene = self.scene
        scene.frame_start, scene.frame_end = 1, self.FRAMES
        scene.render.use_placeholder, scene.render.use_overwrite = True, False
        blend = self.save("shared")
        alone = self.saved(self.start(blend, "alone"))
        self.assertEqual(len(alone), self.FRAMES)
        both = [self.saved(process) for process in [self.start(blend, "together") for _ in range(2)]]
        print("frames of each process:", [len(names) for names in both])
        self.assertEqual(set(both[0] + both[1]), set(alone))
        self.assertLessEqual(len(both[0] + both[1]), self.FRAMES + self.TAKEN_TWICE)
        for name in alone:
            contents = []
            for folder in ("alone", "together"):
                with open(os.path.join(OUTPUT, folder, name), 'rb') as file:
                    contents.append(_without_metadata(file.read()))
            self.assertEqual(*contents, name)

    def test_picture_that_another_writes(self):
        """It is left alone until it is whole, and removed where nobody goes on with it."""
        self.still_life()
        self.scene.render.filepath, self.scene.render.image_settings.file_format = output("taken"), 'PNG'
        bpy.ops.render.render(write_still=True)
        path = output("taken.png")
        with open(path, 'rb') as file:
            whole = file.read()
        remove_faulty = sys.modules[ADDON].output._remove_faulty
        for size, fault in ((0, "it is empty"), (len(whole) - 20, "its end is missing")):
            _write(path, whole[:size])
            writer = threading.Timer(0.3, _write, (path, whole))
            writer.start()
            self.assertEqual(list(remove_faulty([path])), [])
            writer.join()
            self.assertTrue(os.path.exists(path))
            _write(path, whole[:size])
            self.assertEqual(list(remove_faulty([path])), [(path, fault)])
            self.assertFalse(os.path.exists(path))


def _write(path, data):
    with open(path, 'wb') as file:
        file.write(data)


def _without_metadata(png):
    """Its chunks without texts, which hold times."""
    place, kept = 8, []
    while place < len(png):
        size = int.from_bytes(png[place:place + 4], 'big') + 12
        if png[place + 4:place + 8] in {b'IHDR', b'IDAT'}:
            kept.append(png[place:place + size])
        place += size
    return kept
