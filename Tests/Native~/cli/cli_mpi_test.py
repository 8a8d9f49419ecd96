# SPDX-License-Identifier: MIT
"""Tests of the quickses program shared by several processes of Open MPI on this machine.

usage: cli_mpi_test.py PROGRAM MPIRUN [unittest options]
"""
import json
import os
import subprocess
import sys
import unittest

import cli_test
from cli_test import CRAMBIN, INPUT, OK, USAGE, ProgramTest
from trajectory_files import chain_of, dcd_bytes, moving, pdb_text, with_nan

MPIRUN = ""
FRAMES_FAILED = 6


class MpiTest(ProgramTest):
    def setUp(self):
        super().setUp()
        atoms, positions = chain_of(24)
        self.frames = moving(positions, 30)
        self.write("top.pdb", pdb_text(atoms, positions))
        self.write("t.dcd", dcd_bytes(self.frames))
        self.write("bad.dcd", dcd_bytes(with_nan(with_nan(self.frames, 4, 0), 29, 23)))

    def run_processes(self, count, *arguments, code=OK):
        result = subprocess.run(
            [MPIRUN, "--allow-run-as-root", "--oversubscribe", "-n", str(count), cli_test.PROGRAM, *map(str, arguments),
             "--backend", "cpu"], stdin=subprocess.DEVNULL, capture_output=True, cwd=self.folder, encoding="utf-8",
            timeout=cli_test.PATIENCE)
        self.assertEqual(result.returncode, code, result.stderr + result.stdout)
        return result

    def read(self, name):
        return (self.folder / name).read_bytes()

    def said(self, result):
        return [line for line in result.stderr.splitlines() if line.startswith("quickses:")]

    def without_times(self, name):
        reports = [json.loads(line) for line in self.read(name).splitlines()]
        for report in reports:
            for key in ("time_ms", "memory", "settings"):
                report.pop(key, None)
        return reports


class Sharing(MpiTest):
    def compare(self, trajectory, code):
        arguments = ["top.pdb", "--trajectory", trajectory, "-v", "0.8", "--frames", "1::1"]
        self.run_cpu(*arguments, "--csv", "one.csv", "--json", "one.json", "-o", "one_%d.ply", code=code)
        meshes = {path.name[4:]: path.read_bytes() for path in self.folder.glob("one_*.ply")}
        self.assertGreater(len(meshes), 20)
        for count in (1, 2, 4):
            with self.subTest(f"{count} processes"):
                result = self.run_processes(count, *arguments, "--csv", "all.csv", "--json", "all.json", "-o",
                                            f"{count}_%d.ply", code=code)
                self.assertEqual(self.read("all.csv"), self.read("one.csv"))
                expected = self.without_times("one.json")
                for report in expected:
                    if "output" in report:
                        report["output"] = report["output"].replace("one", str(count))
                self.assertEqual(self.without_times("all.json"), expected)
                self.assertEqual({path.name[2:]: path.read_bytes() for path in self.folder.glob(f"{count}_*.ply")}, meshes)
                self.assertEqual(len(result.stdout.splitlines()), 1)
                for frame in (4, 29):
                    said = [line for line in self.said(result) if f"frame {frame} failed" in line]
                    self.assertEqual(len(said), 0 if code == OK else 1)

    def test_the_results_are_those_of_one_process(self):
        self.compare("t.dcd", OK)

    def test_measurements_are_those_of_one_process(self):
        arguments = ["measure", "top.pdb", "--trajectory", "bad.dcd", "--surface", "sas,ses"]
        tables = ["--csv", "--per-residue", "--per-atom"]
        self.run_cpu(*arguments, *(word for flag in tables for word in (flag, "one" + flag)), code=FRAMES_FAILED)
        for count in (2, 4):
            self.run_processes(count, *arguments, *(word for flag in tables for word in (flag, "all" + flag)),
                               code=FRAMES_FAILED)
            for flag in tables:
                self.assertEqual(self.read("all" + flag), self.read("one" + flag))

    def test_damaged_frames_do_not_lose_the_others(self):
        self.compare("bad.dcd", FRAMES_FAILED)

    def test_more_processes_than_frames(self):
        arguments = ["top.pdb", "--trajectory", "t.dcd", "--frames", ":2"]
        self.run_cpu(*arguments, "--csv", "one.csv")
        self.run_processes(4, *arguments, "--csv", "all.csv")
        self.assertEqual(self.read("all.csv"), self.read("one.csv"))

    def test_several_workers_in_each_process(self):
        arguments = ["top.pdb", "--trajectory", "bad.dcd"]
        self.run_cpu(*arguments, "--csv", "one.csv", code=FRAMES_FAILED)
        self.run_processes(2, *arguments, "--csv", "all.csv", "--workers", "3", code=FRAMES_FAILED)
        self.assertEqual(self.read("all.csv"), self.read("one.csv"))


class OneVoice(MpiTest):
    def test_errors_are_told_once(self):
        for code, arguments in ((INPUT, ["top.pdb", "--trajectory", "nowhere.dcd", "--csv", "a.csv"]),
                                (USAGE, ["top.pdb", "--trajectory", "t.dcd", "--frames", "90:"]),
                                (USAGE, ["top.pdb", "--trajectory", "t.dcd", "--bogus"]),
                                (3, ["top.pdb", "--trajectory", "t.dcd", "--csv", "none/a.csv"])):
            before = sorted(self.folder.rglob("*"))
            result = self.run_processes(3, *arguments, code=code)
            self.assertEqual(len(self.said(result)), 1, result.stderr)
            self.assertEqual(result.stdout, "")
            self.assertEqual(sorted(self.folder.rglob("*")), before)

    def test_what_can_not_be_shared_is_done_once(self):
        result = self.run_processes(2, CRAMBIN, "-v", "1", "-o", "a.ply")
        self.assertEqual(len(result.stdout.splitlines()), 1)
        self.run_cpu(CRAMBIN, "-v", "1", "-o", "b.ply")
        self.assertEqual(self.read("a.ply"), self.read("b.ply"))
        self.assertEqual(self.run_processes(2, "--help").stdout.count("Exit codes"), 1)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    cli_test.PROGRAM, MPIRUN = os.path.abspath(sys.argv.pop(1)), sys.argv.pop(1)
    unittest.main()
