# SPDX-License-Identifier: GPL-3.0-or-later
"""What the display shows: the frame buffer file of Xvfb, which is an X window dump."""

import os
import struct
from typing import NamedTuple


class Picture(NamedTuple):
    width: int
    height: int
    rgb: bytes          # rows top-down

    def save(self, path):
        with open(path, 'wb') as file:
            file.write(b'P6 %d %d 255\n' % self[:2] + self.rgb)

    def cut(self, x, y, width, height):
        """A part; y counts from the bottom, as in Blender."""
        top = self.height - y - height
        rows = (self.rgb[3 * (row * self.width + x):3 * (row * self.width + x + width)]
                for row in range(top, top + height))
        return Picture(width, height, b''.join(rows))


def dump():
    with open(os.path.join(os.environ['TEST_DISPLAY'], 'Xvfb_screen0'), 'rb') as file:
        return file.read()


def read():
    data = dump()
    header_size, _version, _format, _depth, width, height = struct.unpack('>6I', data[:24])
    bits, stride = struct.unpack('>2I', data[44:52])
    colors = struct.unpack('>I', data[76:80])[0]
    if bits != 32:
        raise ValueError(f"the display has {bits} bits per pixel")
    start = header_size + 12 * colors
    pixels = b''.join(data[start + row * stride:start + row * stride + 4 * width] for row in range(height))
    rgb = bytearray(3 * width * height)
    for channel in range(3):
        rgb[channel::3] = pixels[2 - channel::4]    # stored blue, green, red, unused
    return Picture(width, height, bytes(rgb))
