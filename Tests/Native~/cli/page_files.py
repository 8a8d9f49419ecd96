# SPDX-License-Identifier: MIT
"""The meshes of pages (HTML), read by code that shares nothing with their writer but the description in render/page.h."""
import base64
import collections
import html.parser
import math
import struct

PageMesh = collections.namedtuple("PageMesh", "vertices normals colors openness faces label step")


class Page(html.parser.HTMLParser):
    """title, caption, meshes, and what the scripts of the page are."""

    def __init__(self, path):
        super().__init__()
        self.title, self.caption, self.meshes, self.scripts, self.view, self.addresses = "", "", [], [], {}, []
        self.open = []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        if tag not in ("meta", "input"):
            self.open.append((tag, given))
        if given.get("id") == "view":
            self.view = given
        self.addresses += [given[name] for name in ("src", "href") if name in given]
        if tag == "script":
            self.scripts.append((given, ""))

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag
        if tag == "script" and self.scripts[-1][0].get("class") == "mesh":
            self.meshes.append(read_mesh(*self.scripts.pop()))

    def handle_data(self, data):
        if not self.open:
            return
        tag, given = self.open[-1]
        if tag == "title":
            self.title += data
        elif tag == "script":
            self.scripts[-1] = (given, self.scripts[-1][1] + data)
        elif any(other.get("id") == "caption" for _, other in self.open):
            self.caption += data


def unit_of(x, y):
    x, y = max(x / 127, -1), max(y / 127, -1)
    z = 1 - abs(x) - abs(y)
    if z < 0:
        x, y = math.copysign(1 - abs(y), x), math.copysign(1 - abs(x), y)
    length = math.hypot(x, y, z)
    return (x / length, y / length, z / length)


def read_mesh(given, text):
    data = base64.b64decode(text, validate=True)
    count, triangles = int(given["data-vertices"]), int(given["data-triangles"])
    low, span = ([float(word) for word in given[name].split(" ")] for name in ("data-low", "data-span"))
    vertices = [tuple(low[k] + span[k] * row[k] / 65535 for k in range(3))
                for row in struct.iter_unpack("<3H", data[:6 * count])]
    normals = [unit_of(*row) for row in struct.iter_unpack("<2b", data[6 * count:8 * count])]
    tints = list(struct.iter_unpack("<4B", data[8 * count:12 * count]))
    corners, number, shift, before = [], 0, 0, 0
    for byte in data[12 * count:]:
        number |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            before += -(number + 1) // 2 if number & 1 else number // 2
            corners.append(before)
            number = shift = 0
    assert shift == 0 and len(corners) == 3 * triangles
    faces = [tuple(corners[i:i + 3]) for i in range(0, len(corners), 3)]
    return PageMesh(vertices, normals, [tint[:3] for tint in tints], [tint[3] / 255 for tint in tints], faces,
                    given["data-label"], [width / 65535 for width in span])
