# SPDX-License-Identifier: MIT
"""Tests of the mesh files that the quickses program writes: formats, colours, places. What gltf-validator (of npm, with
node, found by NODE_PATH) and admesh say is looked at where they are installed.

usage: cli_mesh_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import json
import math
import os
import shutil
import subprocess
import unittest

import cli_test
from cli_test import CRAMBIN, USAGE, ProgramTest, is_closed, volume_of
from mesh_files import linear_of_srgb, read_any_ply, read_glb, read_off, read_stl, welded

ATOMS = [line for line in CRAMBIN.read_text().splitlines() if line.startswith(("ATOM", "HETATM"))]
JMOL = {"C": (0x90, 0x90, 0x90), "N": (0x30, 0x50, 0xF8), "O": (0xFF, 0x0D, 0x0D), "S": (0xFF, 0xFF, 0x30)}
COLORED = ("element", "chain", "residue", "hydrophobicity", "sequence", "component", "patch", "#C08000")


def element_color(owner):
    return JMOL[ATOMS[owner][76:78].strip()]


def colors_of(ply):
    return list(zip(ply.more["red"], ply.more["green"], ply.more["blue"]))


class MeshTest(ProgramTest):
    def make(self, name, *arguments, spacing=1):
        self.run_cpu(CRAMBIN, "-v", spacing, "-o", name, *arguments)
        return self.folder / name


class Colors(MeshTest):
    def test_of_elements_in_each_format(self):
        ply = read_any_ply(self.make("a.ply", "--color", "element"))
        expected = [element_color(owner) for owner in ply.more["owner"]]
        self.assertEqual(colors_of(ply), expected)
        self.assertEqual(set(expected), set(JMOL.values()))
        glb = read_glb(self.make("a.glb", "--color", "element"))
        self.assertEqual([row[0] for row in glb.more["_ATOM"]], ply.more["owner"])
        self.assertEqual(glb.more["COLOR_0"], [(*map(linear_of_srgb, color), 255) for color in expected])
        places = len(set(ply.vertices))
        _, colors, _ = read_off(self.make("a.off", "--color", "element"))
        self.assertEqual(colors, [(*color, 255) for color in expected[:places]])
        rows = [line.split() for line in self.make("a.obj", "--color", "element").read_text().splitlines()]
        self.assertEqual([tuple(round(255 * float(x)) for x in row[4:]) for row in rows if row[0] == "v"],
                         expected[:places])

    def test_of_each_scheme(self):
        plain = read_any_ply(self.make("a.ply"))
        found = set()
        for name in COLORED:
            ply = read_any_ply(self.make("b.ply", "--color", name))
            self.assertEqual(ply[:3], plain[:3])
            self.assertEqual(ply.more["owner"], plain.more["owner"])
            found.add(tuple(colors_of(ply)))
        self.assertEqual(len(found), len(COLORED))

    def test_one_colour_and_none(self):
        self.assertEqual(set(colors_of(read_any_ply(self.make("a.ply", "--color", "#c08000")))), {(0xC0, 0x80, 0)})
        for extension in ("ply", "obj", "glb", "off", "stl"):
            plain, none = self.make(f"a.{extension}"), self.make(f"b.{extension}", "--color", "none")
            self.assertEqual(plain.read_bytes(), none.read_bytes())

    def test_of_components(self):
        ply = read_any_ply(self.make("a.ply", "--color", "component", "--component-ids"))
        self.assertNotIn("component", read_any_ply(self.make("b.ply", "--color", "component")).more)
        pairs = set(zip(ply.more["component"], colors_of(ply)))
        self.assertGreater(len(pairs), 1)
        self.assertEqual(len({component for component, _ in pairs}), len(pairs))
        self.assertEqual(len({color for _, color in pairs}), len(pairs))
        # The largest piece has the same colour wherever it comes.
        outer = read_any_ply(self.make("c.ply", "--color", "component", "--outer"))
        self.assertEqual(set(colors_of(outer)), {color for component, color in pairs if component ==
                                                 max(set(ply.more["component"]), key=ply.more["component"].count)})
        glb = read_glb(self.make("a.glb", "--component-ids"))
        self.assertEqual([row[0] for row in glb.more["_COMPONENT"]], ply.more["component"])

    def test_the_largest_component_has_the_first_colour(self):
        small, large = "0 0 0 1\n", "20 0 0 3\n"
        for name, text in (("one", large), ("two", small + large), ("owt", large + small)):
            self.write(f"{name}.xyzr", text)
            self.run_cpu(f"{name}.xyzr", "-v", "0.5", "-o", f"{name}.ply", "--color", "component")
        (first,) = set(colors_of(read_any_ply(self.folder / "one.ply")))
        for name in ("two", "owt"):
            ply = read_any_ply(self.folder / f"{name}.ply")
            colors = {(vertex[0] > 10, color) for vertex, color in zip(ply.vertices, colors_of(ply))}
            self.assertEqual(len(colors), 2)
            self.assertIn((True, first), colors)

    def test_of_patches(self):
        kinds = [int(line.split()[8]) for line in self.make("a.vert").read_text().splitlines()[3:]]
        ply = read_any_ply(self.make("a.ply", "--color", "patch", "--hard-edges", "off"))
        pairs = set(zip(kinds, colors_of(ply)))
        self.assertEqual((len(pairs), len({kind for kind, _ in pairs})), (3, 3))

    def test_the_report_names_them(self):
        self.make("a.ply", "--color", "chain", "--json", "a.json", "--center", "--scale", "2")
        settings = json.loads((self.folder / "a.json").read_text())["settings"]
        self.assertEqual([settings[name] for name in ("color", "center", "scale")], ["chain", True, 2])

    def test_what_is_refused(self):
        for arguments, parts in (
                (["-o", "a.stl", "--color", "element"], ["--color", "STL", "no colours", "a.stl"]),
                (["-o", "a.vert", "--color", "element"], ["--color", "MSMS", "no colours", "a.vert"]),
                (["-o", "a.obj", "--occlusion", "on"], ["--occlusion", ".ply", "a.obj"]),
                (["--color", "element"], ["--color", "--output"]),
                (["-o", "a.ply", "--color", "colourful"], ["--color", "colourful", "hydrophobicity", "patch"]),
                (["-o", "a.ply", "--color", "#12345"], ["--color", "#12345", "#RRGGBB"]),
                (["-o", "a.ply", "--color", "#12345G"], ["--color", "#12345G", "#RRGGBB"]),
                (["-o", "a.ply", "--color", "patch", "--method", "grid"], ["--color patch", "--method grid"]),
                (["-o", "a.vert", "--method", "grid"], ["MSMS", "--method grid"]),
                (["-o", "a.obj", "--component-ids"], ["--component-ids", "PLY", "GLB", "a.obj"]),
                (["--component-ids"], ["--component-ids", "--output"]),
                (["-o", "a.stl", "--ascii"], ["--ascii", "PLY", "a.stl"]),
                (["--ascii"], ["--ascii", "--output"]),
                (["--center"], ["--center", "--output"]),
                (["--scale", "2"], ["--scale", "--output"]),
                (["-o", "a.ply", "--scale", "0"], ["--scale", "0"]),
                (["-o", "a.ply", "--scale", "-1"], ["--scale", "-1"]),
                (["-o", "a.ply", "--scale", "nan"], ["--scale", "nan"]),
                (["-o", "a.vert", "--scale", "0.001"], ["--scale", "six digits", "a.vert"]),
                (["-o", "a.off", "--hard-edges", "on"], ["--hard-edges", ".glb"]),
                (["-o", "a.vert", "--hard-edges", "on"], ["--hard-edges", ".glb"])):
            with self.subTest(arguments=arguments):
                self.assert_fails(USAGE, parts, CRAMBIN, *arguments)


class SharpColors(MeshTest):
    """Borders of colours are where their atoms are equally near."""
    RADII = {"C": 1.70, "N": 1.55, "O": 1.52, "S": 1.80}

    def share_of_wrong(self, ply, shift=0.0):
        """The share of triangles in whose middle the nearest atom has another colour."""
        atoms = [([float(line[30:38]) + shift, float(line[38:46]), float(line[46:54])], line[76:78].strip())
                 for line in ATOMS]
        colors, wrong = colors_of(ply), 0
        faces = ply.faces[::7]
        for face in faces:
            middle = [sum(ply.vertices[i][axis] for i in face) / 3 for axis in range(3)]
            _, element = min((math.dist(middle, at) - self.RADII[element], element) for at, element in atoms)
            wrong += JMOL[element] != colors[face[0]]
        return wrong / len(faces)

    def assert_sharp(self, vertices, colors, faces):
        self.assertTrue(all(len({colors[i] for i in face}) == 1 for face in faces))
        self.assertTrue(is_closed(welded(vertices, faces)))

    def test_each_format(self):
        arguments = ["--color", "element", "--sharp-colors"]
        # What is left are borders that a third atom has a part in.
        plain, ply = (read_any_ply(self.make("a.ply", *given, spacing=0.5)) for given in (arguments[:2], arguments))
        self.assertLess(self.share_of_wrong(ply), self.share_of_wrong(plain) / 3)
        plain, ply = (read_any_ply(self.make("a.ply", *given)) for given in (arguments[:2], arguments))
        self.assert_sharp(ply.vertices, colors_of(ply), ply.faces)
        for measure in (cli_test.area_of, volume_of):
            self.assertAlmostEqual(measure(ply.vertices, ply.faces), measure(plain.vertices, plain.faces), delta=1e-2)
        self.assertEqual(colors_of(ply), [element_color(owner) for owner in ply.more["owner"]])
        glb = read_glb(self.make("a.glb", *arguments))
        self.assertEqual(glb[:3], ply[:3])
        self.assert_sharp(glb.vertices, glb.more["COLOR_0"], glb.faces)
        self.assert_sharp(*read_off(self.make("a.off", *arguments)))
        rows = [line.split() for line in self.make("a.obj", *arguments).read_text().splitlines()]
        places = [tuple(row[1:]) for row in rows if row[0] == "v"]
        faces = [tuple(int(word.split("//")[0]) - 1 for word in row[1:]) for row in rows if row[0] == "f"]
        self.assert_sharp([place[:3] for place in places], [place[3:] for place in places], faces)

    def test_the_report_has_the_numbers_of_the_file(self):
        for name in ("a.ply", "a.html"):
            result = self.run_cpu(CRAMBIN, "-v", "1", "-o", name, "--color", "element", "--sharp-colors", "--outer",
                                  "--occlusion", "on", "--json", "a.json", code=None)
            if result.returncode == USAGE and "three.js" in result.stderr:
                continue
            report = json.loads((self.folder / "a.json").read_text())
            self.assertIs(report["settings"]["outer"], True)
            if name == "a.ply":
                ply = read_any_ply(self.folder / name)
            self.assertEqual(report["cut"], {"vertices": len(ply.vertices), "triangles": len(ply.faces)})
            self.assertGreater(report["cut"]["triangles"], report["mesh"]["triangles"])
            self.assertIn(f"{report['mesh']['triangles']} triangles (cut: {report['cut']['triangles']})", result.stdout)
        self.make("a.ply", "--color", "element", "--json", "a.json")
        self.assertNotIn("cut", json.loads((self.folder / "a.json").read_text()))

    def test_frames_have_atoms_of_their_own(self):
        moved = [f"{line[:30]}{float(line[30:38]) + 50:8.3f}{line[38:]}" for line in ATOMS]
        self.write("two.pdb", "".join(f"MODEL     {k:4d}\n" + "\n".join(model) + "\nENDMDL\n"
                                      for k, model in ((1, ATOMS), (2, moved))))
        self.run_cpu("two.pdb", "--trajectory", "two.pdb", "-v", "1", "-o", "f%d.ply", "--color", "element",
                     "--sharp-colors")
        for frame in (0, 1):
            ply = read_any_ply(self.folder / f"f{frame}.ply")
            self.assert_sharp(ply.vertices, colors_of(ply), ply.faces)
            self.assertLess(self.share_of_wrong(ply, 50 * frame), 0.06)

    def test_with_other_flags(self):
        for arguments in (["--method", "grid"], ["--surface", "vdw"], ["--hard-edges", "off"], ["--no-hydrogen", "--outer"]):
            ply = read_any_ply(self.make("a.ply", "--color", "residue", "--sharp-colors", *arguments))
            self.assert_sharp(ply.vertices, colors_of(ply), ply.faces)
        plain = read_any_ply(self.make("a.ply", "--color", "chain"))
        self.assertEqual(read_any_ply(self.make("b.ply", "--color", "chain", "--sharp-colors")), plain)  # one chain
        moved = read_any_ply(self.make("b.ply", "--color", "element", "--sharp-colors", "--center", "--scale", "0.1"))
        self.assert_sharp(moved.vertices, colors_of(moved), moved.faces)
        for column in zip(*moved.vertices):
            self.assertAlmostEqual(min(column) + max(column), 0, delta=1e-5)

    def test_what_is_refused(self):
        for arguments in (["-o", "a.ply"], ["-o", "a.ply", "--color", "patch"], ["-o", "a.ply", "--color", "#102030"], []):
            self.assert_fails(USAGE, ["--sharp-colors"], CRAMBIN, "--sharp-colors", *arguments)


class Formats(MeshTest):
    def test_all_have_the_same_surface(self):
        for hard_edges in ("on", "off"):
            ply = read_any_ply(self.make("a.ply", "--hard-edges", hard_edges))
            glb = read_glb(self.make("a.glb", "--hard-edges", hard_edges))
            self.assertEqual(glb[:3], ply[:3])
            self.assertEqual(glb.more["unit"], "angstrom")
            self.assertEqual(is_closed(glb.faces), hard_edges == "off")
            self.assertTrue(is_closed(welded(glb.vertices, glb.faces)))
            text = read_any_ply(self.make("b.ply", "--ascii", "--hard-edges", hard_edges))
            self.assertEqual(text.faces, ply.faces)
            self.assertEqual(text.more, ply.more)
            for ours, theirs in ((text.vertices, ply.vertices), (text.normals, ply.normals)):
                self.assertTrue(all(math.isclose(a, b, rel_tol=1e-7) for row, other in zip(ours, theirs)
                                    for a, b in zip(row, other)))
        vertices, _, faces = read_off(self.make("a.off"))
        self.assertTrue(is_closed(faces))
        self.assertEqual(faces, ply.faces)
        self.assertLess(max(map(math.dist, vertices, ply.vertices)), 1e-5)

    def test_glb_of_the_grid_method(self):
        glb = read_glb(self.make("a.glb", "--method", "grid", "--color", "chain"))
        self.assertTrue(is_closed(glb.faces))

    def test_msms(self):
        ply = read_any_ply(self.make("a.ply", "--hard-edges", "off"))
        vertices = [line.split() for line in self.make("a.vert").read_text().splitlines()]
        faces = [line.split() for line in (self.folder / "a.face").read_text().splitlines()]
        for lines, count in ((vertices, len(ply.vertices)), (faces, len(ply.faces))):
            self.assertTrue(lines[0][0].startswith("#") and lines[1][0].startswith("#"))
            self.assertEqual((lines[2][0], lines[2][1], lines[2][3]), (str(count), "327", "1.40"))
            self.assertEqual(len(lines), 3 + count)
        self.assertEqual([int(row[7]) - 1 for row in vertices[3:]], ply.more["owner"])
        self.assertEqual({row[8] for row in vertices[3:]}, {"1", "2", "3"})
        for row, vertex, normal in zip(vertices[3:], ply.vertices, ply.normals):
            self.assertLess(math.dist(tuple(map(float, row[:3])), vertex), 1e-5)
            self.assertLess(math.dist(tuple(map(float, row[3:6])), normal), 1e-5)
        self.assertEqual([tuple(int(x) - 1 for x in row[:3]) for row in faces[3:]], ply.faces)
        for row in faces[3:]:
            kinds = [vertices[2 + int(x)][8] for x in row[:3]]
            self.assertIn(row[3], kinds)
            self.assertTrue(kinds.count(row[3]) > 1 or len(set(kinds)) == 3)

    def test_both_files_of_msms_are_outputs(self):
        self.assert_fails(USAGE, ["a.face", "--json"], CRAMBIN, "-o", "a.vert", "--json", "a.face")
        shutil.copy(CRAMBIN, self.folder / "b.face")
        self.assert_fails(USAGE, ["b.face", "input"], "b.face", "-o", "b.vert")
        (self.folder / "c.face").mkdir()
        self.assert_fails(cli_test.OUTPUT, ["c.face", "directory"], CRAMBIN, "-o", "c.vert")

    def test_frames_and_models(self):
        model = "\n".join(ATOMS)
        self.write("two.pdb", "".join(f"MODEL     {k:4d}\n{model}\nENDMDL\n" for k in (1, 2)))
        for arguments, names in ((["--trajectory", "two.pdb", "-o", "f%03d"], ["f000", "f001"]),
                                 (["--model", "all", "-o", "m"], ["m_0001", "m_0002"])):
            for extension in ("glb", "vert"):
                color = ["--color", "sequence"] if extension == "glb" else []
                # Alike with creases or without, which frames have not by default.
                self.run_cpu("two.pdb", "-v", "1", "--creases", "off", *color, *arguments[:-1],
                             f"{arguments[-1]}.{extension}")
                made = [(self.folder / f"{name}.{extension}").read_bytes() for name in names]
                self.assertEqual(made[0], made[1])
                self.assertEqual(self.make(f"one.{extension}", "--creases", "off", *color).read_bytes(), made[0])
                if extension == "vert":
                    for name in names:
                        self.assertEqual((self.folder / f"{name}.face").read_bytes(),
                                         (self.folder / "one.face").read_bytes())


class Printing(MeshTest):
    def test_center_and_scale(self):
        plain = read_any_ply(self.make("a.ply", "--json", "a.json"))
        middle = [(min(column) + max(column)) / 2 for column in zip(*plain.vertices)]
        for arguments, center, scale in ((["--center"], middle, 1), (["--scale", "0.25"], [0, 0, 0], 0.25),
                                         (["--center", "--scale", "1e-10"], middle, 1e-10)):
            moved = read_any_ply(self.make("b.ply", *arguments, "--json", "b.json"))
            self.assertEqual((moved.normals, moved.faces, moved.more), (plain.normals, plain.faces, plain.more))
            for vertex, other in zip(moved.vertices, plain.vertices):
                self.assertLess(math.dist(vertex, [(x - c) * scale for x, c in zip(other, center)]), 1e-5 * scale)
            # The numbers are those of the molecule.
            reports = [json.loads((self.folder / name).read_text()) for name in ("a.json", "b.json")]
            for key in ("area", "volume", "mesh", "components"):
                self.assertEqual(reports[0][key], reports[1][key])

    def test_of_each_format(self):
        corners = [corner for face in read_stl(self.make("a.stl", "--center", "--scale", "0.5")) for corner in face]
        triangles = read_any_ply(self.make("a.ply"))
        low, high = ([best(column) for column in zip(*triangles.vertices)] for best in (min, max))
        for vertices in (corners, read_glb(self.make("a.glb", "--center", "--scale", "0.5")).vertices,
                         read_off(self.make("a.off", "--center", "--scale", "0.5"))[0]):
            for axis, column in enumerate(zip(*vertices)):
                self.assertAlmostEqual(min(column), -(high[axis] - low[axis]) / 4, delta=1e-5)
                self.assertAlmostEqual(max(column), (high[axis] - low[axis]) / 4, delta=1e-5)
        header = self.make("b.vert", "--scale", "0.5").read_text().splitlines()
        self.assertIn("angstrom times 0.5", header[0])
        self.assertEqual(header[2].split()[3], "0.70")
        self.assertEqual(read_glb(self.make("a.glb", "--scale", "0.5")).more["unit"], "angstrom times 0.5")

    @unittest.skipUnless(shutil.which("admesh"), "admesh is not installed")
    def test_admesh_finds_nothing_to_mend(self):
        for arguments in ([], ["--center", "--scale", "0.5"], ["--outer", "--scale", "3"]):
            path = self.make("a.stl", *arguments, spacing=0.4)
            report = subprocess.run(["admesh", path], capture_output=True, encoding="utf-8", check=True).stdout
            for line in ("Total disconnected facets        :     0                   0", "Degenerate facets     :     0",
                         "Edges fixed           :     0", "Facets removed        :     0", "Facets added          :     0",
                         "Facets reversed       :     0", "Backwards edges       :     0", "Normals fixed         :     0"):
                self.assertIn(line, report)


def has_validator():
    node = shutil.which("node")
    return node and subprocess.run([node, "-e", "require('gltf-validator')"], capture_output=True).returncode == 0


@unittest.skipUnless(has_validator(), "node with gltf-validator is not installed (is NODE_PATH set?)")
class KhronosValidator(MeshTest):
    SCRIPT = """
        require('gltf-validator').validateBytes(new Uint8Array(require('fs').readFileSync(process.argv[1])))
            .then(report => console.log(JSON.stringify(report)));"""

    def test_it_has_nothing_to_say(self):
        for arguments in ([], ["--hard-edges", "off"], ["--color", "element", "--component-ids"], ["--method", "grid"],
                          ["--color", "element", "--sharp-colors"], ["--center", "--scale", "1e-10"], ["--surface", "vdw", "--color", "patch"]):
            path = self.make("a.glb", *arguments)
            report = json.loads(subprocess.run(["node", "-e", self.SCRIPT, path], capture_output=True, check=True).stdout)
            self.assertEqual(report["issues"]["messages"], [], arguments)
            self.assertEqual(report["info"]["totalTriangleCount"], len(read_glb(path).faces))


if __name__ == "__main__":
    cli_test.PROGRAM = cli_test.program_to_test(cli_test.PROGRAM, __doc__)
    unittest.main()
