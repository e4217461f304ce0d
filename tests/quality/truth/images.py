# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the OpenEXR files Blender writes without compression, and writes PNG. Plain Python: no package to install."""
import array
import struct
import sys
import zlib


def _header(data):
    """Attributes of the header by name, and where the offset table starts."""
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError("not an OpenEXR file")
    position, attributes = 8, {}
    while data[position]:
        name_end = data.index(b"\0", position)
        type_end = data.index(b"\0", name_end + 1)
        size, = struct.unpack_from("<i", data, type_end + 1)
        start = type_end + 5
        attributes[data[position:name_end].decode()] = data[start:start + size]
        position = start + size
    return attributes, position + 1


def _channel_names(block):
    names, position = [], 0
    while block[position]:
        end = block.index(b"\0", position)
        pixel_type, = struct.unpack_from("<i", block, end + 1)
        if pixel_type != 2:
            raise ValueError("only 32-bit floats are read")
        names.append(block[position:end].decode())
        position = end + 17
    return names


def read_exr(path):
    """(width, height, {channel: floats from the top row down}) of an uncompressed 32-bit scan-line file."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, table = _header(data)
    if attributes["compression"] != b"\0":
        raise ValueError(f"{path} is compressed")
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height, names = right - left + 1, bottom - top + 1, _channel_names(attributes["channels"])
    channels = {name: array.array("f", bytes(4 * width * height)) for name in names}
    for offset in struct.unpack_from(f"<{height}Q", data, table):
        row, size = struct.unpack_from("<2i", data, offset)
        line = array.array("f", data[offset + 8:offset + 8 + size])
        if sys.byteorder == "big":
            line.byteswap()
        for i, name in enumerate(names):
            channels[name][(row - top) * width:(row - top + 1) * width] = line[i * width:(i + 1) * width]
    return width, height, channels


def write_png(path, width, height, rgb):
    """`rgb` is bytes, three per pixel, from the top row down."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    rows = b"".join(b"\0" + rgb[3 * width * y:3 * width * (y + 1)] for y in range(height))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
