#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws with the package's shaders, by Mesa's software OpenGL, and looks at the pixels.

    shaders_picture_test.py ROOT

Two layers: near, atom 0 on the left and atom 1 on the right; far, atom 2. The light is that of stand_ins; what is asked is whose colour
is seen, and how much of what is behind. Without glslangValidator, spirv-cross or libOSMesa: 77 (skipped).
"""

import ctypes
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import shaders_test
import software_gl

BACKGROUND = (0.2, 0.4, 0.6, 1.0)
RED, GREEN, BLUE = (200, 30, 20, 255), (40, 180, 60, 255), (25, 50, 220, 255)
LEFT, RIGHT = (-0.5, 0.0), (0.5, 0.0)
SIZE = 64
SHADED = ("DepthOfNearestLayer", "ForwardLit", "ForwardBase")
IDENTITY = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)


class Scene:
    def __init__(self, picture, pipeline):
        self.picture = picture
        self.pipeline = pipeline
        self._programs = {}
        self._points, self._owners, self._quads = [], [], []
        for x0, x1, z, owner in ((-0.9, 0.0, -0.5, 0), (0.0, 0.9, -0.5, 1), (-0.9, 0.9, 0.5, 2)):
            first = len(self._points)
            self._points += [(x0, -0.9, z), (x1, -0.9, z), (x1, 0.9, z), (x0, 0.9, z)]
            self._owners += [owner] * 4
            self._quads.append([first, first + 1, first + 2, first, first + 2, first + 3])

    def _program(self, one):
        if one not in self._programs:
            texts = []
            with tempfile.TemporaryDirectory() as folder:
                code = shaders_test.flatten(one.code, [shaders_test.FOLDER, shaders_test.STAND_INS], set())
                for stage in ("vertex", "fragment"):
                    output = os.path.join(folder, stage + ".spv")
                    said = shaders_test.compile_one(code, one.entry(stage), stage, ("DIRECTIONAL",), output)
                    assert said == "", said
                    text = subprocess.run(["spirv-cross", output, "--version", "420", "--no-es"], stdout=subprocess.PIPE,
                                          check=True, text=True).stdout
                    texts.append(re.sub(r"layout\(binding = \d+, std140\)", "layout(std140)", text))
            self._programs[one] = self.picture.program(*texts)
        return self._programs[one]

    def draw(self, shader, colors, by_texture, tint=(1, 1, 1, 1), far_first=False, skip=(), passes=SHADED, uniforms=()):
        """Left and right pixel."""
        self.picture.clear(BACKGROUND)
        self.picture.texture(2, 2, b"".join(bytes(color) for color in colors) + bytes(4))
        quads = [self._quads[2]] + self._quads[:2] if far_first else self._quads
        count = len(self._points)
        attributes = {
            "positionOS": (4, software_gl.FLOAT, b"".join(struct.pack("4f", *point, 1) for point in self._points)),
            "normalOS": (3, software_gl.FLOAT, struct.pack("3f", 0, 0.6, -0.8) * count),
            "color": (4, software_gl.UNSIGNED_BYTE,
                      bytes(4 * count) if by_texture else b"".join(bytes(colors[owner]) for owner in self._owners)),
            "occlusion": (2, software_gl.FLOAT, bytes(8 * count)),
            "owner": (1, software_gl.UNSIGNED_INT, struct.pack(f"{count}I", *(self._owners if by_texture else [0] * count))),
        }
        attributes["vertex"], attributes["normal"] = attributes["positionOS"], attributes["normalOS"]
        uniforms = {"_Color": tint, "_BaseColor": (1, 1, 1, 1), "_QuickSesAtomColorsWidth": (2.0 if by_texture else 0.0,),
                    "unity_ObjectToWorld": IDENTITY, "unity_MatrixVP": IDENTITY, "_LightColor0": (0.8, 0.8, 0.8, 1),
                    "_WorldSpaceLightPos0": (0, 0.6, -0.8, 0), "_WorldSpaceCameraPos": (0, 0, -5, 1), **dict(uniforms)}
        for one in shaders_test.SHADERS[shader][2]:
            if one.pipeline == self.pipeline and one.name in passes:
                if one.name not in skip:
                    self.picture.draw(self._program(one), attributes, sum(quads, []), uniforms, one.state)
        return [self.picture.pixel(*place) for place in (LEFT, RIGHT)]


OPAQUE, TRANSPARENT = "MolecularSurface.shader", "MolecularSurfaceTransparent.shader"


class PictureTest(unittest.TestCase):
    def assert_pixel(self, found, expected, what=""):
        for one, other in zip(found[:3], expected):
            self.assertAlmostEqual(one, other, delta=1.6, msg=f"{what}: {found}, not {expected}")

    def over_background(self, color, alpha):
        return [alpha * one + (1 - alpha) * 255 * behind for one, behind in zip(color, BACKGROUND)]

    def scenes(self):
        picture = software_gl.Picture(SIZE)
        for pipeline in ("universal", "built-in"):
            yield Scene(picture, pipeline)

    def test_colours_are_those_of_the_atoms(self):
        for scene in self.scenes():
            left, right = scene.draw(OPAQUE, (RED, GREEN, BLUE), True)
            self.assertGreater(left[0], 3 * max(left[1:3]))
            self.assertGreater(right[1], 3 * max(right[0], right[2]))
            # The texture is converted by the hardware, vertex colours by the shader: from sRGB, so that ratios are not kept.
            self.assertLess(left[1] / left[0], 0.5 * RED[1] / RED[0])
            by_vertex = scene.draw(OPAQUE, (RED, GREEN, BLUE), False)
            self.assert_pixel(by_vertex[0], left)
            self.assert_pixel(by_vertex[1], right)

    def test_hidden_atoms_let_through(self):
        for scene in self.scenes():
            far = scene.draw(OPAQUE, ((0, 0, 0, 0), (0, 0, 0, 0), BLUE), True)
            for shader in (OPAQUE, TRANSPARENT):
                left, right = scene.draw(shader, (RED, GREEN[:3] + (0,), BLUE), True)
                self.assertGreater(left[0], 3 * left[2])
                self.assert_pixel(right, far[1], shader)
            self.assertGreater(far[1][2], 3 * far[1][0])

    def test_only_the_nearest_layer_shows(self):
        for scene in self.scenes():
            opaque = scene.draw(OPAQUE, (RED, GREEN, BLUE), True)
            for by_texture in (True, False):
                for far_first in (True, False):
                    seen = scene.draw(TRANSPARENT, (RED, GREEN, BLUE), by_texture, (1, 1, 1, 0.5), far_first)
                    for one, color in zip(seen, opaque):
                        self.assert_pixel(one, self.over_background(color, 0.5), f"far first: {far_first}")
            # What would be seen without the first pass: the far layer as well.
            mixed = scene.draw(TRANSPARENT, (RED, GREEN, BLUE), True, (1, 1, 1, 0.5), True, ("DepthOfNearestLayer",))
            self.assertGreater(mixed[0][2], self.over_background(opaque[0], 0.5)[2] + 10)

    def test_alpha_of_atoms_counts(self):
        for scene in self.scenes():
            opaque = scene.draw(OPAQUE, (RED, GREEN, BLUE), True)
            for by_texture in (True, False):
                left, right = scene.draw(
                    TRANSPARENT, (RED[:3] + (102,), GREEN, BLUE), by_texture, (1, 1, 1, 0.8))
                self.assert_pixel(left, self.over_background(opaque[0], 0.4 * 0.8))
                self.assert_pixel(right, self.over_background(opaque[1], 0.8))
                # Too little to be seen hides nothing.
                left, _ = scene.draw(TRANSPARENT, (RED[:3] + (1,), GREEN, BLUE), by_texture)
                self.assertGreater(left[2], 3 * left[0])

    def test_motion_is_that_of_the_object_without_hidden_atoms(self):
        scene = Scene(software_gl.Picture(SIZE), "universal")
        moved = list(IDENTITY)
        moved[12:14] = -0.5, -0.25  # the columns come one after the other
        uniforms = {"unity_MatrixPreviousM": moved, "_NonJitteredViewProjMatrix": IDENTITY, "_PrevViewProjMatrix": IDENTITY,
                    "unity_MotionVectorsParams": (0, 1, 0, 0)}
        left, right = scene.draw(OPAQUE, (RED, (0, 0, 0, 0), (0, 0, 0, 0)), True, passes=("MotionVectors",), uniforms=uniforms)
        self.assert_pixel(left, (0.25 * 255, 0.125 * 255, 0))
        self.assert_pixel(right, [255 * one for one in BACKGROUND[:3]])


def is_missing():
    try:
        ctypes.CDLL("libOSMesa.so.8")
    except OSError:
        return "libOSMesa"
    return next((name for name in ("glslangValidator", "spirv-cross") if not shutil.which(name)), "")


if __name__ == "__main__":
    if is_missing():
        print(f"{is_missing()} is not here (Debian's glslang-tools, spirv-cross, libosmesa6).")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
