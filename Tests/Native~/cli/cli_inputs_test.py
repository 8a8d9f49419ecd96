# SPDX-License-Identifier: MIT
"""Tests of what quickses takes as input: several structures, standard input, what is no structure, radii from a file.

usage: cli_inputs_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import csv
import gzip
import json
import os
import subprocess
import unittest

import cli_test
from cli_test import INPUT, OK, USAGE, ProgramTest
from trajectory_files import chain_of, dcd_bytes, moving, pdb_text

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


class StandardInput(InputTest):
    def run_with(self, content, *arguments, code=OK):
        result = subprocess.run([cli_test.PROGRAM, *map(str, arguments), "--backend", "cpu"], input=content,
                                capture_output=True, cwd=self.folder, timeout=cli_test.PATIENCE)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def test_it_is_read_as_the_file_would_be(self):
        text = (self.folder / self.names[0]).read_bytes()
        alone = json.loads(self.run_cpu(self.names[0], "--json", "-", "-o", "file.ply").stdout)
        for content in (text, gzip.compress(text), text.replace(b"\n", b"\r\n")):
            report = json.loads(self.run_with(content, "-", "--json", "-", "-o", "pipe.ply").stdout)
            self.assertEqual((report["input"], report["area"]), ("-", alone["area"]))
            self.assertEqual((self.folder / "pipe.ply").read_bytes(), (self.folder / "file.ply").read_bytes())
        self.run_with(text, self.names[1], "-", "-o", "out/%s.ply")
        self.assertEqual(self.outputs(), ["stdin.ply", "two.x.ply"])

    def test_measure_cavities_bench_and_trajectories(self):
        text = (self.folder / self.names[0]).read_bytes()
        self.write("t.dcd", dcd_bytes(self.frames))
        self.assertIn(b"sas ", self.run_with(text, "measure", "-").stdout)
        self.assertIn(b"no cavities", self.run_with(text, "cavities", "-").stdout)
        self.assertIn(b"12 atoms", self.run_with(text, "bench", "-", "--repeat", 1).stdout)
        self.assertIn(b"3 frames of 12 atoms", self.run_with(text, "-", "--trajectory", "t.dcd", "--csv", "a.csv").stdout)

    def test_it_can_not_be_read_twice(self):
        text = (self.folder / self.names[0]).read_bytes()
        for arguments in (["-", "-", "-o", "out/%s.ply"], ["measure", "-", self.names[1], "-"], ["bench", "-", "-"]):
            result = self.run_with(text, *arguments, code=cli_test.USAGE)
            self.assertIn(b"'-': standard input is given 2 times", result.stderr)
        self.assertEqual(self.outputs(), [])

    @unittest.skipIf(cli_test.IS_WINDOWS, "files that are opened take its place")
    def test_it_is_closed(self):
        result = subprocess.run([cli_test.PROGRAM, "-"], preexec_fn=lambda: os.close(0), capture_output=True,
                                timeout=cli_test.PATIENCE)
        self.assertEqual((result.returncode, result.stdout), (INPUT, b""))
        self.assertIn(b"'standard input' is closed", result.stderr)

    def test_hints_name_it(self):
        text = (self.folder / self.names[0]).read_bytes()
        models = b"".join(b"MODEL     %4d\n%sENDMDL\n" % (number, text.replace(b"END\n", b"")) for number in (7, 8))
        self.assertIn(b"'standard input': model 1 of 2", self.run_with(models, "measure", "-").stderr)
        self.assertIn(b"'standard input': --model 2", self.run_with(models, "measure", "-", "--model", "2").stderr)

    def test_formats_that_content_does_not_tell(self):
        report = json.loads(self.run_with(b"0 0 0 1.5\n", "-", "--input-format", "xyzr", "--json", "-").stdout)
        self.assertEqual(report["atoms"], 1)
        self.assertIn(b"standard input", self.run_with(b"0 0 0 1.5\n", "-", code=INPUT).stderr)
        self.assertIn(b"'standard input' is empty", self.run_with(b"", "-", code=INPUT).stderr)
        self.write("a.txt", "0 0 0 1.5\n")
        self.run_cpu("a.txt", "--input-format", "xyzr")
        self.assert_fails(USAGE, ["--input-format", "'cif'", "mmcif"], "a.txt", "--input-format", "cif")

    def test_more_than_may_be_read(self):
        result = self.run_with(b"REMARK\n" * 1000, "-", "--max-input", "1K", code=INPUT)
        self.assertIn(b"--max-input", result.stderr)

    @unittest.skipIf(cli_test.IS_WINDOWS, "there is no /dev/stdin")
    def test_the_file_that_it_comes_from_is_not_overwritten(self):
        path = self.folder / self.names[0]
        with path.open("rb") as file:
            result = subprocess.run([cli_test.PROGRAM, "-", "--json", self.names[0]], stdin=file, capture_output=True,
                                    cwd=self.folder, encoding="utf-8", timeout=cli_test.PATIENCE)
        self.assertEqual(result.returncode, USAGE)
        self.assertIn("would be overwritten", result.stderr)


class StandardOutput(InputTest):
    def run_bytes(self, *arguments, stdin=b""):
        result = subprocess.run([cli_test.PROGRAM, *map(str, arguments), "--backend", "cpu"], input=stdin,
                                capture_output=True, cwd=self.folder, timeout=cli_test.PATIENCE)
        self.assertEqual(result.returncode, OK, result.stderr)
        return result.stdout

    def test_the_mesh_is_what_the_file_would_be(self):
        for name in ("obj", "ply", "stl"):
            self.run_cpu(self.names[0], "-o", f"file.{name}")
            expected = (self.folder / f"file.{name}").read_bytes()
            arguments = ("-o", "-", "--output-format", name, "--json", "a.json")
            self.assertEqual(self.run_bytes(self.names[0], *arguments), expected)
            self.assertEqual(json.loads((self.folder / "a.json").read_text())["output"], "-")
            text = (self.folder / self.names[0]).read_bytes()
            self.assertEqual(self.run_bytes("-", "-o", "-", "--output-format", name, stdin=text), expected)  # a filter

    def test_what_does_not_go_with_it(self):
        def fails(parts, *arguments):
            self.assert_fails(USAGE, parts, *arguments, "--backend", "cpu")
        fails(["--output-format ply"], self.names[0], "-o", "-")
        fails(["--output-format", "'gif'", "ply"], self.names[0], "-o", "-", "--output-format", "gif")
        fails(["--output-format", "extension"], self.names[0], "-o", "a.ply", "--output-format", "ply")
        fails(["--output-format", "extension"], self.names[0], "--output-format", "ply")
        ply = ("-o", "-", "--output-format", "ply")
        for flag in ("--json", "--per-atom"):
            fails(["--output (-o) and " + flag, "standard output"], self.names[0], *ply, flag, "-")
        fails(["one mesh"], *self.names, *ply)
        fails(["one mesh"], self.names[0], "--model", "all", *ply)
        fails(["one mesh"], self.names[0], "--trajectory", "t.dcd", *ply)
        fails(["--hard-edges"], self.names[0], "--hard-edges", "on", "-o", "-", "--output-format", "stl")

    def test_after_an_error_nothing_was_printed(self):
        self.assert_fails(INPUT, ["none.pdb"], "none.pdb", "-o", "-", "--output-format", "ply", "--backend", "cpu")

    def test_a_file_that_is_called_so_is_a_file(self):
        self.run_cpu(self.names[0], "-o", "-.ply")
        self.assertTrue((self.folder / "-.ply").read_bytes().startswith(b"ply"))


class Radii(InputTest):
    def test_lines_by_residue_and_atom(self):
        self.write("r.txt", "C 2.1\nALA CA 1.1   # of all\n* N 1.3\n")
        table = self.run_cpu("measure", self.names[0], "--radii", "r.txt", "--per-atom", "-", "--quiet").stdout
        radii = {(row["atom_name"], row["radius_A"]) for row in csv.DictReader(table.splitlines())}
        self.assertEqual(radii, {("C", "2.100"), ("CA", "1.100"), ("N", "1.300")})
        self.write("bad.txt", "C 2.1\nALA CA x\n")
        self.assert_fails(INPUT, ["bad.txt", "line 2", "'x'"], self.names[0], "--radii", "bad.txt", "--backend", "cpu")


if __name__ == "__main__":
    cli_test.PROGRAM = cli_test.program_to_test(cli_test.PROGRAM, __doc__)
    unittest.main()
