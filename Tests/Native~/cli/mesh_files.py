# SPDX-License-Identifier: MIT
"""Mesh files, read by code that shares nothing with their writers."""
import collections
import json
import math
import struct

Mesh = collections.namedtuple("Mesh", "vertices normals faces more")  # more: {name: a row per vertex}

SIZES = {5121: ("B", 1), 5123: ("H", 2), 5125: ("I", 4), 5126: ("f", 4)}  # of glTF's types of components
LENGTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


def linear_of_srgb(byte):
    """The byte of a linear colour, as IEC 61966-2-1 says."""
    value = byte / 255
    return round(255 * (value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4))


def as_float32(number):
    return struct.unpack("<f", struct.pack("<f", number))[0]


def read_glb(path):
    """A GLB file of one mesh, with what the specification demands of it asserted."""
    data = path.read_bytes()
    assert struct.unpack_from("<4sII", data) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON" and size % 4 == 0
    gltf = json.loads(data[20:20 + size])
    at = 20 + size
    size, kind = struct.unpack_from("<I4s", data, at)
    assert kind == b"BIN\0" and size % 4 == 0 and at + 8 + size == len(data)
    binary = data[at + 8:]
    assert gltf["asset"]["version"] == "2.0"
    assert [buffer["byteLength"] for buffer in gltf["buffers"]] == [len(binary)]
    end = 0  # views follow each other, and none of the buffer is left over
    for view in gltf["bufferViews"]:
        assert view["buffer"] == 0 and view["byteOffset"] == end and end % 4 == 0
        end += view["byteLength"]
    assert end == len(binary)

    def rows(number, target):
        accessor = gltf["accessors"][number]
        view = gltf["bufferViews"][accessor["bufferView"]]
        assert view["target"] == target and "byteOffset" not in accessor and "byteStride" not in view
        letter, bytes_each = SIZES[accessor["componentType"]]
        length = LENGTHS[accessor["type"]]
        assert view["byteLength"] == accessor["count"] * length * bytes_each
        assert length * bytes_each % 4 == 0 and (letter != "I" or target == 34963)  # no integers of 32 bits in vertices
        found = list(struct.iter_unpack(f"<{length}{letter}",
                                        binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]))
        for name, best in (("min", min), ("max", max)):
            if name in accessor:
                assert [as_float32(x) for x in accessor[name]] == [best(row[axis] for row in found) for axis in range(3)]
        return accessor, found

    (mesh,) = gltf["meshes"]
    (primitive,) = mesh["primitives"]
    assert primitive["mode"] == 4 and gltf["scenes"][gltf["scene"]]["nodes"] == [0] and gltf["nodes"][0]["mesh"] == 0
    material = gltf["materials"][primitive["material"]]
    assert not material["doubleSided"] and material["pbrMetallicRoughness"]["metallicFactor"] == 0
    attributes = {}
    for name, number in primitive["attributes"].items():
        accessor, attributes[name] = rows(number, 34962)
        assert (accessor.get("normalized", False), name == "COLOR_0") in ((True, True), (False, False))
    assert {"min", "max"} <= gltf["accessors"][primitive["attributes"]["POSITION"]].keys()
    corners = [row[0] for row in rows(primitive["indices"], 34963)[1]]
    vertices, normals = attributes.pop("POSITION"), attributes.pop("NORMAL")
    assert all(len(found) == len(vertices) for found in (normals, *attributes.values()))
    assert max(corners) == len(vertices) - 1 and set(corners) == set(range(len(vertices)))
    assert all(abs(math.hypot(*normal) - 1) < 1e-4 for normal in normals)
    faces = [tuple(corners[i:i + 3]) for i in range(0, len(corners), 3)]
    return Mesh(vertices, normals, faces, {**attributes, "unit": gltf["asset"]["extras"]["unit"]})


PLY_TYPES = {"float": "f", "int": "i", "uint": "I", "uchar": "B"}


def read_any_ply(path):
    """A PLY file with whatever properties, binary or text."""
    header, body = path.read_bytes().split(b"end_header\n", 1)
    names, letters, counts, is_vertex = [], "<", {}, False
    for words in map(str.split, header.decode().splitlines()):
        if words[0] == "element":
            counts[words[1]] = int(words[2])
            is_vertex = words[1] == "vertex"
        elif words[0] == "property" and is_vertex:
            names.append(words[2])
            letters += PLY_TYPES[words[1]]
    if b"format ascii 1.0" in header:
        lines = [tuple(map(float, line.split())) for line in body.decode().splitlines()]
        rows, faces = lines[:counts["vertex"]], [tuple(map(int, line)) for line in lines[counts["vertex"]:]]
    else:
        size = struct.calcsize(letters) * counts["vertex"]
        rows = list(struct.iter_unpack(letters, body[:size]))
        faces = list(struct.iter_unpack("<B3I", body[size:]))
    assert (len(rows), len(faces)) == (counts["vertex"], counts["face"]) and all(face[0] == 3 for face in faces)
    more = {name: [row[k] for row in rows] for k, name in enumerate(names) if k >= 6}
    return Mesh([row[:3] for row in rows], [row[3:6] for row in rows], [face[1:] for face in faces], more)


def read_stl(path):
    """[three corners] of a binary STL file."""
    data = path.read_bytes()
    (count,) = struct.unpack_from("<I", data, 80)
    assert len(data) == 84 + 50 * count
    return [tuple(struct.unpack_from("<3f", data, 84 + 50 * t + 12 * corner) for corner in (1, 2, 3)) for t in range(count)]


def read_off(path):
    """(vertices, colours or Nones, faces)"""
    lines = [line.split() for line in path.read_text().splitlines() if not line.startswith("#")]
    (kind,), (count, face_count, _) = lines[0], map(int, lines[1])
    assert kind in ("OFF", "COFF") and len(lines) == 2 + count + face_count
    rows = lines[2:2 + count]
    colors = [tuple(map(int, row[3:])) or None for row in rows]
    assert all((color is None) == (kind == "OFF") for color in colors)
    faces = [tuple(map(int, row)) for row in lines[2 + count:]]
    assert all(face[0] == 3 for face in faces)
    return [tuple(map(float, row[:3])) for row in rows], colors, [face[1:] for face in faces]


def welded(vertices, faces):
    """The faces with vertices at the same place taken for one."""
    numbers = {}
    places = [numbers.setdefault(vertex, len(numbers)) for vertex in vertices]
    return [tuple(places[i] for i in face) for face in faces]
