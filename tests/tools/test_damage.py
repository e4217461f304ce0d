# SPDX-License-Identifier: GPL-3.0-or-later
"""Captures cut off, changed or of something else: each is refused by name, and nothing is written."""

import os
import random

from tool import make_scene, refuses


def refused(data, what):
    with open('bad.pnb', 'wb') as file:
        file.write(data)
    try:
        refuses('render', 'bad.pnb', '-o', 'image.exr', code=3, mentions=('bad.pnb',))
    except AssertionError as error:
        raise AssertionError(f"{what}: {error}") from error
    os.remove('bad.pnb')


def capture():
    with open(make_scene('box'), 'rb') as file:
        return file.read()


def test_captures_cut_off_are_refused():
    data = capture()
    for size in (0, 1, 3, 4, 16, 31, 32, 33, 40, 100, len(data) // 2, len(data) - 1):
        refused(data[:size], f"the first {size} bytes")
    assert os.listdir() == ['scene.pnb']


def test_captures_with_a_changed_bit_are_refused():
    data = capture()
    numbers = random.Random(1)
    for position in [*range(36), *(numbers.randrange(len(data)) for _ in range(24)), len(data) - 1]:
        bit = numbers.randrange(8)
        changed = bytearray(data)
        changed[position] ^= 1 << bit
        refused(bytes(changed), f"bit {bit} of byte {position} changed")
    assert os.listdir() == ['scene.pnb']


def test_other_files_are_refused():
    data = capture()
    refused(data + b'\0', "a byte more")
    refused(data + data, "twice")
    refused(b'\0' * 4096, "zeros")
    refused(random.Random(2).randbytes(4096), "random bytes")
    refused(b'BLENDER-v304' + data, "another beginning")
    os.mkdir('folder.pnb')
    for path in ('folder.pnb', '/dev/null', '/proc/self/mem'):
        refuses('render', path, '-o', 'image.exr', code=3, mentions=(path,))
    assert sorted(os.listdir()) == ['folder.pnb', 'scene.pnb']
