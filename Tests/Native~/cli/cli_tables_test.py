# SPDX-License-Identifier: MIT
"""Tests of what the program tells in numbers: quickses measure, quickses cavities, areas per atom and per residue.

usage: cli_tables_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import csv
import json
import math
import struct
import unittest

import cli_test
from cli_test import CRAMBIN, DATA, INPUT, OK, OUTPUT, USAGE, ProgramTest, is_closed, read_ply
from trajectory_files import chain_of, dcd_bytes, moving, pdb_text, with_nan

FRAMES_FAILED = 6
RESIDUE = ["chain", "residue_number", "insertion_code", "residue_name"]
ATOM = ["atom", *RESIDUE, "atom_name", "radius_A"]


def rows_of(text, columns):
    reader = csv.DictReader(text.splitlines())
    rows = list(reader)
    assert reader.fieldnames == columns, reader.fieldnames
    return rows


def total(rows, column):
    return sum(float(row[column]) for row in rows)


def crambin_atoms():
    """Chain, number, name of residue, name of atom and position of each ATOM record."""
    for line in CRAMBIN.read_text().splitlines():
        if line.startswith("ATOM"):
            yield (line[21], line[22:26].strip(), line[17:20].strip(), line[12:16].strip(),
                   tuple(float(line[k:k + 8]) for k in (30, 38, 46)))


def shell_pdb(centers=((0, 0, 0),), more=()):
    """Hollow balls of carbon, each a chain of residues of ten atoms."""
    atoms, positions = [], []
    for x, y, z in centers:
        for i in range(900):
            up = 1 - (2 * i + 1) / 900
            turn = math.pi * (3 - math.sqrt(5)) * i
            across = 8 * math.sqrt(1 - up * up)
            atoms.append(("ATOM", "C", "ALA", len(atoms) // 10 + 1))
            positions.append((x + across * math.cos(turn), y + across * math.sin(turn), z + 8 * up))
    for position in more:
        atoms.append(("ATOM", "C", "GLY", len(atoms) // 10 + 2))
        positions.append(position)
    return pdb_text(atoms, positions), positions


class TablesTest(ProgramTest):
    def measure(self, *arguments):
        return json.loads(self.run_cpu("measure", *arguments, "--json", "-").stdout)

    def numbers(self, *arguments):
        return {entry["surface"]: entry for entry in self.measure(*arguments)["surfaces"]}


class Measure(TablesTest):
    def test_a_ball_and_two_that_overlap(self):
        self.write("one.xyzr", "3 -4 5 2\n")
        found = self.numbers("one.xyzr")
        for surface, radius in (("sas", 3.4), ("vdw", 2.0)):
            self.assertAlmostEqual(found[surface]["area"], 4 * math.pi * radius ** 2, delta=2e-5)
            self.assertAlmostEqual(found[surface]["volume"], 4 / 3 * math.pi * radius ** 3, delta=2e-5)
            self.assertEqual(found[surface]["measured_by"], "atoms")
        self.write("two.xyzr", "0 0 0 2\n2 0 0 2\n")
        vdw = self.numbers("two.xyzr", "--surface", "vdw")["vdw"]
        self.assertAlmostEqual(vdw["area"], 2 * 2 * math.pi * 2 * 3, delta=1e-4)  # caps of height 3
        self.assertAlmostEqual(vdw["volume"], 2 * math.pi * 9 * (6 - 3) / 3, delta=1e-4)

    def test_which_surfaces(self):
        for text, expected in ((None, ["sas", "vdw"]), ("vdw", ["vdw"]), ("ses", ["ses"]), ("ses,sas", ["ses", "sas"]),
                               ("vdw,sas,ses", ["vdw", "sas", "ses"])):
            arguments = ["--surface", text] if text else []
            report = self.measure(CRAMBIN, *arguments)
            self.assertEqual([entry["surface"] for entry in report["surfaces"]], expected)
            self.assertEqual("spacing" in report["settings"], "ses" in expected)
            self.assertEqual(report["atoms"], 327)
            self.assertEqual(report["settings"]["probe"], 1.4)
            self.assertGreater(report["time_ms"]["compute"], 0)
        by = {name: entry["measured_by"] for name, entry in self.numbers(CRAMBIN, "--surface", "ses,sas,vdw").items()}
        self.assertEqual(by, {"ses": "normals", "sas": "atoms", "vdw": "atoms"})
        for text in ("", "ses,", "ses,ses", "gauss", "ses sas"):
            self.assert_fails(USAGE, ["--surface"], "measure", CRAMBIN, "--surface", text)

    def test_spacing_does_not_matter_where_there_is_no_mesh(self):
        self.assertEqual(self.numbers(CRAMBIN), self.numbers(CRAMBIN, "-v", "3"))
        self.assertNotEqual(self.numbers(CRAMBIN), self.numbers(CRAMBIN, "--probe", "1.5"))
        self.assertNotEqual(self.numbers(CRAMBIN), self.numbers(CRAMBIN, "--select", "//A/1-20"))

    def test_ses_is_that_of_the_mesh(self):
        mesh = json.loads(self.run_cpu(CRAMBIN, "-v", "0.8", "--json", "-").stdout)
        ses = self.numbers(CRAMBIN, "-v", "0.8", "--surface", "ses")["ses"]
        self.assertEqual(ses["measured_by"], mesh["measured_by"])
        for name in ("area", "volume"):  # the latter are added up by components
            self.assertAlmostEqual(ses[name] / mesh[name], 1, places=12)

    def test_threads_do_not_matter(self):
        expected = self.run_cpu("measure", CRAMBIN, "--per-atom", "-", "--threads", "1").stdout
        for threads in (2, 5):
            self.assertEqual(self.run_cpu("measure", CRAMBIN, "--per-atom", "-", "--threads", threads).stdout, expected)

    def test_the_table_for_people(self):
        lines = self.run_cpu("measure", CRAMBIN, "--surface", "sas,ses").stdout.splitlines()
        self.assertEqual(len(lines), 4)
        self.assertIn("327 atoms", lines[0])
        self.assertRegex(lines[2], r"^sas +\d+\.\d\d +\d+\.\d\d +atoms, exactly$")
        self.assertRegex(lines[3], r"^ses +\d+\.\d\d +\d+\.\d\d +a mesh of spacing 0.5 Å$")
        result = self.run_cpu("measure", CRAMBIN, "--quiet")
        self.assertEqual(result.stdout + result.stderr, "")

    def test_all_models(self):
        atoms, positions = chain_of(6)
        frames = moving(positions, 3)
        self.write("many.pdb", "".join(f"MODEL     {k + 1:4d}\n" + pdb_text(atoms, frame).replace("END\n", "ENDMDL\n")
                                       for k, frame in enumerate(frames)) + "END\n")
        result = self.run_cpu("measure", "many.pdb", "--model", "all", "--json", "a.json", "--per-residue", "-")
        reports = [json.loads(line) for line in (self.folder / "a.json").read_text().splitlines()]
        self.assertEqual([report["model"] for report in reports], [1, 2, 3])
        rows = rows_of(result.stdout, ["model", *RESIDUE, "sas_area_A2", "vdw_area_A2"])
        for k, frame in enumerate(frames):
            self.write("alone.pdb", pdb_text(atoms, frame))
            alone = self.numbers("alone.pdb")
            self.assertEqual(alone, {entry["surface"]: entry for entry in reports[k]["surfaces"]})
            self.assertAlmostEqual(total([row for row in rows if row["model"] == str(k + 1)], "sas_area_A2"),
                                   alone["sas"]["area"], delta=1e-4)
        self.assertEqual(self.run_cpu("measure", "many.pdb", "--model", "all").stdout.count("model"), 3)


class Areas(TablesTest):
    def test_atoms_and_residues_add_up(self):
        self.run_cpu("measure", CRAMBIN, "--surface", "sas,vdw,ses", "--per-atom", "a.csv", "--per-residue", "r.csv",
                     "--json", "a.json")
        found = {entry["surface"]: entry for entry in json.loads((self.folder / "a.json").read_text())["surfaces"]}
        columns = ["sas_area_A2", "vdw_area_A2", "ses_area_A2"]
        atoms = rows_of((self.folder / "a.csv").read_text(), ATOM + columns)
        residues = rows_of((self.folder / "r.csv").read_text(), RESIDUE + columns)
        self.assertEqual(len(residues), 46)
        for row, (number, (chain, residue, residue_name, name, _)) in zip(atoms, enumerate(crambin_atoms())):
            self.assertEqual([row[c] for c in ATOM[:-1]], [str(number), chain, residue, "", residue_name, name])
            self.assertEqual(float(row["radius_A"]), {"C": 1.7, "N": 1.55, "O": 1.52, "S": 1.8}[name[0]])
        self.assertEqual(len(atoms), 327)
        for column in columns:
            area = found[column[:3]]["area"]
            self.assertAlmostEqual(total(atoms, column), area, delta=1e-6 * len(atoms))
            self.assertAlmostEqual(total(residues, column), area, delta=1e-6 * len(atoms))
            for row in residues:
                of_it = [atom for atom in atoms if all(atom[c] == row[c] for c in RESIDUE)]
                self.assertAlmostEqual(total(of_it, column), float(row[column]), delta=1e-6 * len(of_it))
        self.assertTrue(any(float(row["sas_area_A2"]) == 0 for row in residues))  # buried ones have rows too

    def test_of_the_mesh_that_is_made(self):
        for surface in ("sas", "vdw", "ses"):
            result = self.run_cpu(CRAMBIN, "-v", "0.8", "--surface", surface, "-o", "a.ply", "--json", "a.json", "--hard-edges", "off",
                                  "--per-residue", "-")
            report = json.loads((self.folder / "a.json").read_text())
            rows = rows_of(result.stdout, RESIDUE + [f"{surface}_area_A2"])
            self.assertEqual(len(rows), 46)
            self.assertAlmostEqual(total(rows, f"{surface}_area_A2"), report["area"], delta=1e-4)
            self.assertTrue(is_closed(read_ply(self.folder / "a.ply")[3]))

    def test_names_that_need_quotes_and_insertion_codes(self):
        line = "ATOM  {:5d}  CA  {:3s} {}{:4d}{}   {:8.3f}{:8.3f}{:8.3f}  1.00  0.00           C\n"
        self.write("odd.pdb", line.format(1, "A,B", '"', 7, " ", 0, 0, 0) + line.format(2, "A,B", '"', 7, "C", 9, 0, 0)
                   + line.format(3, "GLY", "B", -3, " ", 18, 0, 0) + "END\n")
        rows = rows_of(self.run_cpu("measure", "odd.pdb", "--surface", "vdw", "--per-residue", "-").stdout,
                       RESIDUE + ["vdw_area_A2"])
        self.assertEqual([[row[c] for c in RESIDUE] for row in rows],
                         [['"', "7", "", "A,B"], ['"', "7", "C", "A,B"], ["B", "-3", "", "GLY"]])
        for row in rows:
            self.assertAlmostEqual(float(row["vdw_area_A2"]), 4 * math.pi * 1.7 ** 2, delta=1e-4)

    def test_atoms_are_those_of_the_file(self):
        rows = rows_of(self.run_cpu("measure", CRAMBIN, "--select", "//A/2-3", "--per-atom", "-").stdout,
                       ATOM + ["sas_area_A2", "vdw_area_A2"])
        expected = [k for k, atom in enumerate(crambin_atoms()) if atom[1] in ("2", "3")]
        self.assertEqual([int(row["atom"]) for row in rows], expected)

    def test_files_without_names(self):
        self.write("one.xyzr", "0 0 0 2\n9 0 0 1\n")
        self.assert_fails(USAGE, ["--per-residue", "one.xyzr"], "measure", "one.xyzr", "--per-residue", "r.csv")
        self.assert_fails(USAGE, ["--per-residue", "one.xyzr"], "one.xyzr", "--per-residue", "-")
        rows = rows_of(self.run_cpu("measure", "one.xyzr", "--surface", "vdw", "--per-atom", "-").stdout,
                       ATOM + ["vdw_area_A2"])
        self.assertEqual([[row["atom"], row["chain"], row["residue_number"], row["radius_A"]] for row in rows],
                         [["0", "", "", "2.000"], ["1", "", "", "1.000"]])

    def test_flags_that_do_not_go_together(self):
        for arguments, parts in (
                ([CRAMBIN, "--per-atom", "-", "--per-residue", "-"], ["--per-atom", "--per-residue", "standard output"]),
                ([CRAMBIN, "--per-residue", "-", "--json", "-"], ["--per-residue", "--json", "standard output"]),
                ([CRAMBIN, "--per-atom", "a.csv", "--per-residue", "./a.csv"], ["--per-residue", "--per-atom", "a.csv"]),
                ([CRAMBIN, "--per-atom", "a.csv", "--json", "a.csv"], ["--json", "--per-atom", "a.csv"]),
                ([CRAMBIN, "--method", "grid", "--per-atom", "a.csv"], ["--per-atom", "exact"]),
                (["measure", CRAMBIN, "--method", "grid"], ["--method"]),
                (["measure", CRAMBIN, "-o", "a.ply"], ["-o"]),
                (["measure", CRAMBIN, "--csv", "a.csv"], ["--csv", "--trajectory"]),
                (["measure"], ["no input"]),
                (["--quiet", "measure", CRAMBIN], ["measure", "behind"]),
                (["cavities", CRAMBIN, "--model", "all"], ["--model"]),
                (["cavities", CRAMBIN, "--csv", "-", "--json", "-"], ["--csv", "--json", "standard output"]),
                (["cavities", CRAMBIN, "--per-atom", "a.csv"], ["--per-atom"]),
                ([CRAMBIN, "--component-ids", "-o", "a.obj"], ["--component-ids", "PLY", "a.obj"]),
                ([CRAMBIN, "--component-ids"], ["--component-ids", "--output"])):
            with self.subTest(arguments=arguments):
                self.assert_fails(USAGE, parts, *arguments)
        self.write("in.pdb", CRAMBIN.read_bytes())
        for command in ([], ["measure"]):
            self.assert_fails(USAGE, ["--per-atom", "in.pdb"], *command, "in.pdb", "--per-atom", "in.pdb")
        self.assert_fails(OUTPUT, ["nowhere"], "measure", CRAMBIN, "--per-residue", "nowhere/a.csv")
        self.assert_fails(OUTPUT, ["nowhere"], "cavities", CRAMBIN, "--csv", "nowhere/a.csv")
        self.assert_fails(INPUT, ["nowhere.pdb"], "measure", "nowhere.pdb", "--per-atom", "-")
        self.assert_fails(INPUT, ["nowhere.pdb"], "cavities", "nowhere.pdb")

    def test_a_failed_run_leaves_the_old_table(self):
        self.write("a.csv", "old")
        self.assert_fails(INPUT, ["nowhere.pdb"], "measure", "nowhere.pdb", "--per-atom", "a.csv")
        self.assertEqual((self.folder / "a.csv").read_text(), "old")


class Cavities(TablesTest):
    def setUp(self):
        super().setUp()
        text, self.positions = shell_pdb(((0, 0, 0), (30, 5, -3)), more=[(30, 5, -3)])
        self.write("shells.pdb", text)

    def test_two_of_them(self):
        report = json.loads(self.run_cpu("cavities", "shells.pdb", "--json", "-").stdout)
        volumes = [cavity["volume"] for cavity in report["cavities"]]
        self.assertEqual(volumes, sorted(volumes, reverse=True))
        empty, filled = sorted(report["cavities"], key=lambda cavity: cavity["center"][0])
        self.assertAlmostEqual(empty["volume"], filled["volume"], delta=1)  # what lies within counts as well
        for cavity, center, first in ((empty, (0, 0, 0), 0), (filled, (30, 5, -3), 900)):
            self.assertLess(math.dist(cavity["center"], center), 0.1)
            for axis in range(3):
                low, high = cavity["bounds"][0][axis] - center[axis], cavity["bounds"][1][axis] - center[axis]
                self.assertTrue(-6.9 < low < -6 and 6 < high < 6.9, (low, high))
            atoms = cavity["lining_atoms"]
            self.assertGreater(len(atoms), 400)
            self.assertEqual(atoms, sorted(set(atoms)))
            self.assertTrue(all(first <= atom < first + 900 for atom in atoms))
            self.assertEqual([residue["residue_number"] for residue in cavity["lining_residues"]],
                             sorted({atom // 10 + 1 for atom in atoms}))
            self.assertEqual({residue["residue_name"] for residue in cavity["lining_residues"]}, {"ALA"})
            self.assertLess(cavity["volume"], 4 / 3 * math.pi * 6.9 ** 3)
            self.assertNotIn("cavity", cavity)

    def test_the_largest_is_the_first(self):
        for side in (-30, 30):  # of the lattice, by which components are numbered
            ball = self.positions[:900]
            smaller = [tuple(side + 0.8 * c for c in position) for position in ball]
            self.write("two.pdb", pdb_text([("ATOM", "C", "ALA", 1)] * 1800, ball + smaller))
            report = json.loads(self.run_cpu("cavities", "two.pdb", "--json", "-").stdout)
            large, small = report["cavities"]
            self.assertGreater(large["volume"], 1.5 * small["volume"])
            self.assertLess(math.dist(large["center"], (0, 0, 0)), 0.2)

    def test_the_tables_say_the_same(self):
        report = json.loads(self.run_cpu("cavities", "shells.pdb", "--json", "-").stdout)
        self.run_cpu("cavities", "shells.pdb", "--csv", "c.csv")
        rows = rows_of((self.folder / "c.csv").read_text(),
                       ["component", "volume_A3", "area_A2", "center_x_A", "center_y_A", "center_z_A", "lining_atoms",
                        "lining_residues"])
        lines = self.run_cpu("cavities", "shells.pdb").stdout.splitlines()
        self.assertIn("2 cavities", lines[0])
        self.assertEqual(len(lines), 2 + len(rows))
        for row, cavity, line in zip(rows, report["cavities"], lines[2:]):
            self.assertEqual(int(row["component"]), cavity["component"])
            self.assertAlmostEqual(float(row["volume_A3"]), cavity["volume"], delta=1e-4)
            self.assertAlmostEqual(float(row["area_A2"]), cavity["area"], delta=1e-4)
            for axis, name in enumerate("xyz"):
                self.assertAlmostEqual(float(row[f"center_{name}_A"]), cavity["center"][axis], delta=1e-3)
            self.assertEqual(int(row["lining_atoms"]), len(cavity["lining_atoms"]))
            names = [f"A:{r['residue_name']}{r['residue_number']}" for r in cavity["lining_residues"]]
            self.assertEqual(row["lining_residues"].split(), names)
            self.assertEqual(line.split()[0], row["component"])
            self.assertEqual(line.split()[-len(names):], names)

    def test_names_do_not_steer_the_terminal(self):
        escape = shell_pdb()[0].replace("ALA", "\x1b[2")
        self.write("escape.pdb", escape)
        for arguments in (["cavities", "escape.pdb"], ["measure", "escape.pdb", "--per-residue", "-"]):
            text = self.run_cpu(*arguments).stdout
            self.assertIn("?[2", text)
            self.assertNotIn("\x1b", text)

    def test_none(self):
        self.write("one.pdb", pdb_text([("ATOM", "C", "ALA", 1)], [(0, 0, 0)]))
        text = self.run_cpu("cavities", "one.pdb").stdout
        self.assertEqual(len(text.splitlines()), 1)
        self.assertIn("no cavities", text)
        self.assertEqual(json.loads(self.run_cpu("cavities", "one.pdb", "--json", "-").stdout)["cavities"], [])
        self.assertEqual(len(self.run_cpu("cavities", "one.pdb", "--csv", "-").stdout.splitlines()), 1)
        self.assertEqual(self.run_cpu("cavities", "one.pdb", "--quiet").stdout, "")

    def test_of_one_model(self):
        text = "MODEL        1\n" + pdb_text([("ATOM", "C", "ALA", 1)], [(0, 0, 0)]).replace("END\n", "ENDMDL\n")
        self.write("two.pdb", text + "MODEL        2\n" + (self.folder / "shells.pdb").read_text().replace("END\n", "ENDMDL\n"))
        expected = json.loads(self.run_cpu("cavities", "shells.pdb", "--json", "-").stdout)["cavities"]
        self.assertEqual(len(expected), 2)
        for number, cavities in ((1, []), (2, expected)):
            report = json.loads(self.run_cpu("cavities", "two.pdb", "--model", number, "--json", "-").stdout)
            self.assertEqual((report["model"], report["cavities"]), (number, cavities))
        self.assert_fails(USAGE, ["2 models", "no model 3"], "cavities", "two.pdb", "--model", "3")
        self.assertRegex(self.run_program("cavities", "--help").stdout, r"--model N\s")

    def test_the_probe_is_told_where_there_is_one(self):
        for surface, has_probe in (("ses", True), ("sas", True), ("vdw", False), ("gaussian", False)):
            line = self.run_cpu("cavities", "shells.pdb", "-v", "1", "--surface", surface).stdout.splitlines()[0]
            self.assertIn(f"({surface} surface, {'probe 1.4 Å, ' * has_probe}spacing 1 Å)", line)
        for surfaces, has_probe in (("vdw", False), ("sas", True), ("vdw,sas", True)):
            line = self.run_cpu("measure", "shells.pdb", "--surface", surfaces).stdout.splitlines()[0]
            self.assertIn(f" atoms, {'probe 1.4 Å, ' * has_probe}cpu, ", line)

    def test_without_names(self):
        self.write("shell.xyzr", "".join("%.3f %.3f %.3f 1.7\n" % p for p in self.positions[:900]))
        (cavity,) = json.loads(self.run_cpu("cavities", "shell.xyzr", "--json", "-").stdout)["cavities"]
        self.assertEqual(cavity["lining_residues"], [])
        self.assertGreater(len(cavity["lining_atoms"]), 400)
        self.assertIn("1 cavity", self.run_cpu("cavities", "shell.xyzr").stdout)

    def read_ply_with_components(self, name):
        header, body = (self.folder / name).read_bytes().split(b"end_header\n", 1)
        self.assertIn(b"property int owner\nproperty int component\nelement face", header)
        counts = [int(line.split()[2]) for line in header.decode().splitlines() if line.startswith("element")]
        rows = [struct.unpack_from("<6f2i", body, 32 * i) for i in range(counts[0])]
        faces = [struct.unpack_from("<B3I", body, 32 * counts[0] + 13 * i)[1:] for i in range(counts[1])]
        self.assertEqual(len(body), 32 * counts[0] + 13 * counts[1])
        return [row[:3] for row in rows], [row[7] for row in rows], faces

    def test_component_ids_in_ply_files(self):
        self.run_cpu("shells.pdb", "-o", "a.ply", "--component-ids", "--json", "a.json")
        vertices, ids, faces = self.read_ply_with_components("a.ply")
        self.run_cpu("shells.pdb", "-o", "b.ply")
        plain = read_ply(self.folder / "b.ply")
        self.assertEqual((vertices, faces), (plain[0], plain[3]))
        parent = list(range(len(vertices)))

        def root(v):
            while parent[v] != v:
                parent[v] = v = parent[parent[v]]
            return v
        for a, b, c in faces:
            parent[root(a)] = root(b)
            parent[root(b)] = root(c)
        numbers = {}
        for v in range(len(vertices)):
            numbers.setdefault(root(v), len(numbers))
        self.assertEqual(ids, [numbers[root(v)] for v in range(len(vertices))])
        report = json.loads((self.folder / "a.json").read_text())
        self.assertEqual(len(report["components"]), len(numbers))
        self.assertEqual({piece["component"] for piece in report["components"]}, set(ids))
        for piece in report["components"]:
            of_piece = [v for v, number in zip(vertices, ids) if number == piece["component"]]
            self.assertEqual(sum(ids[face[0]] == piece["component"] for face in faces), piece["triangles"])
            for k in range(3):
                self.assertAlmostEqual(min(v[k] for v in of_piece), piece["bounds"][0][k], delta=1e-4)
                self.assertAlmostEqual(max(v[k] for v in of_piece), piece["bounds"][1][k], delta=1e-4)

    def test_outer_shells_only(self):
        whole = json.loads(self.run_cpu("shells.pdb", "-o", "a.ply", "--component-ids", "--json", "-").stdout)
        outer = json.loads(self.run_cpu("shells.pdb", "-o", "b.ply", "--outer", "--component-ids", "--json", "-").stdout)
        self.assertEqual(outer["components"], whole["components"])
        self.assertEqual((outer["area"], outer["volume"]), (whole["area"], whole["volume"]))
        self.assertIs(outer["settings"]["outer"], True)
        self.assertNotIn("outer", whole["settings"])
        vertices, ids, faces = self.read_ply_with_components("b.ply")
        self.assertTrue(is_closed(faces))
        self.assertEqual(len(vertices), outer["mesh"]["vertices"])
        self.assertEqual(len(faces), sum(p["triangles"] for p in whole["components"] if not p["cavity"]))
        self.assertLess(len(faces), whole["mesh"]["triangles"])
        cavities = {c["component"] for c in json.loads(self.run_cpu("cavities", "shells.pdb", "--json", "-").stdout)["cavities"]}
        self.assertEqual(len(cavities), 2)
        self.assertFalse(cavities & set(ids))
        whole_vertices, whole_ids, whole_faces = self.read_ply_with_components("a.ply")
        self.assertEqual([tuple(whole_vertices[v] for v in f) for f in whole_faces if whole_ids[f[0]] not in cavities],
                         [tuple(vertices[v] for v in f) for f in faces])


class Frames(TablesTest):
    def setUp(self):
        super().setUp()
        self.atoms, positions = chain_of(24)
        self.frames = moving(positions, 7)
        self.write("top.pdb", pdb_text(self.atoms, positions))
        self.write("t.dcd", dcd_bytes(self.frames))
        self.write("bad.dcd", dcd_bytes(with_nan(self.frames, 3, 5)))

    def run_frames(self, *arguments, command=("measure",), trajectory="t.dcd", code=OK):
        return self.run_cpu(*command, "top.pdb", "--trajectory", trajectory, *arguments, code=code)

    def test_frames_are_what_their_structures_alone_would_be(self):
        self.run_frames("--csv", "a.csv", "--per-residue", "r.csv", "--per-atom", "p.csv", "--json", "a.json")
        rows = rows_of((self.folder / "a.csv").read_text(), ["frame", "sas_area_A2", "sas_volume_A3", "vdw_area_A2",
                                                             "vdw_volume_A3", "time_ps", "error"])
        areas = ["sas_area_A2", "vdw_area_A2"]
        residues = rows_of((self.folder / "r.csv").read_text(), ["frame", *RESIDUE, *areas])
        atoms = rows_of((self.folder / "p.csv").read_text(), ["frame", *ATOM, *areas])
        reports = [json.loads(line) for line in (self.folder / "a.json").read_text().splitlines()]
        self.assertEqual([row["frame"] for row in rows], [str(k) for k in range(7)])
        for k, frame in enumerate(self.frames):
            self.write("alone.pdb", pdb_text(self.atoms, frame))
            alone = self.numbers("alone.pdb")
            self.assertEqual({entry["surface"]: entry for entry in reports[k]["surfaces"]}, alone)
            self.assertEqual(reports[k]["frame"], k)
            for surface in ("sas", "vdw"):
                self.assertAlmostEqual(float(rows[k][f"{surface}_area_A2"]), alone[surface]["area"], delta=1e-4)
                self.assertAlmostEqual(float(rows[k][f"{surface}_volume_A3"]), alone[surface]["volume"], delta=1e-4)
            for table, columns, flag in ((residues, RESIDUE, "--per-residue"), (atoms, ATOM, "--per-atom")):
                expected = rows_of(self.run_cpu("measure", "alone.pdb", flag, "-").stdout, [*columns, *areas])
                of_frame = [row for row in table if row["frame"] == str(k)]
                self.assertEqual([{**row, "frame": ""} for row in of_frame], [{**row, "frame": ""} for row in expected])

    def test_workers_do_not_matter(self):
        def everything(*more):
            self.run_frames("--csv", "a.csv", "--per-residue", "r.csv", "--per-atom", "p.csv", *more)
            return [(self.folder / name).read_bytes() for name in ("a.csv", "r.csv", "p.csv")]
        expected = everything("--workers", "1")
        for more in (("--workers", "2"), ("--workers", "20"), ("--workers", "3", "--threads", "1")):
            self.assertEqual(everything(*more), expected)

    def test_of_meshes(self):
        result = self.run_frames("-v", "0.8", "--surface", "sas", "--per-residue", "-", "--csv", "a.csv", command=())
        residues = rows_of(result.stdout, ["frame", *RESIDUE, "sas_area_A2"])
        for row in csv.DictReader((self.folder / "a.csv").read_text().splitlines()):
            self.assertAlmostEqual(total([r for r in residues if r["frame"] == row["frame"]], "sas_area_A2"),
                                   float(row["area"]), delta=1e-3)

    def test_a_damaged_frame_has_no_rows(self):
        result = self.run_frames("--csv", "a.csv", "--per-residue", "r.csv", "--json", "a.json", trajectory="bad.dcd",
                                 code=FRAMES_FAILED)
        self.assertIn("frame 3 failed", result.stderr)
        rows = list(csv.DictReader((self.folder / "a.csv").read_text().splitlines()))
        self.assertEqual([k for k, row in enumerate(rows) if row["error"]], [3])
        self.assertEqual(rows[3]["sas_area_A2"], "")
        frames = {row["frame"] for row in csv.DictReader((self.folder / "r.csv").read_text().splitlines())}
        self.assertEqual(frames, {"0", "1", "2", "4", "5", "6"})
        self.assertIn("error", json.loads((self.folder / "a.json").read_text().splitlines()[3]))

    def test_summary_and_standard_output(self):
        self.assertIn("7 frames of 24 atoms", self.run_frames("--csv", "a.csv").stdout)
        lines = self.run_frames("--per-residue", "-").stdout.splitlines()
        self.assertTrue(lines[0].startswith("frame,chain"))
        self.assertTrue(all(line[0] in "0123456" for line in lines[1:]))
        self.assert_fails(USAGE, ["--csv", "--per-residue"], "measure", "top.pdb", "--trajectory", "t.dcd", "--csv", "-",
                          "--per-residue", "-")
        self.assert_fails(USAGE, ["--per-residue", "--csv"], "measure", "top.pdb", "--trajectory", "t.dcd", "--csv",
                          "a.csv", "--per-residue", "a.csv")


if __name__ == "__main__":
    cli_test.PROGRAM = cli_test.program_to_test(cli_test.PROGRAM, __doc__)
    unittest.main()
