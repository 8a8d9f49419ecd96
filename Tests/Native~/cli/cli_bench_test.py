# SPDX-License-Identifier: MIT
"""Tests of quickses bench: what is in its report, and what it refuses. Times are looked at only for being there.

usage: cli_bench_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import json
import random
import sys
import unittest

import cli_test
from cli_test import BACKEND, CRAMBIN, INPUT, USAGE, ProgramTest, can_refuse_threads, refuse_threads

TWO_ATOMS = "0 0 0 1.5\n2 0 0 1.5\n"


class BenchTest(ProgramTest):
    def bench(self, *arguments):
        return json.loads(self.run_cpu("bench", *arguments, "--json", "-").stdout)

    def assert_times(self, place):
        self.assertGreater(place["min"], 0)
        self.assertGreaterEqual(place["median"], place["min"])
        self.assertGreater(place["memory"]["peak_host"], 0)
        self.assertGreater(place["memory"]["mesh"], 0)


class Reports(BenchTest):
    def test_report(self):
        self.write("two.xyzr", TWO_ATOMS)
        report = self.bench(CRAMBIN, "two.xyzr", "--repeat", "3", "--threads", "1")
        self.assertEqual((report["repeat"], report["copies"], report["backend"]), (3, 1, "cpu"))
        self.assertRegex(report["version"], r"^\d+\.\d+\.\d+")
        self.assertTrue(report["device"])
        self.assertEqual({key: report["settings"][key] for key in ("spacing", "creases", "threads", "layout")},
                         {"spacing": 0.5, "creases": False, "threads": 1, "layout": "separate"})
        self.assertEqual([entry["atoms"] for entry in report["structures"]], [327, 2])
        self.assertEqual([entry["input"] for entry in report["structures"]], [str(CRAMBIN), "two.xyzr"])
        for entry in report["structures"]:
            self.assertGreater(entry["triangles"], 0)
            self.assertEqual((2 * entry["vertices"] - entry["triangles"]) % 4, 0)  # Euler: closed and oriented
            self.assert_times(entry["host"])
            self.assertNotIn("stages", entry["host"])
            self.assertNotIn("device", entry)

    def test_the_mesh_is_that_of_the_program(self):
        mesh = json.loads(self.run_cpu(CRAMBIN, "--creases", "off", "--json", "-").stdout)["mesh"]
        entry, = self.bench(CRAMBIN, "--repeat", "1")["structures"]
        self.assertEqual([entry[key] for key in ("vertices", "triangles")], [mesh[key] for key in ("vertices", "triangles")])

    def test_measures_are_those_of_the_program(self):
        arguments = ("measure", CRAMBIN, "--surface", "ses", "--creases", "off", "--json", "-")
        found = json.loads(self.run_cpu(*arguments).stdout)["surfaces"][0]
        entry, = self.bench(CRAMBIN, "--repeat", "1", "--measure")["structures"]
        plain, = self.bench(CRAMBIN, "--repeat", "1")["structures"]
        for name in ("area", "volume"):
            self.assertEqual(entry[name], found[name])
            self.assertNotIn(name, plain)

    def test_layouts_and_their_bytes(self):
        for layout, vertex in (("separate", 24), ("interleaved", 24), ("compact", 16)):
            with self.subTest(layout):
                report = self.bench(CRAMBIN, "--repeat", "1", "--layout", layout)
                entry, = report["structures"]
                self.assertEqual(report["settings"]["layout"], layout)
                owners, triangle = 4, 12
                self.assertEqual(entry["host"]["memory"]["mesh"],
                                 (vertex + owners) * entry["vertices"] + triangle * entry["triangles"])

    def test_stages(self):
        stages = self.bench(CRAMBIN, "--repeat", "2", "--stages")["structures"][0]["host"]["stages"]
        for name in ("neighbor_grid", "solvent_features", "exact_ses", "marching_cubes", "projection"):
            self.assertGreater(stages[name], 0)
        printed = self.run_cpu("bench", CRAMBIN, "--repeat", "1", "--stages").stdout
        for name in stages:
            self.assertRegex(printed, rf"\n  host +{name} ")

    def test_cuda_has_meshes_in_both_places(self):
        report = json.loads(self.run_program("bench", CRAMBIN, "--repeat", "2", "--stages", "--json", "-").stdout)
        if report["backend"] != "cuda":
            self.skipTest("no CUDA here")
        entry, = report["structures"]
        for place in (entry["device"], entry["host"]):
            self.assert_times(place)
            self.assertGreater(place["memory"]["peak_device"], place["memory"]["mesh"])
            self.assertIn("exact_ses", place["stages"])
        self.assertEqual(entry["device"]["memory"]["mesh"], entry["host"]["memory"]["mesh"])
        for delivery in ("host", "device"):
            arguments = ("bench", CRAMBIN, "--repeat", "1", "--delivery", delivery, "--json", "-")
            alone, = json.loads(self.run_program(*arguments).stdout)["structures"]
            self.assertEqual([place for place in ("device", "host") if place in alone], [delivery])
            self.assertEqual(alone["triangles"], entry["triangles"])

    def test_small_surfaces(self):
        self.write("two.xyzr", "0 0 0 1.5\n2 0 0 1.5\n")
        result = self.run_cpu("bench", CRAMBIN, "two.xyzr", "--small", "100", "--repeat", "1", "--json", "-")
        pieces, whole = (entry["small"] for entry in json.loads(result.stdout)["structures"])
        self.assertEqual(pieces["surfaces"], 100)
        self.assertEqual(pieces["fewest_atoms"], 100)
        self.assertLess(pieces["most_atoms"], 100 + 14)  # the largest amino acid, without hydrogen
        self.assertGreater(pieces["total"], 0)
        self.assertEqual((whole["fewest_atoms"], whole["most_atoms"]), (2, 2))
        if can_refuse_threads():
            self.run_cpu("bench", "two.xyzr", "--small", "100", "--repeat", "1", preexec_fn=refuse_threads)

    def test_jobs(self):
        result = self.run_cpu("bench", CRAMBIN, "--jobs", "--repeat", "2", "--json", "-")
        jobs = json.loads(result.stdout)["structures"][0]["jobs"]
        for name in ("begin", "begin_replacing", "cancel_to_idle", "destroy", "first_level", "finest_alone", "ladder"):
            self.assertGreater(jobs[name]["median"], 0)
            self.assertGreaterEqual(jobs[name]["max"], jobs[name]["median"])
        self.assertGreater(jobs["ladder_to_finest"], 0)
        self.assertIn("cancel to idle", self.run_cpu("bench", CRAMBIN, "--jobs", "--repeat", "1").stdout)
        self.assert_fails(USAGE, ["--jobs", "--small"], "bench", CRAMBIN, "--jobs", "--small", "100")

    def test_summary(self):
        self.assertIn("327 atoms", self.run_cpu("bench", CRAMBIN, "--repeat", "1").stdout)
        self.assertIn("981 atoms", self.run_cpu("bench", CRAMBIN, "--repeat", "1", "--copies", "3").stdout)


class Copies(BenchTest):
    def assert_copies(self, copies, path, *arguments):
        one, = self.bench(path, "--repeat", "1", *arguments)["structures"]
        report = self.bench(path, "--repeat", "1", "--copies", str(copies), *arguments)
        all_of_them, = report["structures"]
        self.assertEqual(report["copies"], copies)
        for key in ("atoms", "vertices", "triangles"):
            self.assertEqual(all_of_them[key], copies * one[key], key)

    def test_each_copy_has_the_same_mesh(self):
        # Places that float32 has exactly after each shift; a radius by which no lattice point is so near to an atom's
        # sphere, of any probe below, that rounding decides. Off the origin.
        numbers = random.Random(5)
        self.write("a.xyzr", "".join(
            f"{40 + numbers.randrange(160) / 16} {numbers.randrange(64) / 16} {numbers.randrange(128) / 16} 1.5371\n"
            for _ in range(40)))
        for copies in (2, 7, 12):
            for arguments in ((), ("--spacing", "0.25"), ("--surface", "sas", "--probe", "3"), ("--spacing", "2")):
                with self.subTest(copies=copies, arguments=arguments):
                    self.assert_copies(copies, "a.xyzr", *arguments)

    def test_copies_of_a_protein(self):
        one, = self.bench(CRAMBIN, "--repeat", "1")["structures"]
        five, = self.bench(CRAMBIN, "--repeat", "1", "--copies", "5")["structures"]
        self.assertAlmostEqual(five["triangles"] / one["triangles"], 5, delta=0.005)  # float32 rounds where they are
        self.assertEqual(five["host"]["memory"]["mesh"], 28 * five["vertices"] + 12 * five["triangles"])

    def test_jobs_of_copies(self):
        entry, = self.bench(CRAMBIN, "--repeat", "1", "--copies", "2", "--jobs")["structures"]
        self.assertEqual(entry["atoms"], 654)
        self.assertGreater(entry["jobs"]["ladder"]["median"], 0)

    def test_jobs_and_small_surfaces_have_the_settings_of_the_others(self):
        for mode in (("--jobs",), ("--small", "100")):
            with self.subTest(mode=mode):
                report = self.bench(CRAMBIN, "--repeat", "1", *mode, "--measure", "--layout", "compact", "--no-owners")
                self.assertEqual(report["settings"]["layout"], "compact")
                self.assertIs(report["settings"]["owners"], False)


class Errors(BenchTest):
    def test_inputs(self):
        self.assert_fails(INPUT, ["nowhere.pdb"], "bench", CRAMBIN, "nowhere.pdb")

    def test_values(self):
        for flag, values in (("--repeat", ("0", "few")), ("--copies", ("0", "-1", "1.5", "10001", "many")),
                             ("--delivery", ("nowhere", "")), ("--layout", ("16", ""))):
            for value in values:
                with self.subTest(flag=flag, value=value):
                    self.assert_fails(USAGE, [flag], "bench", CRAMBIN, flag, value)

    def test_what_does_not_go_together(self):
        for other in (("--jobs",), ("--small", "100")):
            for flag in (("--delivery", "host"), ("--stages",)):
                with self.subTest(other=other, flag=flag):
                    self.assert_fails(USAGE, [flag[0], "--jobs", "--small"], "bench", CRAMBIN, *other, *flag)
        self.assert_fails(USAGE, ["--copies", "--small"], "bench", CRAMBIN, "--small", "100", "--copies", "2")

    def test_the_cpu_has_no_device(self):
        for delivery in ("device", "both"):
            arguments = ("bench", CRAMBIN, "--repeat", "1", "--delivery", delivery)
            self.assert_fails(USAGE, ["--delivery", "--backend is cpu"], *arguments, "--backend", "cpu")
            backend = json.loads(self.run_program("bench", CRAMBIN, "--repeat", "1", "--json", "-").stdout)["backend"]
            if backend == "cpu":
                self.assert_fails(BACKEND, ["--delivery", "CUDA"], *arguments)

    def test_copies_reach_too_far(self):
        self.write("far.xyzr", "-600000 -600000 -600000 100\n600000 600000 600000 100\n")
        self.assert_fails(USAGE, ["--copies", "10^6"], "bench", "far.xyzr", "--copies", "8", "--spacing", "100",
                          "--backend", "cpu")


if __name__ == "__main__":
    cli_test.PROGRAM = cli_test.program_to_test(cli_test.PROGRAM, __doc__)
    unittest.main()
