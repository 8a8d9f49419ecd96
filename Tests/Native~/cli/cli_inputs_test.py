# SPDX-License-Identifier: MIT
"""Tests of what quickses takes as input: several structures, standard input, what is no structure, radii from a file.

usage: cli_inputs_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import csv
import gzip
import json
import unittest

import cli_test
from cli_test import INPUT, OK, USAGE, ProgramTest
from trajectory_files import chain_of, moving, pdb_text

SOME_FAILED = 6


class InputTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.atoms, positions = chain_of(12)
        self.frames = moving(positions, 3)
        (self.folder / "in").mkdir()
        (self.folder / "out").mkdir()
        self.names = ["in/one.pdb", "in/two.x.ent", "in/three.pdb.gz"]
        texts = [pdb_text(self.atoms, frame).encode() for frame in self.frames]
        for name, text in zip(self.names, texts):
            self.write(name, gzip.compress(text) if name.endswith(".gz") else text)

    def outputs(self):
        return sorted(path.name for path in (self.folder / "out").iterdir())


class SeveralStructures(InputTest):
    def test_each_has_the_mesh_that_it_has_alone(self):
        result = self.run_cpu(*self.names, "-o", "out/%s.ply")
        self.assertEqual(self.outputs(), ["one.ply", "three.ply", "two.x.ply"])
        lines = result.stdout.splitlines()
        self.assertEqual([line.split(":")[0] for line in lines], self.names)
        for name, mesh in zip(self.names, ["one", "two.x", "three"]):
            self.run_cpu(name, "-o", "alone.ply")
            self.assertEqual((self.folder / f"out/{mesh}.ply").read_bytes(), (self.folder / "alone.ply").read_bytes())

    def test_the_place_of_the_name_may_be_anywhere(self):
        self.run_cpu(self.names[0], "-o", "out/a_%s_50%_%s.stl")  # of one structure too; other signs stay what they are
        self.assertEqual(self.outputs(), ["a_one_50%_one.stl"])

    def test_report_has_one_line_each(self):
        lines = self.run_cpu(*self.names, "--json", "-").stdout.splitlines()
        reports = [json.loads(line) for line in lines]
        self.assertEqual([report["input"] for report in reports], self.names)
        for name, report in zip(self.names, reports):
            alone = json.loads(self.run_cpu(name, "--json", "-").stdout)
            self.assertEqual((report["area"], report["volume"]), (alone["area"], alone["volume"]))

    def test_measure_and_its_tables(self):
        surfaces = ("--surface", "sas,vdw", "--quiet")
        text = self.run_cpu("measure", *self.names, *surfaces, "--per-residue", "-").stdout
        rows = list(csv.DictReader(text.splitlines()))
        self.assertEqual(list(rows[0])[:3], ["input", "chain", "residue_number"])
        for name in self.names:
            alone = list(csv.DictReader(self.run_cpu("measure", name, *surfaces, "--per-residue", "-").stdout.splitlines()))
            self.assertEqual([{key: value for key, value in row.items() if key != "input"}
                              for row in rows if row["input"] == name], alone)
        both = self.run_cpu("measure", *self.names[:2], "--model", "all", "--quiet", "--per-atom", "-").stdout
        self.assertTrue(both.startswith("input,model,atom,"))
        self.assertEqual(both.splitlines()[1].split(",")[:3], ["in/one.pdb", "1", "0"])

    def test_one_that_fails_does_not_stop_the_others(self):
        self.write("in/bad.pdb", "REMARK nothing\n")
        (self.folder / "out/two.x.ply").mkdir()
        names = [self.names[0], "in/bad.pdb", "in/none.pdb", *self.names[1:]]
        result = self.run_cpu(*names, "-o", "out/%s.ply", "--json", "a.json", "--quiet", code=SOME_FAILED)
        errors = result.stderr.splitlines()
        for name, line in zip(["in/bad.pdb", "in/none.pdb", "in/two.x.ent"], errors):
            self.assertIn(f"{name} failed: ", line)
        self.assertEqual(errors[3:], ["quickses: 3 of 5 structures failed"])
        reports = [json.loads(line) for line in (self.folder / "a.json").read_text().splitlines()]
        self.assertEqual([report["input"] for report in reports], names)
        self.assertEqual(["error" in report for report in reports], [False, True, True, True, False])
        self.assertEqual(self.outputs(), ["one.ply", "three.ply", "two.x.ply"])
        self.assertEqual([path.name for path in (self.folder / "out").iterdir() if path.is_file()].count("two.x.ply"), 0)
        self.assert_fails(INPUT, ["in/bad.pdb"], "in/bad.pdb", "--backend", "cpu")  # alone it has its own exit code

    def test_names_that_do_not_go_together(self):
        def fails(parts, *arguments):
            self.assert_fails(USAGE, parts, *arguments, "--backend", "cpu")
        fails(["--output (-o)", "mesh.ply", "3 structures", "%s"], *self.names, "-o", "mesh.ply")
        self.write("one.pdb.gz", b"")
        fails(["--output (-o)", "in/one.pdb", "'one.pdb.gz'", "out/one.ply"], *self.names, "one.pdb.gz", "-o", "out/%s.ply")
        fails(["in/one.pdb", "in/one.pdb"], self.names[0], self.names[0], "-o", "%s.ply")
        self.write("in/x.ply", "")
        fails(["--output (-o)", "in/x.ply", "overwritten"], self.names[0], "in/x.ply", "-o", "in/%s.ply")
        fails(["--json", "out/one.ply"], *self.names, "-o", "out/%s.ply", "--json", "out/one.ply")
        fails(["--json", "in/one.pdb"], *self.names, "--json", "in/one.pdb")
        fails(["--trajectory", "3 were given"], *self.names, "--trajectory", "t.dcd")
        fails(["cavities", "3 were given"], "cavities", *self.names)
        self.assertEqual(self.outputs(), [])

    def test_all_models_of_each(self):
        text = "".join(f"MODEL     {k + 1:4d}\n" + pdb_text(self.atoms, frame).replace("END\n", "ENDMDL\n")
                       for k, frame in enumerate(self.frames[:2])) + "END\n"
        self.write("in/models.pdb", text)
        self.run_cpu("in/models.pdb", self.names[0], "--model", "all", "-o", "out/%s.ply", code=OK)
        self.assertEqual(self.outputs(), ["models_0001.ply", "models_0002.ply", "one_0001.ply"])


if __name__ == "__main__":
    cli_test.PROGRAM = cli_test.program_to_test(cli_test.PROGRAM, __doc__)
    unittest.main()
