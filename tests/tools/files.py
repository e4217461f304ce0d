# SPDX-License-Identifier: GPL-3.0-or-later
"""Image files made and read without the tool, so that it is not tested against itself."""

import struct
import zlib


def write_pfm(path, width, height, channels, values):
    """values: rows bottom-up."""
    with open(path, 'wb') as file:
        file.write(b'%s\n%d %d\n-1.0\n' % (b'PF' if channels == 3 else b'Pf', width, height))
        file.write(struct.pack(f'<{len(values)}f', *values))


def read_pfm(path):
    """(width, height, channels, values with rows bottom-up)"""
    with open(path, 'rb') as file:
        channels = {b'PF\n': 3, b'Pf\n': 1}[file.readline()]
        width, height = map(int, file.readline().split())
        assert float(file.readline()) < 0, "big-endian"
        data = file.read()
    assert len(data) == 4 * width * height * channels
    return width, height, channels, struct.unpack(f'<{len(data) // 4}f', data)


def read_png(path):
    """(width, height, channels, bytes with rows top-down) of an 8-bit PNG."""
    with open(path, 'rb') as file:
        data = file.read()
    assert data[:8] == b'\x89PNG\r\n\x1a\n'
    place, content, header = 8, b'', None
    while place < len(data):
        size, kind = struct.unpack_from('>I4s', data, place)
        if kind == b'IHDR':
            header = struct.unpack_from('>IIBBBBB', data, place + 8)
        elif kind == b'IDAT':
            content += data[place + 8:place + 8 + size]
        place += 12 + size
    width, height, depth, color = header[:4]
    assert depth == 8
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[color]
    return width, height, channels, _unfilter(zlib.decompress(content), width * channels, height, channels)


def _unfilter(content, stride, height, channels):
    previous, result = bytearray(stride), bytearray()
    for y in range(height):
        kind = content[y * (stride + 1)]
        line = bytearray(content[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left = line[x - channels] if x >= channels else 0
            above_left = previous[x - channels] if x >= channels else 0
            line[x] = (line[x] + _predict(kind, left, previous[x], above_left)) & 255
        result += line
        previous = line
    return bytes(result)


def _predict(kind, left, above, above_left):
    if kind == 4:
        estimate = left + above - above_left
        return min((left, above, above_left), key=lambda value: abs(estimate - value))
    return (0, left, above, (left + above) // 2)[kind]


def write_exr(path, width, height, channels, kind='float', zipped=False):
    """A scanline OpenEXR file. channels: name -> values with rows bottom-up. kind: float or half."""
    code, number, size = ('f', 2, 4) if kind == 'float' else ('e', 1, 2)
    names = sorted(channels)
    listing = b''.join(name.encode() + b'\0' + struct.pack('<iiii', number, 0, 1, 1) for name in names) + b'\0'
    window = struct.pack('<4i', 0, 0, width - 1, height - 1)
    attributes = (('channels', 'chlist', listing), ('compression', 'compression', b'\3' if zipped else b'\0'),
                  ('dataWindow', 'box2i', window), ('displayWindow', 'box2i', window),
                  ('lineOrder', 'lineOrder', b'\0'), ('pixelAspectRatio', 'float', struct.pack('<f', 1)),
                  ('screenWindowCenter', 'v2f', bytes(8)), ('screenWindowWidth', 'float', struct.pack('<f', 1)))
    header = b'\x76\x2f\x31\x01\2\0\0\0' + b''.join(
        name.encode() + b'\0' + type_name.encode() + b'\0' + struct.pack('<i', len(value)) + value
        for name, type_name, value in attributes) + b'\0'
    lines = 16 if zipped else 1
    chunks = []
    for top in range(0, height, lines):
        raw = b''
        for y in range(top, min(top + lines, height)):
            row = height - 1 - y
            for name in names:
                raw += struct.pack(f'<{width}{code}', *channels[name][row * width:(row + 1) * width])
        packed = _zip(raw) if zipped else raw
        chunks.append(struct.pack('<ii', top, len(packed)) + packed)
    place = len(header) + 8 * len(chunks)
    offsets = b''
    for chunk in chunks:
        offsets += struct.pack('<Q', place)
        place += len(chunk)
    assert size == struct.calcsize(code)
    with open(path, 'wb') as file:
        file.write(header + offsets + b''.join(chunks))


def _zip(raw):
    """OpenEXR's ZIP: halves of the bytes apart, differences, deflate; raw if that is not smaller."""
    parted = raw[0::2] + raw[1::2]
    differences = bytes([parted[0]] + [(b - a + 128) & 255 for a, b in zip(parted, parted[1:])])
    packed = zlib.compress(differences)
    return packed if len(packed) < len(raw) else raw
