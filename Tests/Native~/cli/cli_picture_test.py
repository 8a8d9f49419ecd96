# SPDX-License-Identifier: MIT
"""Tests of the pictures (PNG) and pages (HTML) that the quickses program makes.

usage: cli_picture_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import colorsys
import json
import math
import os
import subprocess
import unittest

import cli_test
from cli_test import CRAMBIN, IS_WINDOWS, OUTPUT, USAGE, ProgramTest
from mesh_files import read_any_ply
from page_files import Page
from png_files import Picture

FILL = 0.97  # of the picture's side
RED, BLUE = 0, 2  # channels


def atom(number, element, x, y, z, chain="A", name="MOL"):
    return "HETATM%5d  %-3s %3s %s%4d    %8.3f%8.3f%8.3f  1.00  0.00          %2s\n" % (
        number, element, name, chain, number, x, y, z, element)


TWO_ATOMS = atom(1, "O", -4, 0, 0) + atom(2, "N", 4, 0, 0)
RADIUS = {"O": 1.52, "N": 1.55, "C": 1.70}


def project(point, middle, distance, scale, size):
    """Of the pixel where a point is, seen along -z from that distance from the middle."""
    x, y, z = (a - b for a, b in zip(point, middle))
    k = scale * distance / (distance - z)
    return size[0] / 2 + k * x, size[1] / 2 - k * y


class PictureTest(ProgramTest):
    def picture(self, content, *arguments, name="a.png"):
        self.write("in.pdb", content)
        self.run_cpu("in.pdb", "-o", name, *arguments)
        return Picture(self.folder / name)


class Pictures(PictureTest):
    def test_the_silhouette_of_a_sphere(self):
        for width, height in ((120, 120), (150, 90)):
            seen = self.picture(atom(1, "C", 7, -3, 20), "-v", "0.2", "--size", f"{width}x{height}", "--background",
                                "transparent")
            self.assertEqual((seen.width, seen.height, seen.channels), (width, height, 4))
            radius = FILL * min(width, height) / 2
            covered = 0
            for y, row in enumerate(seen.alphas()):
                for x, alpha in enumerate(row):
                    away = math.hypot(x + 0.5 - width / 2, y + 0.5 - height / 2)
                    covered += alpha / 255
                    if away < radius - 1.5:
                        self.assertEqual(alpha, 255, (x, y))
                    elif away > radius + 1.5:
                        self.assertEqual(seen.pixel(x, y), (0, 0, 0, 0))
            self.assertAlmostEqual(covered, math.pi * radius ** 2, delta=0.01 * covered)

    def test_surfaces_that_lie_outside_of_their_atoms(self):
        """They fill the picture and are not cut off."""
        sphere, pair = atom(1, "C", 7, -3, 20), TWO_ATOMS
        for content, arguments in ((sphere, ["--surface", "gaussian"]), (pair, ["--surface", "gaussian"]),
                                   (sphere, ["--surface", "gaussian", "--radius-scale", "2"]),
                                   (pair, ["--surface", "gaussian", "--isovalue", "0.1"]),
                                   (sphere, ["--surface", "sas"]), (pair, ["--surface", "sas", "--probe", "3"]),
                                   (sphere, ["--method", "grid", "-v", "1"])):
            with self.subTest(arguments=arguments):
                seen = self.picture(content, "--size", "80x60", "--background", "transparent", *arguments)
                rows = seen.alphas()
                self.assertEqual(max(rows[0] + rows[-1] + [row[x] for row in rows for x in (0, -1)]), 0)
                columns = [x for x in range(80) if any(row[x] for row in rows)]
                lines = [y for y in range(60) if any(rows[y])]
                filled = max((columns[-1] - columns[0] + 1) / 80, (lines[-1] - lines[0] + 1) / 60)
                self.assertAlmostEqual(filled, FILL, delta=0.03)
        # In frames, the first one leaves some room.
        self.write("m.pdb", "".join("MODEL     %4d\n%sENDMDL\n" % (number, pair) for number in (1, 2)))
        self.run_cpu("m.pdb", "--trajectory", "m.pdb", "-o", "f%d.png", "--surface", "gaussian", "--radius-scale", "2",
                     "--size", "80x60", "--background", "transparent")
        for k in (0, 1):
            rows = Picture(self.folder / f"f{k}.png").alphas()
            self.assertEqual(max(rows[0] + rows[-1] + [row[x] for row in rows for x in (0, -1)]), 0)

    def test_longer_tails_go_to_the_right_and_up(self):
        """A long arm and a short one, from a corner: O is at the end of the long one, N at that of the other."""
        content = "".join(atom(k, "O" if k == 9 else "C", 2 * k, 0, 0) for k in range(10)) + "".join(
            atom(10 + k, "N" if k == 4 else "C", 0, 2 * k, 0) for k in range(1, 5))
        for size, (up, right) in (((160, 80), "NO"), ((80, 160), "ON")):
            seen = self.picture(content, "-v", "1", "--color", "element", "--size", "%dx%d" % size, "--background",
                                "transparent")
            places = {}
            for name, channel in (("O", RED), ("N", BLUE)):
                found = [(x, y) for y in range(seen.height) for x in range(seen.width)
                         if seen.pixel(x, y)[channel] > 60 + max(seen.pixel(x, y)[other] for other in range(3)
                                                                 if other != channel) and seen.pixel(x, y)[3]]
                places[name] = [sum(at[k] for at in found) / len(found) for k in range(2)]
            self.assertLess(places[up][1], places[right][1])
            self.assertGreater(places[right][0], places[up][0])

    def test_zoom_and_the_number_of_samples(self):
        covered = {}
        for samples in (1, 3):
            for zoom in (0.5, 1):
                seen = self.picture(atom(1, "C", 0, 0, 0), "--size", "90x90", "--zoom", zoom, "--samples", samples,
                                    "--background", "transparent")
                alphas = sum(seen.alphas(), [])
                covered[samples, zoom] = sum(alphas)
                self.assertLessEqual(set(alphas), {255 * k // samples ** 2 for k in range(samples ** 2 + 1)}
                                     | {round(255 * k / samples ** 2) for k in range(samples ** 2 + 1)})
            self.assertAlmostEqual(covered[samples, 0.5] / covered[samples, 1], 0.25, delta=0.01)

    def assert_two_atoms(self, seen, places):
        """The atoms are where they should be, in their colours, and nothing is beside them."""
        for channel, (x, y), radius in places:
            self.assertEqual(max(range(3), key=seen.pixel(round(x), round(y)).__getitem__), channel)
            for angle in range(0, 360, 15):
                across, down = math.cos(math.radians(angle)), math.sin(math.radians(angle))
                inside = seen.pixel(int(x + 0.9 * radius * across), int(y + 0.9 * radius * down))
                self.assertEqual((max(range(3), key=inside.__getitem__), inside[3]), (channel, 255))
                outside = [int(x + 1.1 * radius * across), int(y + 1.1 * radius * down)]
                if 0 <= outside[0] < seen.width and 0 <= outside[1] < seen.height:
                    self.assertEqual(seen.pixel(*outside)[3], 0)

    def test_two_atoms_from_all_sides(self):
        size, atoms = (160, 120), {"O": (-4, 0, 0), "N": (4, 1, 2)}
        content = "".join(atom(k, element, *place) for k, (element, place) in enumerate(atoms.items()))
        # From where, with what upwards: the axes to the right, up, and towards the eye.
        for arguments, axes in ((["--view", "z"], ((1, 0, 0), (0, 1, 0), (0, 0, 1))),
                                (["--view", "-z"], ((-1, 0, 0), (0, 1, 0), (0, 0, -1))),
                                (["--view", "-y"], ((1, 0, 0), (0, 0, 1), (0, -1, 0))),
                                (["--view=-y", "--up", "-z"], ((-1, 0, 0), (0, 0, -1), (0, -1, 0))),
                                (["--view", "0,0,3", "--up", "1,0,0"], ((0, -1, 0), (1, 0, 0), (0, 0, 1))),
                                (["--view", "z", "--turn", "0,90"], ((1, 0, 0), (0, 0, -1), (0, 1, 0))),
                                (["--view", "y", "--up", "z", "--turn", "180,0"], ((1, 0, 0), (0, 0, 1), (0, -1, 0)))):
            with self.subTest(arguments=arguments):
                seen = self.picture(content, "-v", "0.3", "--color", "element", "--size", "%dx%d" % size, "--background",
                                    "transparent", *arguments)
                turned = {element: tuple(sum(a * b for a, b in zip(place, axis)) for axis in axes)
                          for element, place in atoms.items()}
                low, high = ([best(turned[e][k] + sign * RADIUS[e] for e in atoms) for k in range(3)]
                             for best, sign in ((min, -1), (max, 1)))
                middle = [(a + b) / 2 for a, b in zip(low, high)]
                distance = 6 * max(math.dist(turned[e], middle) + RADIUS[e] for e in atoms)
                # The scale so that the spheres' outlines just fit.
                half = [0, 0]
                for element in atoms:
                    x, y, z = (a - b for a, b in zip(turned[element], middle))
                    for k, across in enumerate((x, y)):
                        angle = math.atan2(abs(across), distance - z) + math.asin(
                            RADIUS[element] / math.hypot(across, distance - z))
                        half[k] = max(half[k], distance * math.tan(angle))
                scale = FILL / 2 * min(size[0] / half[0], size[1] / half[1])
                places = []
                for element, channel in (("O", RED), ("N", BLUE)):
                    at = turned[element]
                    if any(abs(at[0] - b[0]) + abs(at[1] - b[1]) < 5 and b[2] > at[2] for b in turned.values()):
                        continue  # the other one is in front
                    radius = RADIUS[element] * scale * distance / (distance - at[2] + middle[2])
                    places.append((channel, project(at, middle, distance, scale, size), radius))
                self.assertTrue(places)
                self.assert_two_atoms(seen, places)

    def test_upwards_along_the_view(self):
        for axis in "xyz":  # then something else is upwards
            seen = self.picture(TWO_ATOMS, "--size", "60x40", "--background", "transparent", "--view", axis, "--up", axis)
            self.assertGreater(sum(map(sum, seen.alphas())), 255 * 100)

    def test_the_longest_axis_lies_along_the_longer_side(self):
        for place in ((1, 0, 0), (0.6, 0.8, 0), (0, 0.6, 0.8)):
            content = "".join(atom(k, "C", *(3 * k * x for x in place)) for k in range(8))
            for size in ((160, 80), (80, 160)):
                seen = self.picture(content, "-v", "1", "--size", "%dx%d" % size, "--background", "transparent")
                across = sum(any(row[x] for row in seen.alphas()) for x in range(seen.width))
                down = sum(any(row) for row in seen.alphas())
                self.assertGreater(max(across, down), 0.94 * 160)
                self.assertEqual(across > down, size[0] > size[1])

    def test_backgrounds(self):
        content = atom(1, "C", 0, 0, 0)
        white = self.picture(content, "--size", "40x40")
        self.assertEqual((white.channels, white.pixel(0, 0)), (3, (255, 255, 255, 255)))
        self.assertEqual(self.picture(content, "--size", "40x40", "--background", "#204060").pixel(39, 39),
                         (0x20, 0x40, 0x60, 255))

    def test_the_same_bytes_each_time(self):
        files = []
        for threads in (1, 1, 3):
            self.run_cpu(CRAMBIN, "-v", "1", "-o", "a.png", "--size", "200x150", "--threads", threads)
            files.append((self.folder / "a.png").read_bytes())
        self.assertEqual(len(set(files)), 1)

    @unittest.skipIf(IS_WINDOWS or os.environ.get("QUICKSES_TEST_SANITIZE"), "memory is counted otherwise")
    def test_memory_does_not_grow_with_samples_and_threads(self):
        self.write("in.pdb", atom(1, "C", 0, 0, 0))
        process = subprocess.Popen([cli_test.PROGRAM, "in.pdb", "-o", "a.png", "--size", "16384x16", "--samples", "16",
                                    "--threads", "8", "--backend", "cpu", "--quiet"], cwd=self.folder)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = status
        self.assertEqual(status, 0)
        # A sample takes 8 bytes, so the whole picture would take 537 MB.
        self.assertLess(usage.ru_maxrss * 1024, 400e6)

    def test_a_part_of_a_large_picture_is_like_a_small_one(self):
        """Bands that are drawn apart fit together: a closed surface has no holes."""
        self.run_cpu(CRAMBIN, "-v", "1", "-o", "a.png", "--size", "333x257", "--samples", "1", "--zoom", "4",
                     "--background", "transparent")
        seen = Picture(self.folder / "a.png")
        self.assertEqual({seen.pixel(x, y)[3] for x in range(100, 233) for y in range(80, 180)}, {255})

    def test_default_colours(self):
        def hues(*arguments, content):
            seen = self.picture(content, "--view", "z", "--size", "60x40", *arguments)
            found = [seen.pixel(x, 20) for x in range(seen.width)]
            return {round(6 * colorsys.rgb_to_hsv(*(v / 255 for v in pixel[:3]))[0]) % 6 for pixel in found
                    if max(pixel[:3]) - min(pixel[:3]) > 60}
        self.assertEqual(hues(content=TWO_ATOMS), {0, 4})  # of elements
        chains = atom(1, "C", -4, 0, 0, "A") + atom(2, "C", 4, 0, 0, "B")
        self.assertEqual(hues("--color", "element", content=chains), set())
        self.assertEqual(len(hues(content=chains)), 2)
        self.assertEqual(hues("--color", "none", content=chains), set())
        self.write("in.pdb", chains)
        self.run_cpu("in.pdb", "-o", "a.png", "--json", "a.json")
        self.assertEqual(json.loads((self.folder / "a.json").read_text())["settings"]["color"], "chain")

    def test_occlusion_makes_clefts_darker(self):
        def brightness(*arguments):
            self.run_cpu(CRAMBIN, "-v", "1", "-o", "a.png", "--size", "80x60", "--color", "none",
                         "--background", "#000000", *arguments)
            return sum(sum(row) for row in Picture(self.folder / "a.png").rows)
        default, on, off = brightness(), brightness("--occlusion", "on"), brightness("--occlusion", "off")
        self.assertEqual(default, on)
        self.assertLess(on, 0.97 * off)

    def test_edges_are_lines(self):
        self.run_cpu(CRAMBIN, "-v", "2", "-o", "a.png", "--size", "200x150", "--color", "none")
        self.run_cpu(CRAMBIN, "-v", "2", "-o", "b.png", "--size", "200x150", "--color", "none", "--edges")
        plain, lined = Picture(self.folder / "a.png"), Picture(self.folder / "b.png")
        darker = sum(lined.pixel(x, y)[0] < plain.pixel(x, y)[0] - 20 for x in range(200) for y in range(150))
        same = sum(lined.pixel(x, y)[0] > plain.pixel(x, y)[0] - 20 for x in range(200) for y in range(150))
        self.assertGreater(darker, 1000)
        self.assertGreater(same, darker)

    def test_many_files(self):
        models = "".join("MODEL     %4d\n%sENDMDL\n" % (k, atom(1, "C", -3 - k, 0, 0) + atom(2, "O", 3 + k, 0, 0))
                         for k in (1, 2))
        self.write("m.pdb", models)
        small = ["--size", "64x48", "-v", "1"]
        self.run_cpu("m.pdb", "--model", "all", "-o", "m.png", *small)
        self.run_cpu("m.pdb", "--trajectory", "m.pdb", "-o", "f%02d.png", *small)
        self.run_cpu("m.pdb", CRAMBIN, "-o", "%s_one.png", *small)
        names = {path.name for path in self.folder.glob("*.png")}
        self.assertEqual(names, {"m_0001.png", "m_0002.png", "f00.png", "f01.png", "m_one.png", "1CRN_one.png"})
        # Seen the same way: the second is larger on the same scale.
        for first, second in (("m_0001.png", "m_0002.png"), ("f00.png", "f01.png")):
            widths = []
            for name in (first, second):
                seen = Picture(self.folder / name)
                columns = [x for x in range(64) if any(seen.pixel(x, y)[:3] != (255,) * 3 for y in range(48))]
                widths.append(columns[-1] - columns[0])
            self.assertGreater(widths[1], widths[0] * 1.1)

    def test_models_of_other_atoms_are_seen_from_the_same_side(self):
        first = [("C", 3 * k, 0, 0) for k in range(8)] + [("O", 0, 3 * k, 0) for k in range(1, 4)]
        second = first + [("O", 0, 3 * k, 0) for k in range(4, 16)]
        self.write("m.pdb", "".join("MODEL     %4d\n%sENDMDL\n" % (
            number, "".join(atom(k, *of_one) for k, of_one in enumerate(atoms))) for number, atoms in
            ((1, first), (2, second))))
        self.run_cpu("m.pdb", "--model", "all", "-v", "1", "-o", "m.png", "--size", "90x90", "--background", "transparent",
                     "--color", "element", "--zoom", "0.5")
        widths = []
        for number in (1, 2):
            seen = Picture(self.folder / f"m_000{number}.png")
            grey = [(x, y) for y in range(90) for x in range(90) if seen.pixel(x, y)[3] == 255
                    and max(seen.pixel(x, y)[:3]) - min(seen.pixel(x, y)[:3]) < 30]
            across, down = (max(at[k] for at in grey) - min(at[k] for at in grey) for k in range(2))
            self.assertGreater(across, 2 * down)  # the arm of carbon
            widths.append(across)
        self.assertAlmostEqual(widths[0], widths[1], delta=3)

    def test_standard_output(self):
        self.run_cpu(CRAMBIN, "-v", "1", "-o", "a.png", "--size", "50x40")
        made = subprocess.run([cli_test.PROGRAM, CRAMBIN, "-v", "1", "-o", "-", "--output-format", "png", "--size", "50x40",
                               "--backend", "cpu"], stdout=subprocess.PIPE, check=True).stdout
        self.assertEqual(made, (self.folder / "a.png").read_bytes())

    def test_directions_of_any_length_and_whole_turns(self):
        def picture(*arguments):
            self.run_cpu(CRAMBIN, "-v", "2", "-o", "a.png", "--size", "40x40", *arguments)
            return (self.folder / "a.png").read_bytes()
        expected = picture("--view", "1,2,-3", "--up", "0,1,0.5")
        for view, up in (("0.25,0.5,-0.75", "0,4,2"), ("1e-30,2e-30,-3e-30", "0,1e300,5e299"), ("1e300,2e300,-3e300", "0,2e-310,1e-310")):
            self.assertEqual(picture("--view", view, "--up", up), expected, view)
        expected = picture("--turn", "280,-80")
        self.assertNotEqual(expected, picture("--turn", "0,0"))
        for turn in ("1000,-800", "1e9,-1000000160"):  # 280 and 2777777 whole turns
            self.assertEqual(picture("--turn", turn), expected, turn)

    def test_what_is_refused(self):
        for arguments, parts in (
                (["-o", "a.ply", "--size", "10x10"], ["--size", "a.ply"]),
                (["--view", "x"], ["--view", "no --output"]),
                (["-o", "a.html", "--samples", "2"], ["--samples", ".png", "a.html"]),
                (["-o", "a.png", "--size", "10"], ["--size", "'10'", "1024x768"]),
                (["-o", "a.png", "--size", "0x10"], ["--size", "0x10"]),
                (["-o", "a.png", "--size", "100000x10"], ["--size", "16384"]),
                (["-o", "a.png", "--size", "10x16385"], ["--size", "16384"]),
                (["-o", "a.png", "--background", "blue"], ["--background", "blue", "transparent"]),
                (["-o", "a.png", "--view", "0,0,0"], ["--view", "'0,0,0'", "all of it is 0"]),
                (["-o", "a.png", "--view", "w"], ["--view", "'w'"]),
                (["-o", "a.png", "--up", "1,2"], ["--up", "1,2"]),
                (["-o", "a.png", "--turn", "nan,0"], ["--turn", "nan"]),
                (["-o", "a.png", "--zoom", "0"], ["--zoom"]),
                (["-o", "a.png", "--samples", "17"], ["--samples", "16"]),
                (["-o", "a.png", "--scale", "2"], ["--scale", "a.png"]),
                (["-o", "a.png", "--center"], ["--center", "a.png"]),
                (["-o", "a.png", "--ascii"], ["--ascii", "a.png"]),
                (["-o", "a.png", "--component-ids"], ["--component-ids", "a.png"])):
            with self.subTest(arguments=arguments):
                self.assert_fails(USAGE, parts, CRAMBIN, *arguments)


class Pages(PictureTest):
    def setUp(self):
        super().setUp()
        self.write("in.pdb", atom(1, "C", 0, 0, 0))
        probe = self.run_without_check("in.pdb", "-o", "probe.html")
        if probe.returncode == USAGE and "three.js" in probe.stderr:
            self.skipTest("this build has no three.js")

    def run_without_check(self, *arguments):
        return subprocess.run([cli_test.PROGRAM, *arguments], cwd=self.folder, capture_output=True, encoding="utf-8")

    def assert_same(self, mesh, ply):
        """The page's mesh is that of the PLY file but for rounding."""
        self.assertEqual(mesh.faces, ply.faces)
        self.assertEqual(len(mesh.vertices), len(ply.vertices))
        shift = [a - b for a, b in zip(ply.vertices[0], mesh.vertices[0])]  # the page has the middle at the origin
        for at, exact in zip(mesh.vertices, ply.vertices):
            for k in range(3):
                self.assertLessEqual(abs(at[k] + shift[k] - exact[k]), 1.01 * mesh.step[k] + 1e-5)
        for found, exact in zip(mesh.normals, ply.normals):
            self.assertGreater(sum(a * b for a, b in zip(found, exact)), math.cos(math.radians(1)))
        self.assertEqual(mesh.colors, list(zip(ply.more["red"], ply.more["green"], ply.more["blue"])))
        for found, exact in zip(mesh.openness, ply.more["occlusion"]):
            self.assertLessEqual(abs(found - exact), 0.5 / 255 + 1e-6)

    def test_the_mesh_is_that_of_the_ply_file(self):
        arguments = [CRAMBIN, "-v", "0.7", "--color", "residue", "--sharp-colors", "--occlusion", "on", "--outer"]
        self.run_cpu(*arguments, "-o", "a.ply")
        self.run_cpu(*arguments, "-o", "a.html")
        page = Page(self.folder / "a.html")
        self.assertEqual(len(page.meshes), 1)
        self.assert_same(page.meshes[0], read_any_ply(self.folder / "a.ply"))
        self.assertEqual(page.title, "1CRN.pdb")
        self.assertIn("327 atoms", page.caption)
        self.assertEqual(page.addresses, [])

    def test_frames_are_in_order(self):
        models = "".join("MODEL     %4d\n%sENDMDL\n" % (k, atom(1, "C", 0, 0, 0) + atom(2, "O", k, 0, 0))
                         for k in range(1, 13))
        self.write("m.pdb", models)
        self.run_cpu("m.pdb", "--trajectory", "m.pdb", "-o", "a.html", "-v", "0.5", "--color", "element", "--workers", "4")
        self.run_cpu("m.pdb", "--model", "all", "-o", "b.html", "-v", "0.5", "--color", "element", "--creases", "off")
        frames, models = Page(self.folder / "a.html").meshes, Page(self.folder / "b.html").meshes
        self.assertEqual([mesh.label for mesh in frames], [f"frame {k}" for k in range(12)])
        self.assertEqual([mesh.label for mesh in models], [f"model {k}" for k in range(1, 13)])
        for k in range(12):
            self.assertEqual(frames[k][:5], models[k][:5])
            width = max(v[0] for v in frames[k].vertices) - min(v[0] for v in frames[k].vertices)
            self.assertAlmostEqual(width, max(1.7, k + 1 + 1.52) + 1.7, delta=0.02)
        self.run_cpu("m.pdb", "--trajectory", "m.pdb", "--frames", "2:8:3", "-o", "c.html", "-v", "0.5")
        self.assertEqual([mesh.label for mesh in Page(self.folder / "c.html").meshes], ["frame 2", "frame 5"])

    @unittest.skipIf(IS_WINDOWS, "no such names there")
    def test_names_do_not_run(self):
        name = "<script>alert(1)&amp;\"'.pdb"
        self.write(name, atom(1, "C", 0, 0, 0))
        self.run_cpu(name, "-o", "a.html")
        page = Page(self.folder / "a.html")
        self.assertEqual(page.title, name)
        self.assertTrue(page.caption.startswith(name))
        self.assertEqual(sum("alert(1)" in text for _, text in page.scripts), 0)

    def test_the_view_and_the_background(self):
        self.run_cpu("in.pdb", "-o", "a.html", "--view", "x", "--background", "#102030")
        view = Page(self.folder / "a.html").view
        self.assertEqual([float(word) for word in view["data-toward"].split()], [1, 0, 0])
        self.assertEqual([float(word) for word in view["data-up"].split()], [0, 0, 1])
        self.assertEqual(view["data-background"], "#102030")
        self.assertAlmostEqual(float(view["data-distance"]), 6 * 1.7, delta=1e-4)

    def test_an_output_that_is_an_input_is_refused(self):
        self.write("m.html", atom(1, "C", 0, 0, 0))
        self.run_program("m.html", "--input-format", "pdb", "--trajectory", "m.html", "-o", "m.html", code=USAGE)

    def test_nothing_is_left_where_it_can_not_be_written(self):
        self.assert_fails(OUTPUT, ["nowhere/a.html"], CRAMBIN, "-o", "nowhere/a.html")


if __name__ == "__main__":
    cli_test.PROGRAM = cli_test.program_to_test("", __doc__)
    unittest.main()
