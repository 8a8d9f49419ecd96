# SPDX-License-Identifier: MIT
"""The scripts of Scripts~/measure with stand-ins for quickses and Valgrind that report what they are told to; and with the
program itself, whatever times it has.

    measure_scripts_test.py REPOSITORY PROGRAM
"""

import json
import os
import stat
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = CRAMBIN = PROGRAM = ""

OK, WORSE, FAILED, NOT_JUDGED = 0, 1, 2, 77

# quickses bench. plan.json beside it: what --help lists, and of each file its times in ms, one call after the other.
STAND_IN_PROGRAM = """#!@PYTHON@
import json, os, sys
here = os.path.dirname(sys.argv[0])
with open(os.path.join(here, "plan.json")) as file:
    plan = json.load(file)
arguments = sys.argv[2:]
if "--help" in arguments:
    print(" ".join(plan["flags"]))
    sys.exit()
with open(os.path.join(here, "..", "calls"), "a") as file:
    file.write(os.path.basename(here) + " " + " ".join(arguments) + "\\n")
if "fails" in plan:
    sys.exit("quickses: " + plan["fails"])
copies = int(arguments[arguments.index("--copies") + 1]) if "--copies" in arguments else 1
entries = []
for path in arguments[:arguments.index("--quiet")]:
    times = plan["times"].pop(0)
    entry = {"input": path, "atoms": 10 * copies, "vertices": 502 * copies, "triangles": 1000 * copies}
    for place, ms in times.items():
        entry[place] = {"median": ms * copies ** plan["exponent"], "min": 0.1} if plan["places"] else ms
    entries.append(entry)
with open(os.path.join(here, "plan.json"), "w") as file:
    json.dump(plan, file)
print(json.dumps({"version": "1.2.3", "backend": plan["backend"], "device": "a device", "settings": {}, "repeat": 20,
                  "structures": entries}))
"""

# Counts what plan.json beside it says: so much at the start, and so much per surface and function.
STAND_IN_VALGRIND = """#!@PYTHON@
import json, os, sys
with open(os.path.join(os.path.dirname(sys.argv[0]), "plan.json")) as file:
    plan = json.load(file)
arguments = sys.argv[1:]
if "--version" in arguments:
    print("valgrind-3.0.0")
    sys.exit()
if "fails" in plan:
    sys.exit(plan["fails"])
after = lambda flag: arguments[arguments.index(flag) + 1]
assert after("--threads") == "1" and after("--backend") == "cpu"
out = next(a for a in arguments if a.startswith("--callgrind-out-file=")).split("=", 1)[1]
surfaces = 2 + int(after("--repeat"))
with open(out, "w") as file:
    file.write("version: 1\\npositions: line\\nevents: Ir\\n\\nob=quickses\\nfl=???\\nfn=main\\n0 %d\\n" % plan["start"])
    file.write("cfn=quickses::v3::work(int)\\ncalls=1 0\\n0 123456789\\n\\n")
    for name, count in plan["functions"].items():
        file.write("fn=%s\\n0 %d\\n5 %d\\n\\n" % (name, count * surfaces // 4, count * surfaces - count * surfaces // 4))
with open(after("--json"), "w") as file:
    json.dump({"device": "CPU (%s, 8 threads)" % plan["set"]}, file)
"""


class ScriptsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, text):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def write_program(self, name, text, **plan):
        path = self.write(name, text.replace("@PYTHON@", sys.executable))
        os.chmod(path, os.stat(path).st_mode | stat.S_IXUSR)
        self.write(os.path.join(os.path.dirname(name), "plan.json"), json.dumps(plan))
        return path

    def run_script(self, name, *arguments, status=OK, **keywords):
        done = subprocess.run([sys.executable, "-B", os.path.join(SCRIPTS, name), *arguments], capture_output=True,
                              encoding="utf-8", cwd=self.folder, stdin=subprocess.DEVNULL, timeout=300, check=False, **keywords)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def program(self, name, times, **plan):
        """times: of one file after the other, {place: ms}."""
        plan = {"flags": ["--copies", "--delivery"], "backend": "cuda", "exponent": 1, "places": True, "times": times, **plan}
        return self.write_program(f"{name}/quickses", STAND_IN_PROGRAM, **plan)


