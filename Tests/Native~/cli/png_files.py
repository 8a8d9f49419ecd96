# SPDX-License-Identifier: MIT
"""PNG files of 8 bits per channel, without interlacing, read as the specification says."""
import struct
import zlib


def read_png(path):
    """(width, height, channels, rows of bytes)"""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed, kinds = 8, b"", []
    while at < len(data):
        (size,), kind = struct.unpack_from(">I", data, at), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + size]
        assert struct.unpack_from(">I", data, at + 8 + size)[0] == zlib.crc32(kind + body)
        kinds.append(kind)
        if kind == b"IHDR":
            width, height, depth, color, *rest = struct.unpack(">IIBBBBB", body)
            assert depth == 8 and color in (2, 6) and rest == [0, 0, 0]
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    assert kinds[0] == b"IHDR" and kinds[-1] == b"IEND"
    channels = 3 if color == 2 else 4
    return width, height, channels, unfiltered(zlib.decompress(packed), width * channels, height, channels)


def unfiltered(raw, size, height, channels):
    assert len(raw) == height * (size + 1)
    rows, above = [], bytearray(size)
    for y in range(height):
        kind, row = raw[y * (size + 1)], bytearray(raw[y * (size + 1) + 1:(y + 1) * (size + 1)])
        for x in range(size):
            left = row[x - channels] if x >= channels else 0
            corner = above[x - channels] if x >= channels else 0
            guess = left + above[x] - corner
            distances = [(abs(guess - v), k) for k, v in enumerate((left, above[x], corner))]
            row[x] = row[x] + (0, left, above[x], (left + above[x]) // 2,
                               (left, above[x], corner)[min(distances)[1]])[kind] & 255
        rows.append(row)
        above = row
    return rows


class Picture:
    def __init__(self, path):
        self.width, self.height, self.channels, self.rows = read_png(path)

    def pixel(self, x, y):
        """(red, green, blue, alpha)"""
        return (*self.rows[y][x * self.channels:(x + 1) * self.channels], 255)[:4]

    def alphas(self):
        return [[self.pixel(x, y)[3] for x in range(self.width)] for y in range(self.height)]
