# SPDX-License-Identifier: MIT
"""Tests of quickses --trajectory on one and on several GPUs; exits with 77 where there is none.

usage: cli_cuda_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import csv
import json
import re
import subprocess
import sys
import unittest

import cli_test
from cli_test import BACKEND, CRAMBIN, OK, ProgramTest, is_closed, read_ply
from trajectory_files import chain_of, dcd_bytes, moving, pdb_text, with_nan

FRAMES_FAILED = 6
FRAMES = 60
TABLES = ["--csv", "--per-atom", "--per-residue"]


def count_devices():
    """How many there are, and what the program says of one that can't be there."""
    result = subprocess.run([cli_test.PROGRAM, CRAMBIN, "-v", "2", "--backend", "cuda", "--device", "9999"],
                            capture_output=True, encoding="utf-8", timeout=cli_test.PATIENCE)
    found = re.search(r"there (?:is|are) (\d+) CUDA device", result.stderr)
    return int(found.group(1)) if found else 0, result.stderr.strip()


class CudaTest(ProgramTest):
    devices = 0

    def setUp(self):
        super().setUp()
        atoms, positions = chain_of(24)
        self.frames = moving(positions, FRAMES)
        self.write("top.pdb", pdb_text(atoms, positions))
        self.write("t.dcd", dcd_bytes(self.frames))

    def run_frames(self, *arguments, code=OK, trajectory="t.dcd", command=()):
        return self.run_program(*command, "top.pdb", "--trajectory", trajectory, "-v", "0.8", "--backend", "cuda",
                                *arguments, code=code)

    def tables(self, *arguments, **keywords):
        """Their bytes; nothing but numbers has to leave the GPU for them."""
        self.run_frames(*arguments, *(word for flag in TABLES for word in (flag, "a" + flag)), **keywords)
        return [(self.folder / ("a" + flag)).read_bytes() for flag in TABLES]

    def device_lists(self):
        """Values of --device: each device, all of them, and the others in reverse."""
        lists = [str(k) for k in range(self.devices)] + ["all"]
        if self.devices > 1:
            lists.append(",".join(str(k) for k in reversed(range(self.devices))))
        return lists


class Results(CudaTest):
    def test_tables_have_the_numbers_of_the_meshes(self):
        numbers = self.tables()
        self.assertEqual(self.tables("-o", "f%02d.ply", "--hard-edges", "off"), numbers)
        self.assertEqual(self.tables("--json", "a.json"), numbers)
        rows = list(csv.DictReader(numbers[0].decode().splitlines()))
        reports = [json.loads(line) for line in (self.folder / "a.json").read_text().splitlines()]
        self.assertEqual(len(rows), FRAMES)
        for k, (row, report) in enumerate(zip(rows, reports)):
            self.assertEqual((int(row["frame"]), report["frame"]), (k, k))
            self.assertAlmostEqual(float(row["area"]), report["area"], delta=0.0001)
            self.assertEqual(int(row["components"]), len(report["components"]))
            self.assertEqual(report["backend"], "cuda")
            self.assertTrue(is_closed(read_ply(self.folder / f"f{k:02d}.ply")[3]))

    def test_surfaces_whose_numbers_come_from_the_atoms(self):
        for surface in ("sas", "vdw"):
            numbers = self.tables("--surface", surface)
            self.assertEqual(self.tables("--surface", surface, "--json", "a.json"), numbers)

    def test_they_depend_on_nothing_but_the_frames(self):
        expected = self.tables("--workers", 1, "--threads", 1)
        for workers, threads in ((1, 3), (3, 3), (2, 16), (16, 16)):
            self.assertEqual(self.tables("--workers", workers, "--threads", threads), expected)
        for devices in self.device_lists():
            for workers in (1, 2, 8):
                with self.subTest(devices=devices, workers=workers):
                    self.assertEqual(self.tables("--device", devices, "--workers", workers), expected)
        self.assertEqual(self.tables("--device", "all", "--memory", "256M"), expected)

    def test_meshes_of_all_devices_are_alike(self):
        def meshes(name, *arguments):
            self.run_frames("--frames", ":20", "-o", name + "%d.ply", *arguments)
            return [(self.folder / f"{name}{k}.ply").read_bytes() for k in range(20)]

        expected = meshes("one", "--device", "0", "--workers", 1)
        for devices in self.device_lists():
            self.assertEqual(meshes("all", "--device", devices), expected)

    def test_measurements(self):
        command = ["measure"]
        expected = self.tables("--surface", "ses,sas", "--workers", 1, "--threads", 1, command=command)
        for devices in self.device_lists():
            self.assertEqual(self.tables("--surface", "ses,sas", "--device", devices, command=command), expected)


class Devices(CudaTest):
    def test_all_of_them_compute(self):
        summary = self.run_frames("--device", "all", "--workers", 2, "--csv", "a.csv").stdout
        self.assertIn(f" {2 * self.devices} at a time", summary)
        self.assertEqual(f"{self.devices} devices" in summary, self.devices > 1)

    def test_one_that_is_not_there(self):
        there = "there is 1 CUDA device" if self.devices == 1 else f"there are {self.devices} CUDA devices"
        for text in (str(self.devices), f"0,{self.devices}"):
            for backend in ([], ["--backend", "cuda"]):
                self.assert_fails(BACKEND, [f"--device {text}", there], "top.pdb", "--trajectory", "t.dcd", "--csv", "a.csv",
                                  "--device", text, *backend)
        self.assert_fails(BACKEND, [f"--device {self.devices}", there], CRAMBIN, "--device", self.devices)
        self.assert_fails(BACKEND, [f"--device {self.devices}", there], "bench", CRAMBIN, "--device", self.devices)

    def test_a_damaged_frame_does_not_lose_the_others(self):
        expected = self.tables()[0].splitlines()
        self.write("bad.dcd", dcd_bytes(with_nan(self.frames, 31, 10)))
        for devices in self.device_lists():
            rows = self.tables("--device", devices, trajectory="bad.dcd", code=FRAMES_FAILED)[0].splitlines()
            self.assertEqual(rows[:32] + rows[33:], expected[:32] + expected[33:])
            self.assertIn(b"atom 11", rows[32])


if __name__ == "__main__":
    cli_test.PROGRAM = cli_test.program_to_test(cli_test.PROGRAM, __doc__)
    CudaTest.devices, said = count_devices()
    if CudaTest.devices == 0:
        print("skipped, no CUDA device:", said)
        sys.exit(77)
    print("CUDA devices:", CudaTest.devices)
    unittest.main()