class Growth(ScriptsTest):
    def test_exponents_are_found(self):
        program = self.program("p", [{"device": 1.5, "host": 4}] * 8, exponent=1.25)
        output = self.run_script("growth", program, "a.pdb", "b.pdb.gz", "-o", "g.json", "--copies", "8,1,4,2", "--", "--repeat", "3")
        with open(self.path("g.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertEqual((report["version"], report["backend"], report["options"]), ("1.2.3", "cuda", ["--repeat", "3"]))
        self.assertEqual([s["input"] for s in report["structures"]], ["a.pdb", "b.pdb.gz"])
        for structure in report["structures"]:
            self.assertEqual([(p["copies"], p["triangles"]) for p in structure["points"]],
                             [(k, 1000 * k) for k in (1, 2, 4, 8)])
            self.assertEqual(structure["points"][0]["device"], 1.5)
            for place in ("device", "host"):
                for fit in ("all", "larger"):
                    self.assertAlmostEqual(structure["exponents"][place][fit], 1.25)
        self.assertIn("^1.250", output)

    def test_the_larger_half_by_itself(self):
        # Each call: the time divided by the copies, which the stand-in multiplies it with.
        program = self.program("p", [{"host": ms / k} for ms, k in ((4, 1), (4, 2), (4, 4), (8, 8))])
        self.run_script("growth", program, "a.pdb", "-o", "g.json", "--copies", "1,2,4,8")
        with open(self.path("g.json"), encoding="utf-8") as file:
            fits = json.load(file)["structures"][0]["exponents"]["host"]
        self.assertAlmostEqual(fits["larger"], 1)
        self.assertLess(fits["all"], 0.5)

    def test_what_goes_wrong(self):
        program = self.program("p", [], fails="'a.pdb': no such file")
        self.assertIn("no such file", self.run_script("growth", program, "a.pdb", "-o", "g.json", status=FAILED))
        self.assertFalse(os.path.exists(self.path("g.json")))
        for copies in ("1", "0,2", "few", ""):
            self.run_script("growth", program, "a.pdb", "-o", "g.json", "--copies", copies, status=FAILED)

    def test_the_program_and_the_picture(self):
        self.run_script("growth", PROGRAM, CRAMBIN, "-o", "g.json", "--copies", "1,2", "--", "--repeat", "1", "--backend", "cpu",
                        "--spacing", "1")
        with open(self.path("g.json"), encoding="utf-8") as file:
            report = json.load(file)
        points = report["structures"][0]["points"]
        self.assertEqual([p["atoms"] for p in points], [327, 654])
        self.assertGreater(points[1]["memory"]["host"]["mesh"], points[0]["memory"]["host"]["mesh"])
        self.assertEqual(set(report["structures"][0]["exponents"]), {"host"})
        try:
            import matplotlib  # pylint: disable=import-outside-toplevel,unused-import
        except ImportError:
            self.assertIn("Matplotlib", self.run_script("plot-growth", "g.png", "g.json", status=FAILED))
            self.skipTest("no Matplotlib here")
        self.run_script("plot-growth", "g.png", "g.json", env={**os.environ, "MPLCONFIGDIR": self.folder})
        with open(self.path("g.png"), "rb") as file:
            self.assertEqual(file.read(8), b"\x89PNG\r\n\x1a\n")
        self.assertIn("none.json", self.run_script("plot-growth", "g.png", "none.json", status=FAILED))


class CompareBuilds(ScriptsTest):
    def compare(self, old, new, *arguments, status=OK, new_plan=None, **old_plan):
        """old, new: times of the rounds."""
        programs = [self.program("old", old, **old_plan), self.program("new", new, **(new_plan or {}))]
        return self.run_script("compare-builds", *programs, "a.pdb", "--rounds", str(len(new)), *arguments, status=status)

    def test_a_slower_build_is_found(self):
        old = [{"device": 1.0, "host": 2.0}] * 3
        self.assertIn("Not slower", self.compare(old, old))
        self.assertIn("Not slower", self.compare(old, [{"device": 1.04, "host": 2.08}] * 3))
        for new in ({"device": 1.06, "host": 2.0}, {"device": 1.0, "host": 2.12}):
            output = self.compare(old, [new] * 3, status=WORSE)
            self.assertIn("1.060 SLOWER", output)
            self.compare(old, [new] * 3, "--tolerance", "10")
        self.assertIn("faster", self.compare(old, [{"device": 0.5, "host": 2.0}] * 3))

    def test_single_rounds_do_not_decide(self):
        disturbed = [{"host": 2.0}, {"host": 9.0}, {"host": 2.0}]
        self.compare([{"host": 2.0}] * 3, disturbed)
        # Both slow down alike in the course of it.
        self.compare([{"host": ms} for ms in (1, 2, 3, 4, 5)], [{"host": ms} for ms in (1, 2, 3, 4, 5)])

    def test_the_builds_take_turns(self):
        self.compare([{"host": 1.0}] * 4, [{"host": 1.0}] * 4, "--", "--repeat", "7")
        with open(self.path("calls"), encoding="utf-8") as file:
            calls = file.read().splitlines()
        self.assertEqual([call.split()[0] for call in calls], ["old", "new", "new", "old", "old", "new", "new", "old"])
        for call in calls:
            self.assertTrue(call.endswith("a.pdb --quiet --json - --repeat 7"), call)

    def test_an_old_build_without_delivery(self):
        new = [{"device": 1.0, "host": 2.0}]
        output = self.compare([{"host": 2.0}], new, flags=["--repeat"], places=False)
        self.assertIn("knows no --delivery", output)
        self.assertIn("old has none", output)
        output = self.compare([{"host": 1.5}], new, flags=["--repeat"], places=False, status=WORSE)
        self.assertIn("1.333 SLOWER", output)

    def test_what_goes_wrong(self):
        times = [{"host": 1.0}]
        self.assertIn("back ends", self.compare(times, times, backend="cpu", status=FAILED))
        self.assertIn("no CUDA", self.compare(times, times, new_plan={"fails": "no CUDA"}, status=FAILED))
        for flag, value in (("--rounds", "0"), ("--rounds", "x"), ("--tolerance", "-1"), ("--tolerance", "nan")):
            self.compare(times, times, flag, value, status=FAILED)
        self.assertIn("nowhere", self.run_script("compare-builds", "nowhere", "nowhere", "a.pdb", status=FAILED))

    def test_a_build_with_itself(self):
        output = self.run_script("compare-builds", PROGRAM, PROGRAM, CRAMBIN, "--rounds", "1", "--tolerance", "100000", "--",
                                 "--repeat", "1", "--backend", "cpu")
        self.assertRegex(output, r"1CRN +host ")


class CountInstructions(ScriptsTest):
    FUNCTIONS = {"quickses::v3::work(int)": 1000000, "quickses::(anonymous namespace)::Rest::operator()(long) const": 100000}

    def count(self, *arguments, functions=None, start=5000, kind="AVX2", compiler="GCC: (Debian 12.2.0-14) 12.2.0",
              status=OK, **plan):
        self.write_program("bin/valgrind", STAND_IN_VALGRIND, functions=functions or self.FUNCTIONS, start=start, set=kind,
                           **plan)
        program = self.write("build/quickses", f"\0{compiler}\0")
        path = os.pathsep.join([self.path("bin"), os.environ["PATH"]])
        return self.run_script("count-instructions", program, *arguments, status=status, env={**os.environ, "PATH": path})

    def accepted(self, **keywords):
        reference = self.path("reference.json")
        self.count("--accept", "--reference", reference, **keywords)
        return ["--reference", reference]

    def test_what_is_accepted(self):
        with open(self.accepted()[1], encoding="utf-8") as file:
            reference = json.load(file)
        self.assertEqual((reference["compiler"], reference["instruction_set"]), ("GCC 12.2.0", "AVX2"))
        for case in reference["cases"].values():  # one surface, without the start, and no call counted twice
            self.assertEqual(case, {"total": 1100000, "functions": {"v3::work": 1000000, "Rest::operator": 100000}})

    def test_growth_is_found(self):
        reference = self.accepted()
        self.assertNotIn("grew", self.count(*reference))
        self.count(*reference, start=10 ** 9)
        for work, status in ((1020000, OK), (1050000, WORSE), (900000, OK)):
            functions = {**self.FUNCTIONS, "quickses::v3::work(int)": work}
            output = self.count(*reference, functions=functions, status=status)
            self.assertEqual("+0.05 M  v3::work" in output, status == WORSE, output)
            self.assertEqual("--accept" in output, work != 1020000, output)
        output = self.count(*reference, functions={**self.FUNCTIONS, "quickses::added(int)": 200000}, status=WORSE)
        self.assertIn("+0.20 M  added", output)

    def test_others_are_not_judged(self):
        reference = self.accepted()
        twice = {name: 2 * count for name, count in self.FUNCTIONS.items()}
        for other in ({"compiler": "GCC: (Debian 14.2.0-1) 14.2.0"}, {"compiler": "clang version 19.1.7"}, {"compiler": "none"},
                      {"kind": "SSE2"}):
            with self.subTest(other):
                output = self.count(*reference, functions=twice, status=NOT_JUDGED, **other)
                self.assertIn("nothing is judged", output)
                self.assertIn("+100.00 %", output)

    def test_there_is_no_valgrind(self):
        program = self.write("build/quickses", "")
        self.write("empty/nothing", "")
        output = self.run_script("count-instructions", program, status=NOT_JUDGED, env={**os.environ, "PATH": self.path("empty")})
        self.assertIn("nothing is judged", output)
        self.assertIn("valgrind", output)

    def test_what_goes_wrong(self):
        self.assertIn("Illegal", self.count(fails="Illegal instruction", status=FAILED))
        self.run_script("count-instructions", self.path("nowhere"), status=FAILED)
        self.write("reference.json", '{"compiler": "GCC 12.2.0", "instruction_set": "AVX2", "cases": {}}')
        self.assertIn("--accept", self.count("--reference", self.path("reference.json"), status=FAILED))

    def test_the_reference_has_all_cases(self):
        with open(os.path.join(SCRIPTS, "instructions.json"), encoding="utf-8") as file:
            reference = json.load(file)
        output = self.count(functions={"quickses::f()": 10}, kind=reference["instruction_set"],
                            compiler="GCC: (a system's) " + reference["compiler"].split()[-1])
        self.assertEqual(output.count("-100.00 %"), len(reference["cases"]))


if __name__ == "__main__":
    repository = os.path.abspath(sys.argv.pop(1))
    SCRIPTS = os.path.join(repository, "Scripts~", "measure")
    CRAMBIN = os.path.join(repository, "Tests", "Data~", "1CRN.pdb")
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
