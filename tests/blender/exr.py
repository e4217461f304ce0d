# SPDX-License-Identifier: GPL-3.0-or-later
"""Reader of uncompressed 32-bit scanline OpenEXR files: all that the tests write."""

import struct
import sys
from array import array


def read_exr(path):
    """Channels by name: (width, height, floats with rows bottom-up)."""
    with open(path, 'rb') as file:
        data = file.read()
    assert data[:4] == b'\x76\x2f\x31\x01' and data[4] == 2, f"{path} is no OpenEXR file of version 2"
    attributes, place = _header(data, 8)
    assert attributes['compression'] == b'\0', "only uncompressed files"
    left, top, right, bottom = struct.unpack('<4i', attributes['dataWindow'])
    width, height = right - left + 1, bottom - top + 1
    names = _channels(attributes['channels'])
    rows = {name: [None] * height for name in names}
    for offset in struct.unpack_from(f'<{height}Q', data, place):
        y, size = struct.unpack_from('<ii', data, offset)
        assert size == 4 * width * len(names)
        for index, name in enumerate(names):
            start = offset + 8 + 4 * width * index
            rows[name][bottom - y] = data[start:start + 4 * width]
    return {name: (width, height, _floats(b''.join(rows[name]))) for name in names}


def _header(data, place):
    attributes = {}
    while data[place]:
        name, place = _string(data, place)
        _kind, place = _string(data, place)
        size, = struct.unpack_from('<i', data, place)
        attributes[name] = data[place + 4:place + 4 + size]
        place += 4 + size
    return attributes, place + 1


def _channels(value):
    names, place = [], 0
    while value[place]:
        name, place = _string(value, place)
        assert value[place] == 2, f"channel {name} is not 32-bit float"
        names.append(name)
        place += 16
    return names


def _string(data, place):
    end = data.index(0, place)
    return data[place:end].decode(), end + 1


def _floats(content):
    values = array('f', content)
    if sys.byteorder == 'big':
        values.byteswap()
    return values
