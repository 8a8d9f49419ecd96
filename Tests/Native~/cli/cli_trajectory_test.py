# SPDX-License-Identifier: MIT
"""Tests of quickses --trajectory as its users and their scripts see it.

usage: cli_trajectory_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import csv
import gzip
import json
import os
import struct
import subprocess
import sys
import threading
import unittest

import cli_test
from cli_test import CRAMBIN, INPUT, IS_WINDOWS, OK, OUTPUT, USAGE, ProgramTest, can_refuse_threads, read_ply, refuse_threads
from page_files import Page
from trajectory_files import chain_of, dcd_bytes, moving, pdb_text, with_nan

FRAMES_FAILED = 6
COLUMNS = ["frame", "area", "volume", "components", "cavities", "cavity_volume", "time_ps", "error"]


class TrajectoryTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.atoms, positions = chain_of(24)
        self.frames = moving(positions, 7)
        self.write("top.pdb", pdb_text(self.atoms, positions))
        self.write("t.dcd", dcd_bytes(self.frames))

    def run_frames(self, *arguments, trajectory="t.dcd", top="top.pdb", spacing=0.8, **keywords):
        return self.run_cpu(top, "--trajectory", trajectory, "-v", spacing, *arguments, **keywords)

    def table(self, *arguments, **keywords):
        """The rows of the table as dictionaries."""
        result = self.run_frames("--csv", "-", "--quiet", *arguments, **keywords)
        reader = csv.DictReader(result.stdout.splitlines())
        rows = list(reader)
        self.assertEqual(reader.fieldnames, COLUMNS)
        return rows

    def assert_frames_fail(self, code, parts, *arguments):
        self.assert_fails(code, parts, "top.pdb", "--trajectory", "t.dcd", "--backend", "cpu", *arguments)


class Results(TrajectoryTest):
    def test_a_frame_is_what_its_structure_alone_would_be(self):
        rows = self.table("-o", "f_%03d.ply")
        self.assertEqual([row["frame"] for row in rows], [str(k) for k in range(7)])
        for k, row in enumerate(rows):
            alone = self.write("alone.pdb", pdb_text(self.atoms, self.frames[k]))
            report = json.loads(self.run_cpu(alone, "-v", "0.8", "--creases", "off", "-o", "alone.ply", "--json",
                                             "-").stdout)
            self.assertEqual((self.folder / f"f_{k:03d}.ply").read_bytes(), (self.folder / "alone.ply").read_bytes())
            self.assertAlmostEqual(float(row["area"]), report["area"], delta=0.0001)
            self.assertAlmostEqual(float(row["volume"]), report["volume"], delta=0.0001)
            cavities = [piece["volume"] for piece in report["components"] if piece["cavity"]]
            self.assertEqual(int(row["components"]), len(report["components"]))
            self.assertEqual(int(row["cavities"]), len(cavities))
            self.assertAlmostEqual(float(row["cavity_volume"]), -sum(cavities), delta=0.0001)
            self.assertEqual(row["error"], "")
        self.assertEqual(len({row["area"] for row in rows}), 7)

    def test_a_cavity(self):
        points = [(x, y, z) for x in range(-4, 5) for y in range(-4, 5) for z in range(-4, 5)
                  if max(abs(x), abs(y), abs(z)) == 4]
        shell = [(1.5 * x, 1.5 * y, 1.5 * z) for x, y, z in points]  # a closed box, hollow inside
        atoms = [("ATOM", "C", "ALA", 1)] * len(shell)
        self.write("shell.pdb", pdb_text(atoms, shell))
        self.write("shell.dcd", dcd_bytes([shell]))
        (row,) = self.table(top="shell.pdb", trajectory="shell.dcd")
        self.assertEqual((row["components"], row["cavities"]), ("2", "1"))
        # Inside, the atoms' surfaces face each other at 12 - 2 * 1.7 = 8.6 Å, less what the probe can't reach.
        self.assertGreater(float(row["cavity_volume"]), 0.8 * 8.6 ** 3)
        self.assertLess(float(row["cavity_volume"]), 1.5 * 8.6 ** 3)

    def test_results_do_not_depend_on_the_number_of_workers(self):
        def everything(workers, *more):
            self.run_frames("--workers", workers, "--csv", "a.csv", "--json", "a.json", "-o", "f%d.ply", *more)
            reports = [json.loads(line) for line in (self.folder / "a.json").read_text().splitlines()]
            for report in reports:
                del report["time_ms"], report["memory"], report["device"]  # which has the threads of a frame
                report["settings"].pop("threads", None)
                report["settings"].pop("memory", None)
            meshes = [(self.folder / f"f{k}.ply").read_bytes() for k in range(7)]
            return (self.folder / "a.csv").read_bytes(), reports, meshes

        expected = everything(1, "--threads", "1")
        self.assertEqual([report["frame"] for report in expected[1]], list(range(7)))
        # With more threads than workers, frames are read and written while others are computed.
        for workers, threads in ((1, 2), (1, 3), (1, 9), (2, 1), (2, 5), (3, 9), (20, 20)):
            with self.subTest(workers=workers, threads=threads):
                self.assertEqual(everything(workers, "--threads", threads), expected)
        self.assertEqual(everything(3, "--memory", "48M"), expected)

    @unittest.skipUnless(can_refuse_threads(), "threads can't be refused")
    def test_without_threads_the_program_has_one(self):
        self.assertEqual(self.table("--threads", "4", preexec_fn=refuse_threads), self.table())

    def test_tables_do_not_depend_on_the_number_of_workers(self):
        tables = ["--csv", "--per-atom", "--per-residue"]

        def everything(command, *arguments):
            self.run_cpu(*command, "top.pdb", "--trajectory", "t.dcd", "-v", "0.8", *arguments,
                         *(word for flag in tables for word in (flag, "a" + flag)))
            return [(self.folder / ("a" + flag)).read_bytes() for flag in tables]

        for command in ([], ["measure", "--surface", "ses,vdw"]):
            expected = everything(command, "--workers", 1, "--threads", 1)
            for workers, threads in ((1, 9), (2, 9), (7, 7)):
                self.assertEqual(everything(command, "--workers", workers, "--threads", threads), expected)

    def test_atoms_that_are_left_out_are_left_out_of_every_frame(self):
        water = [("HETATM", "O", "HOH", 900 + i) for i in range(5)]
        atoms = water + self.atoms
        frames = [[(30.0 + 3 * i, k, k) for i in range(5)] + frame for k, frame in enumerate(self.frames)]
        self.write("wet.pdb", pdb_text(atoms, frames[0]))
        self.write("wet.dcd", dcd_bytes(frames))
        dry = self.table("-o", "dry%d.ply")
        self.assertEqual(self.table("--no-water", "-o", "wet%d.ply", top="wet.pdb", trajectory="wet.dcd"), dry)
        for k in range(7):
            vertices, normals, owners, faces = read_ply(self.folder / f"wet{k}.ply")
            expected = read_ply(self.folder / f"dry{k}.ply")
            self.assertEqual((vertices, normals, faces), (expected[0], expected[1], expected[3]))
            self.assertEqual(owners, [owner + 5 for owner in expected[2]])  # places in the file

    def test_files_in_a_row_are_one_trajectory(self):
        self.write("a.dcd", dcd_bytes(self.frames[:3]))
        self.write("b.dcd", dcd_bytes(self.frames[3:4]))
        self.write("c.dcd", dcd_bytes(self.frames[4:]))
        row = ("--trajectory", "b.dcd", "--trajectory", "c.dcd")
        expected = self.table("-o", "one%d.ply")
        self.assertEqual(self.table("-o", "row%d.ply", *row, trajectory="a.dcd"), expected)
        for k in range(7):
            self.assertEqual((self.folder / f"row{k}.ply").read_bytes(), (self.folder / f"one{k}.ply").read_bytes())
        self.assertEqual(self.table("-o", "row%d.ply", "--frames", "1:-1:2", *row, trajectory="a.dcd"), expected[1:-1:2])
        lines = self.run_frames("--json", "-", "--frames", "2:5", *row, trajectory="a.dcd").stdout.splitlines()
        self.assertEqual([(json.loads(line)["frame"], json.loads(line)["trajectory"]) for line in lines],
                         [(2, "a.dcd"), (3, "b.dcd"), (4, "c.dcd")])
        result = self.run_cpu("--trajectory", "a.dcd", "top.pdb", "--trajectory", "c.dcd", "-v", "0.8", "--csv", "a.csv")
        self.assertIn("6 frames of 24 atoms", result.stdout)  # INPUT may stand between

    def test_files_in_a_row_that_do_not_go_together(self):
        self.write("other.dcd", dcd_bytes([frame[:20] for frame in self.frames]))
        row = ("top.pdb", "--trajectory", "t.dcd", "--trajectory")
        self.assert_fails(INPUT, ["other.dcd", "20 atoms", "t.dcd", "24"], *row, "other.dcd", "--csv", "a.csv", "--backend", "cpu")
        self.assert_fails(INPUT, ["none.dcd"], *row, "none.dcd", "--csv", "a.csv", "--backend", "cpu")
        self.assert_fails(USAGE, ["no frame 14", "14 frames, 0 to 13", "t.dcd", "1 more"], *row, "t.dcd", "--frames", "14",
                          "--csv", "a.csv", "--backend", "cpu")
        self.assert_fails(USAGE, ["--csv", "inputs"], *row, "b.dcd", "--csv", self.write("b.dcd", dcd_bytes(self.frames)))
        damaged = self.write("bad.dcd", dcd_bytes(with_nan(self.frames, 3, 10)))
        result = self.run_cpu(*row, damaged, "-v", "0.8", "--csv", "-", code=FRAMES_FAILED)
        self.assertIn("frame 10 failed: ", result.stderr)
        self.assertIn("bad.dcd': frame 3: atom 11", result.stderr)

    def test_models_of_a_pdb_file_are_frames(self):
        text = "".join(f"MODEL     {k + 1:4d}\n" + pdb_text(self.atoms, frame).replace("END\n", "ENDMDL\n")
                       for k, frame in enumerate(self.frames)) + "END\n"
        self.write("models.pdb", text)
        (self.folder / "models.pdb.gz").write_bytes(gzip.compress(text.encode()))
        expected = [{**row, "time_ps": ""} for row in self.table()]
        for name in ("models.pdb", "models.pdb.gz"):
            rows = self.table(top=name, trajectory=name)
            self.assertEqual([{**row, "time_ps": ""} for row in rows], expected)

    def test_report_has_one_line_per_frame(self):
        lines = self.run_frames("--json", "-", "--frames", "2:5").stdout.splitlines()
        self.assertEqual(len(lines), 3)
        for k, line in zip((2, 3, 4), lines):
            report = json.loads(line)
            self.assertEqual((report["frame"], report["trajectory"], report["input"]), (k, "t.dcd", "top.pdb"))
            self.assertEqual(report["atoms"], 24)
            self.assertIn("time_ps", report)
            self.assertTrue(report["mesh"]["closed"])
            self.assertEqual(sum(piece["triangles"] for piece in report["components"]), report["mesh"]["triangles"])

    def test_times_have_all_their_digits(self):
        data = bytearray(dcd_bytes(self.frames))
        struct.pack_into("<f", data, 44, 3e38)  # the step
        self.write("odd.dcd", bytes(data))
        for command in ([], ["measure"]):
            result = self.run_cpu(*command, "top.pdb", "--trajectory", "odd.dcd", "-v", "0.8", "--frames", "1:3", "--csv", "-")
            one, two = [float(row["time_ps"]) for row in csv.DictReader(result.stdout.splitlines())]
            self.assertAlmostEqual(one / (3e38 * 0.0488882), 1, places=5)
            self.assertAlmostEqual(two / one, 2, places=9)

    @unittest.skipIf(IS_WINDOWS, "no named pipes")
    def test_rows_are_there_if_the_program_is_stopped(self):
        os.mkfifo(self.folder / "f6.ply")  # nobody reads it: the last frame does not end
        with subprocess.Popen([cli_test.PROGRAM, "top.pdb", "--trajectory", "t.dcd", "-v", "0.8", "--backend", "cpu", "--csv", "-",
                               "-o", "f%d.ply"], cwd=self.folder, stdout=subprocess.PIPE, encoding="utf-8") as program:
            patience = threading.Timer(cli_test.PATIENCE, program.kill)
            patience.start()
            rows = [program.stdout.readline() for _ in range(7)]
            program.terminate()
            patience.cancel()
        self.assertEqual([row.split(",")[0] for row in rows], ["frame", "0", "1", "2", "3", "4", "5"])

    def test_summary(self):
        self.assertIn("7 frames of 24 atoms", self.run_frames("--csv", "a.csv").stdout)
        self.assertEqual(self.run_frames("--csv", "a.csv", "--quiet").stdout, "")


class Frames(TrajectoryTest):
    def test_ranges_are_those_of_python(self):
        for text in (":", "::", "2:", ":3", "1:6:2", "::3", "-2:", ":-2", "-5:-1:2", "0:100:5", "-100:2", "6:7", "::100"):
            parts = [int(part) if part else None for part in text.split(":")]
            expected = list(range(7))[slice(*parts)]
            with self.subTest(text):
                self.assertEqual([int(row["frame"]) for row in self.table("--frames", text)], expected)
        for text, expected in (("3", "3"), ("-1", "6"), ("0", "0")):
            self.assertEqual([row["frame"] for row in self.table("--frames", text)], [expected])

    def test_ranges_that_make_no_sense(self):
        for text in ("a", "1:b", "1:2:x", "1:2:3:4", "1.5", "", " 1:2", "99999999999999999999:"):
            self.assert_frames_fail(USAGE, ["--frames", f"'{text}'"], "--frames", text)
        self.assert_frames_fail(USAGE, ["--frames", "step"], "--frames", "::0")
        self.assert_frames_fail(USAGE, ["--frames", "step"], "--frames", "::-1")

    def test_ranges_without_frames(self):
        for text in ("7:", "3:3", "5:2", ":-7"):
            self.assert_frames_fail(USAGE, ["--frames", text, "7 frames", "t.dcd"], "--frames", text)
        for text in ("7", "-8"):
            self.assert_frames_fail(USAGE, ["--frames", f"no frame {text}", "7 frames, 0 to 6"], "--frames", text)


class Faults(TrajectoryTest):
    def make_page(self, *arguments, **keywords):
        probe = self.run_cpu("top.pdb", "-o", "probe.html", code=None)
        if probe.returncode == USAGE and "three.js" in probe.stderr:
            self.skipTest("this build has no three.js")
        return self.run_frames("-o", "a.html", *arguments, **keywords)

    def test_a_damaged_first_frame_does_not_lose_pictures_and_pages(self):
        self.write("bad.dcd", dcd_bytes(with_nan(self.frames, 2, 10)))
        for surface in ("ses", "gaussian"):  # whose camera needs a mesh
            small = ["--size", "60x40", "--surface", surface]
            result = self.run_frames("--frames", "2:5", "-o", "bad%d.png", *small, trajectory="bad.dcd", code=FRAMES_FAILED)
            self.assertIn("frame 2 failed", result.stderr)
            self.run_frames("--frames", "3:5", "-o", "good%d.png", *small)
            for k in (3, 4):
                self.assertEqual((self.folder / f"bad{k}.png").read_bytes(), (self.folder / f"good{k}.png").read_bytes())
            self.assertFalse((self.folder / "bad2.png").exists())
        self.make_page("--frames", "2:5", trajectory="bad.dcd", code=FRAMES_FAILED)
        self.assertEqual([mesh.label.split(",")[0] for mesh in Page(self.folder / "a.html").meshes], ["frame 3", "frame 4"])

    def test_a_page_that_would_be_too_large(self):
        """It is said after the first frame how many fit; tables are not lost."""
        apart = [(20.0 * k, 0, 0) for k in range(24)]  # the others are far smaller, which nobody can know
        self.write("long.dcd", dcd_bytes([apart] + [[(0.01 * k, 0, 0) for k in range(24)]] * 999))

        def assert_said(result):
            self.assertRegex(result.stderr, r"500 MB.* about [1-9][0-9]* of its 1000 surfaces fit")
            self.assertFalse((self.folder / "a.html").exists())
        assert_said(self.make_page(trajectory="long.dcd", spacing=0.15, code=OUTPUT))
        self.assertFalse((self.folder / "a.csv").exists())
        assert_said(self.make_page("--csv", "a.csv", trajectory="long.dcd", spacing=0.15, code=OUTPUT))
        self.assertEqual(len((self.folder / "a.csv").read_text().splitlines()), 1001)
        assert_said(self.make_page("--per-atom", "p.csv", trajectory="long.dcd", spacing=0.15, code=OUTPUT))
        self.assertEqual(len((self.folder / "p.csv").read_text().splitlines()), 1 + 1000 * 24)

    def test_models_that_would_be_too_large_for_a_page(self):
        self.make_page("--frames", "0")  # or there are no pages
        apart = pdb_text(self.atoms, [(20.0 * k, 0, 0) for k in range(24)])
        self.write("models.pdb", "".join(f"MODEL     {k + 1:4d}\n{apart}ENDMDL\n" for k in range(400)))
        result = self.run_cpu("models.pdb", "--model", "all", "-v", "0.1", "-o", "b.html", code=OUTPUT)
        self.assertRegex(result.stderr, r"500 MB.* about [1-9][0-9]* of its 400 surfaces fit")
        self.assertFalse((self.folder / "b.html").exists())

    def test_a_damaged_frame_does_not_lose_the_others(self):
        expected = self.table("-o", "good%d.ply")
        self.write("bad.dcd", dcd_bytes(with_nan(self.frames, 3, 10)))
        for workers, threads in ((1, 1), (1, 9), (3, 3)):
            result = self.run_frames("--workers", workers, "--threads", threads, "--csv", "a.csv", "--json", "a.json", "-o", "bad%d.ply",
                                     trajectory="bad.dcd", code=FRAMES_FAILED)
            self.assertIn("frame 3 failed", result.stderr)
            self.assertIn("atom 11", result.stderr)
            self.assertIn("1 of 7 frames failed", result.stderr)
            rows = list(csv.DictReader((self.folder / "a.csv").read_text().splitlines()))
            self.assertEqual(rows[:3] + rows[4:], expected[:3] + expected[4:])
            self.assertEqual(rows[3]["frame"], "3")
            self.assertIn("atom 11", rows[3]["error"])
            self.assertEqual([rows[3][column] for column in COLUMNS[1:7]], [""] * 6)
            reports = [json.loads(line) for line in (self.folder / "a.json").read_text().splitlines()]
            self.assertEqual([report["frame"] for report in reports], list(range(7)))
            self.assertIn("atom 11", reports[3]["error"])
            self.assertEqual([k for k in range(7) if (self.folder / f"bad{k}.ply").exists()], [0, 1, 2, 4, 5, 6])

    def test_a_mesh_that_can_not_be_written_does_not_lose_the_others(self):
        (self.folder / "f2.ply").mkdir()
        result = self.run_frames("-o", "f%d.ply", "--per-atom", "a.csv", "--per-residue", "r.csv", code=FRAMES_FAILED)
        self.assertIn("frame 2 failed", result.stderr)
        self.assertIn("f2.ply", result.stderr)
        for k in (0, 1, 3, 4, 5, 6):
            self.assertTrue((self.folder / f"f{k}.ply").is_file())
        for name in ("a.csv", "r.csv"):  # its numbers are left out, too
            rows = csv.DictReader((self.folder / name).read_text().splitlines())
            self.assertEqual({row["frame"] for row in rows}, set("013456"))

    def test_frames_that_need_too_much_memory_are_reported(self):
        for workers, threads in ((1, 1), (1, 9), (3, 9)):
            rows = self.table("--memory", "4K", "--workers", workers, "--threads", threads, code=FRAMES_FAILED)
            self.assertEqual([row["frame"] for row in rows], [str(k) for k in range(7)])
            for row in rows:
                self.assertIn("memory", row["error"])
                self.assertEqual(f"shared by {workers} frames" in row["error"], workers > 1)

    def test_of_many_messages_the_first_are_shown(self):
        for count, rest in ((20, None), (21, "1 more message of failed frames is not shown"),
                            (28, "8 more messages of failed frames are not shown")):
            self.write("many.dcd", dcd_bytes((4 * self.frames)[:count]))
            lines = self.run_frames("--memory", "4K", trajectory="many.dcd", code=FRAMES_FAILED).stderr.splitlines()
            self.assertEqual(len([line for line in lines if " failed: " in line]), 20)
            self.assertEqual([line for line in lines if " more message" in line], [f"quickses: {rest}"] if rest else [])

    def test_memory_is_shared_by_the_frames_in_flight(self):
        def run(kilobytes, workers, code):
            return self.run_frames("--memory", f"{kilobytes}K", "--workers", workers, "--threads", workers, code=code)
        enough = 64
        while run(enough, 1, None).returncode != OK:
            enough *= 2
        self.assertGreater(enough, 64)
        self.assertIn("shared by 2 frames", run(enough, 2, FRAMES_FAILED).stderr)
        run(2 * enough, 2, OK)

    def test_a_file_that_is_cut_off_gives_the_frames_that_are_whole(self):
        expected = self.table()
        whole = dcd_bytes(self.frames)
        size_of_frame = (len(whole) - len(dcd_bytes(self.frames[:1]))) // 6
        self.write("cut.dcd", whole[:-size_of_frame // 2])
        result = self.run_frames("--csv", "-", trajectory="cut.dcd")
        self.assertEqual(list(csv.DictReader(result.stdout.splitlines())), expected[:6])
        self.assertIn("warning", result.stderr)
        self.assertIn("cut.dcd", result.stderr)

    def test_different_numbers_of_atoms(self):
        self.write("other.dcd", dcd_bytes([frame[:20] for frame in self.frames]))
        self.assert_fails(INPUT, ["top.pdb", "24 atoms", "other.dcd", "20"], "top.pdb", "--trajectory", "other.dcd",
                          "--csv", "a.csv", "--backend", "cpu")

    def test_inputs_that_can_not_be_read(self):
        self.assert_fails(INPUT, ["nowhere.xtc", "no such file"], "top.pdb", "--trajectory", "nowhere.xtc")
        self.write("empty.dcd", "")
        self.assert_fails(INPUT, ["empty.dcd", "empty"], "top.pdb", "--trajectory", "empty.dcd")
        self.assert_fails(INPUT, ["top.txt"], "top.txt", "--trajectory", "t.dcd")

    def test_outputs_that_can_not_be_written(self):
        for flag, name in (("-o", "none/f%d.ply"), ("--csv", "none/a.csv"), ("--json", "none/a.json")):
            self.assert_frames_fail(OUTPUT, ["none"], flag, name)

    def test_patterns_of_output(self):
        self.run_frames("--frames", "5:", "-o", "50%%_%4d_x.obj")
        self.assertTrue((self.folder / "50%_   5_x.obj").is_file())
        self.assertTrue((self.folder / "50%_   6_x.obj").is_file())
        self.run_frames("--frames", "5", "-o", "%s_%d.ply")
        self.assertTrue((self.folder / "top_5.ply").is_file())
        for name in ("50%.pdb", "a%d.pdb", "100%%.pdb"):  # percent signs of the input's name are no place of a number
            self.write(name, (self.folder / "top.pdb").read_bytes())
            self.run_frames("--frames", "5", "-o", "%s_%d.ply", top=name)
            self.assertTrue((self.folder / f"{name[:-4]}_5.ply").exists())
        self.run_frames("--frames", "5", "-o", "f%020d.ply")  # as wide as it may be
        self.assertTrue((self.folder / f"f{5:020}.ply").exists())
        self.assert_frames_fail(USAGE, ["--output (-o)", "ftop.ply"], "-o", "f%s.ply")  # all frames in one file
        for name in ("f.ply", "f%.ply", "f%d_%d.ply", "f%5.2d.ply", "f%-5d.ply", "f%021d.ply", "f%99d.ply",
                     "f%0999d.ply", "f%n.ply", "f%ld.ply"):
            self.assert_frames_fail(USAGE, ["--output (-o)", name], "-o", name)
        self.assert_frames_fail(USAGE, ["--output (-o)", ".ply"], "-o", "f%d.gif")

    def test_flags_that_do_not_go_together(self):
        for flags in (["--frames", "1:2"], ["--unwrap"], ["--csv", "a.csv"], ["--workers", "2"]):
            self.assert_fails(USAGE, [flags[0], "--trajectory"], CRAMBIN, *flags)
        for name, hint in (("a.pdb.gz", "quickses FILE --trajectory FILE"), ("a.cif", "--model all --json")):
            self.assert_fails(USAGE, ["--csv", hint], name, "--csv", "-")
        self.assert_frames_fail(USAGE, ["--model"], "--model", "all")
        self.assert_frames_fail(USAGE, ["--csv", "--json"], "--csv", "-", "--json", "-")
        self.assert_frames_fail(USAGE, ["--csv", "--json"], "--csv", "a", "--json", "a")
        for flag in ("--csv", "--json"):
            for name in ("t.dcd", "top.pdb"):
                self.assert_frames_fail(USAGE, [flag, name, "input"], flag, name)
        self.assert_frames_fail(USAGE, ["--workers"], "--workers", "0")

    def test_devices_that_make_no_sense(self):
        for text, part in (("x", "'x'"), ("-1", "'-1'"), ("1.5", "'1.5'"), ("0,", "''"), (",", "''"), ("0,x", "'x'"),
                           ("all,0", "'all'"), ("0,1,0", "device 0 twice")):
            self.assert_fails(USAGE, ["--device", part], "top.pdb", "--trajectory", "t.dcd", "--device", text)
        for text in ("0", "0,1", "all"):
            self.assert_frames_fail(USAGE, ["--device", "--backend is cpu"], "--device", text)

    def test_several_devices_are_for_trajectories(self):
        for text in ("0,1", "all"):
            for command in ([CRAMBIN], ["measure", CRAMBIN], ["cavities", CRAMBIN], ["bench", CRAMBIN]):
                self.assert_fails(USAGE, [f"--device {text}", "--trajectory"], *command, "--device", text)


class Unwrap(TrajectoryTest):
    EDGE = 20.0

    def setUp(self):
        super().setUp()
        # A box around the chain whose border cuts it: what is beyond comes back on the other side.
        self.whole = [[(x + 1, y + 1, z + 2) for x, y, z in frame] for frame in self.frames]
        self.torn = [[tuple(value % self.EDGE for value in position) for position in frame] for frame in self.whole]
        self.write("whole.dcd", dcd_bytes(self.whole, [self.EDGE] * 3))
        self.write("torn.dcd", dcd_bytes(self.torn, [self.EDGE] * 3))

    def sizes(self, rows):
        return [(round(float(row["area"]), 1), round(float(row["volume"]), 1), row["components"]) for row in rows]

    def test_molecules_become_whole(self):
        self.assertNotEqual(self.whole, self.torn)
        expected = self.table(trajectory="whole.dcd")
        torn = self.table(trajectory="torn.dcd")
        unwrapped = self.table("--unwrap", trajectory="torn.dcd")
        for whole, broken, healed in zip(expected, torn, unwrapped):
            self.assertEqual(whole["components"], "1")
            self.assertNotEqual(broken["components"], "1")
            self.assertEqual(healed["components"], "1")
            # Moved by whole box vectors: the lattice lies elsewhere, so the mesh is another one of the same surface.
            self.assertAlmostEqual(float(healed["area"]), float(whole["area"]), delta=0.01 * float(whole["area"]))
            self.assertAlmostEqual(float(healed["volume"]), float(whole["volume"]), delta=0.01 * float(whole["volume"]))

    def test_bonds_of_atoms_that_are_left_out_count(self):
        rows = self.table("--unwrap", "--select", "//A//CA,C", trajectory="torn.dcd")
        expected = self.table("--select", "//A//CA,C", trajectory="whole.dcd")
        self.assertEqual([row["components"] for row in rows], [row["components"] for row in expected])

    def test_without_a_box(self):
        result = self.run_frames("--unwrap", "--csv", "-")
        self.assertEqual(list(csv.DictReader(result.stdout.splitlines())), self.table())
        self.assertIn("warning: --unwrap", result.stderr)
        self.assertIn("box", result.stderr)

    def test_a_frame_without_a_box_is_not_measured_as_it_is(self):
        expected = self.table("--unwrap", trajectory="torn.dcd")
        cell = [self.EDGE] * 3
        for k in (0, 3):
            self.write("boxless.dcd", dcd_bytes(self.torn, cell, boxless=[k]))
            rows = self.table("--unwrap", "--json", "a.json", trajectory="boxless.dcd", code=FRAMES_FAILED)
            others = [other for other in range(7) if other != k]
            self.assertEqual(self.sizes([rows[other] for other in others]), self.sizes([expected[other] for other in others]))
            self.assertEqual([rows[k][column] for column in COLUMNS[1:7]], [""] * 6)
            self.assertRegex(rows[k]["error"], "--unwrap: 'boxless.dcd': .*no periodic box")
            self.assertEqual(json.loads((self.folder / "a.json").read_text().splitlines()[k])["error"], rows[k]["error"])
        result = self.run_cpu("top.pdb", "--trajectory", "torn.dcd", "--trajectory", "t.dcd", "--unwrap", "-v", "0.8", "--csv", "-",
                              code=FRAMES_FAILED)  # the second has no boxes
        rows = list(csv.DictReader(result.stdout.splitlines()))
        self.assertEqual([bool(row["error"]) for row in rows], [False] * 7 + [True] * 7)

    def test_bonds_are_those_of_the_first_frame_that_can_be_read(self):
        expected = self.table("--unwrap", trajectory="torn.dcd")
        self.write("bad.dcd", dcd_bytes(with_nan(self.torn, 0, 10), [self.EDGE] * 3))
        rows = self.table("--unwrap", "--frames", "1:", trajectory="bad.dcd")
        self.assertEqual(self.sizes(rows), self.sizes(expected[1:]))
        self.write("all_bad.dcd", dcd_bytes(with_nan(self.torn[:1], 0, 10), [self.EDGE] * 3))
        self.assert_fails(INPUT, ["--unwrap", "all_bad.dcd", "frame 0", "atom 11"], "top.pdb", "--trajectory", "all_bad.dcd", "--unwrap",
                          "--csv", "a.csv", "--backend", "cpu")


if __name__ == "__main__":
    cli_test.PROGRAM = cli_test.program_to_test(cli_test.PROGRAM, __doc__)
    unittest.main()
