# SPDX-License-Identifier: MIT
"""What the program says: help, hints, suggestions, the manual page and the completion.   cli_words_test.py PROGRAM"""
import os
import re
import shutil
import subprocess
import unittest

import cli_test
from cli_test import COMPUTE, CRAMBIN, INPUT, USAGE, ProgramTest, program_to_test
from trajectory_files import chain_of, dcd_bytes, pdb_text

COMMANDS = ("", "measure", "cavities", "bench")


def water(number):
    return "HETATM    1  O   HOH A%4d    %8.3f   0.000   0.000  1.00  0.00           O\n" % (number, 3 * number)


class Suggestions(ProgramTest):
    def assert_suggests(self, suggestion, *arguments):
        self.assert_fails(USAGE, [f"did you mean {suggestion}?"], *arguments)
        line = self.run_program(*arguments, code=USAGE).stderr.strip()
        self.assertTrue(line.endswith(f"did you mean {suggestion}?"), line)

    def test_one_dash(self):
        for flag, value in (("spacing", "0.3"), ("steps", "2"), ("select", "all"), ("output", "a.obj"), ("outer", ""),
                            ("surface", "sas"), ("input", "a.pdb")):
            with self.subTest(flag=flag):
                self.assert_suggests("--" + flag, CRAMBIN, "-" + flag, *([value] if value else []))
        self.assert_suggests("--spacing", CRAMBIN, "-spacing=0.3")
        self.assert_suggests("--spacing", CRAMBIN, "-spacng", "0.3")

    def test_letters_with_values_still_work(self):
        self.run_cpu(CRAMBIN, "-v2", "-l0", "-s64")

    def test_unknown_flags(self):
        self.assert_suggests("--spacing", CRAMBIN, "--spcing", "1")
        self.assert_suggests("--per-residue", "measure", CRAMBIN, "--per-residu", "a.csv")
        self.assert_suggests("--repeat", "bench", CRAMBIN, "--repaet=3")
        self.assert_fails(USAGE, ["--repeat", "no such flag", "quickses measure --help"], "measure", CRAMBIN, "--repeat", "3")
        self.assert_fails(USAGE, ["--xyzzy", "no such flag", "quickses --help"], CRAMBIN, "--xyzzy")

    def test_flags_without_a_value_and_given_twice(self):
        self.assert_fails(USAGE, ["--spacing: its value is missing: --spacing A"], CRAMBIN, "-v")
        self.assert_fails(USAGE, ["--json: its value is missing: --json FILE|-"], "measure", CRAMBIN, "--json")
        self.assert_fails(USAGE, ["--spacing: it is given 3 times"], CRAMBIN, "-v", "1", "--spacing", "2", "-v3")
        self.assert_fails(USAGE, ["--output: it is given 2 times"], CRAMBIN, "-o", "a.ply", "-o", "b.ply")

    def test_flags_that_take_no_value(self):
        for flag, value in (("quiet", "3"), ("quiet", "false"), ("no-water", "no"), ("no-hetero", "xyz"), ("outer", "0"),
                            ("version", "2"), ("help", "all")):
            self.assert_fails(USAGE, [f"--{flag}: '{value}' is given, and it takes no value"], CRAMBIN, f"--{flag}={value}")
        self.assert_fails(USAGE, ["--quiet: 'no' is given"], "measure", CRAMBIN, "--quiet=no")
        self.assert_fails(USAGE, ["--measure: 'off' is given"], "bench", CRAMBIN, "--measure=off")
        self.assertEqual(self.run_cpu(CRAMBIN, "-v", "3", "--quiet", "--quiet").stdout, "")

    def test_an_output_without_its_flag(self):
        for name in ("out.ply", "out.obj", "out.stl"):
            self.assert_suggests("-o " + name, CRAMBIN, name)

    def test_commands(self):
        self.assert_suggests("measure", "mesure", CRAMBIN)
        self.assert_suggests("cavities", "cavites", CRAMBIN)
        for before in (["--quiet"], ["-v", "1", "--quiet"], [CRAMBIN]):
            self.assert_fails(USAGE, ["measure: its options go behind the word"], *before, "measure", CRAMBIN)

    def test_selections(self):
        self.assert_fails(USAGE, ["'protien' at character 1 ", "did you mean 'protein'?"], CRAMBIN, "--select", "protien")
        self.assert_fails(INPUT, ["'water' names none", "chain A", "protein"], CRAMBIN, "--select", "water")

    def test_selections_of_several_lines(self):
        expected = self.run_cpu(CRAMBIN, "-v", "2", "--select", "chain A and resid 1-20").stdout.split(", cpu")[0]
        for text in ("chain A and\nresid\n1-20", "\n\tchain A\r\n and resid 1-20\n", "chain\tA and resid\v1-20\f\n",
                     "//A/1-20\n"):
            self.assertEqual(self.run_cpu(CRAMBIN, "-v", "2", "--select", text).stdout.split(", cpu")[0], expected, text)

    def test_long_selections(self):
        many = " or ".join(f"resid {k}" for k in range(1, 2000))
        self.run_cpu(CRAMBIN, "-v", "3", "--select", many)
        for selection, reason in ((many + " or", "something is missing at its end"),
                                  ("protein and chain " + 3000 * "Ä", "names none"),
                                  ("protein and " + 3000 * "x", "is no word of selections; is it a name"),
                                  ("within " + 3000 * "9x" + " of ligand", "'within' wants a distance"),
                                  ("resid " + 3000 * "x", "is no residue number"), ("/" + 3000 * "/", "can't be understood"),
                                  ("name " + 3000 * "C" + "*", "selections know no wildcards")):
            result = self.run_program(CRAMBIN, "--select", selection, code=None)
            self.assertIn(result.returncode, (USAGE, INPUT))
            self.assertIn(reason, result.stderr)
            self.assertLess(len(result.stderr), 1200)
        for flag, reason in (("--altloc", "neither 'first'"), ("--assembly", "there is 1")):
            self.assert_fails(USAGE, [reason], CRAMBIN, flag, 3000 * "ä")
            self.assertLess(len(self.run_program(CRAMBIN, flag, 3000 * "ä", code=USAGE).stderr), 600)

    def test_assemblies(self):
        self.assert_fails(USAGE, ["assembly '7'", "there is 1"], CRAMBIN, "--assembly", "7")
        self.assert_fails(USAGE, ["--assembly", "--trajectory"], CRAMBIN, "--assembly", "1", "--trajectory", "a.xtc")


class Hints(ProgramTest):
    def hint_of(self, name, *arguments):
        return self.run_cpu(name, "-v", "1", *arguments).stderr

    def test_water(self):
        self.write("wet.pdb", CRAMBIN.read_text().replace("END   ", "") + water(1) + water(2))
        hint = "quickses: 2 water molecules are part of the surface; --no-water leaves them out\n"
        self.assertEqual(self.hint_of("wet.pdb"), hint)
        self.assertEqual(self.run_cpu("measure", "wet.pdb").stderr, hint)
        for flags in (["--no-water"], ["--no-hetero"], ["--quiet"], ["--select", "all"], ["--select", "water"]):
            self.assertEqual(self.hint_of("wet.pdb", *flags), "", flags)
        self.write("one.pdb", water(1))
        self.assertEqual(self.hint_of("one.pdb"),
                         "quickses: 1 water molecule is part of the surface; --no-water leaves it out\n")
        hydrogens = [water(1).replace("  O   HOH", f"  H{k}  HOH").replace("           O", "           H") for k in (1, 2)]
        self.write("whole.pdb", water(1) + "".join(hydrogens) + water(2))  # molecules are counted, not atoms
        self.assertEqual(self.hint_of("whole.pdb"), hint)
        self.assertEqual(self.hint_of(CRAMBIN), "")

    def test_models(self):
        atoms, positions = chain_of(2)
        text = pdb_text(atoms, positions)
        marked = "".join(f"MODEL     {k:4d}\n{text}ENDMDL\n" for k in (1, 2, 3))
        self.write("m.pdb", marked)
        self.write("end.pdb", (text + "END\n") * 2)
        hint = "quickses: 'm.pdb': model 1 of 3 is used; --model N chooses another\n"
        self.assertEqual(self.hint_of("m.pdb"), hint)
        self.assertEqual(self.run_cpu("measure", "m.pdb").stderr, hint)
        self.assertEqual(self.hint_of("end.pdb"),
                         "quickses: 'end.pdb': model 1 of 2 is used (END and ENDMDL end a model); "
                         "--model N chooses another\n")
        for flags in (["--model", "1"], ["--model", "all"], ["--quiet"], ["--trajectory", "m.pdb"]):
            self.assertEqual(self.hint_of("m.pdb", *flags), "", flags)

    def test_one_is_singular(self):
        atoms, positions = chain_of(2)
        self.write("one.pdb", pdb_text(atoms[:1], positions[:1]))
        self.write("two.pdb", pdb_text(atoms, positions))
        self.write("t.dcd", dcd_bytes([positions[:1]]))
        frames = ("one.pdb", "--trajectory", "t.dcd", "-v", "1")
        self.assertRegex(self.run_cpu(*frames, "--csv", "a.csv").stdout, "^1 frame of 1 atom, ")
        self.assertRegex(self.run_cpu("one.pdb", "-v", "1").stdout, "^1 atom, ")
        self.assertRegex(self.run_cpu("two.pdb", "-v", "1").stdout, "^2 atoms, ")
        self.assertRegex(self.run_cpu("measure", "one.pdb").stdout, "^one.pdb: 1 atom, ")
        self.assertRegex(self.run_cpu("bench", "one.pdb", "-v", "1", "--repeat", "1").stdout, "^one.pdb: 1 atom, ")
        self.assert_fails(INPUT, ["'one.pdb' has 1 atom, but 'two.dcd' has 2:"], "one.pdb", "--trajectory",
                          self.write("two.dcd", dcd_bytes([positions])).name, "--csv", "a.csv", "--backend", "cpu")
        self.assertRegex(self.run_cpu(*frames, "--memory", "1K", "--csv", "b.csv", code=6).stderr, "1 of 1 frame failed\n$")
        self.assert_fails(INPUT, ["'one.pdb' has more than 1 byte,"], "one.pdb", "--max-input", "1")
        for size, words in (("1", "1 byte"), ("1023", "1023 bytes"), ("1K", "1.0 KiB")):
            self.assert_fails(COMPUTE, [f"the memory budget of {words} does not suffice"], "one.pdb", "--memory", size)

    def test_cuda_is_not_spoken_of_where_it_was_not_built(self):
        refused = subprocess.run([cli_test.PROGRAM, CRAMBIN, "--backend", "cuda"], capture_output=True, encoding="utf-8",
                                 env=dict(os.environ, CUDA_VISIBLE_DEVICES=""))
        if "no CUDA back end" not in refused.stderr:
            self.skipTest("this build has CUDA")
        self.assertEqual(self.run_program(CRAMBIN, "-v", "1").stderr, "")


class Help(ProgramTest):
    def help_of(self, command):
        return self.run_program(*command.split(), "--help").stdout

    def test_fits_a_terminal(self):
        for command in COMMANDS:
            for line in self.help_of(command).splitlines():
                self.assertLessEqual(len(line), 100, line)

    def test_is_grouped(self):
        text = self.help_of("")
        places = [text.index(f"\n{group}:\n") for group in ("Input", "Output", "Surface", "Trajectory", "Computing", "Report")]
        self.assertEqual(places, sorted(places))
        self.assertLess(text.index("--spacing A"), text.index("--method "))
        for command in COMMANDS:
            self.assertNotIn("\nOptions:\n", self.help_of(command), "a flag is in no group")

    def test_water_is_not_ions(self):
        self.assertRegex(self.help_of(""), r"--no-water +Leave out water; ions and ligands stay")


def flags_of(text):
    return set(re.findall(r"^  (?:-\w, )?(--[\w-]+)", text, re.MULTILINE))


class ManualPage(ProgramTest):
    def test_has_all_flags(self):
        page = self.run_program("--help-man").stdout
        bold = set(re.findall(r"--[\w-]+", page.replace("\\-", "-")))
        for command in COMMANDS:
            flags = flags_of(self.run_program(*command.split(), "--help").stdout)
            self.assertGreater(len(flags), 10)
            self.assertLessEqual(flags, bold)
            self.assertIn("COMMAND " + command if command else "SYNOPSIS", page)
        self.assertTrue(page.isascii())

    @unittest.skipUnless(shutil.which("man"), "there is no man")
    def test_man_has_no_complaints(self):
        page = self.write("quickses.1", self.run_program("--help-man").stdout)
        result = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", page], capture_output=True, encoding="utf-8",
                                env=dict(os.environ, LC_ALL="C.UTF-8", MANWIDTH="80", MAN_KEEP_FORMATTING=""))
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        for part in ("--spacing", "EXIT", "measure", "Computing"):
            self.assertIn(part, result.stdout) if part != "EXIT" else self.assertIn("Exit codes", result.stdout)


@unittest.skipUnless(shutil.which("bash"), "there is no bash")
class Completion(ProgramTest):
    def complete(self, *words):
        self.write("quickses.bash", self.run_program("--help-completion").stdout)
        self.write("file.pdb", "")
        script = "source ./quickses.bash; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _quickses; printf '%s\\n' \"${COMPREPLY[@]}\""
        result = subprocess.run(["bash", "--norc", "-u", "-c", script, "bash", "quickses", *words], cwd=self.folder,
                                capture_output=True, encoding="utf-8")
        self.assertEqual(result.stderr, "")
        return sorted(result.stdout.split())

    def test_flags(self):
        self.assertEqual(self.complete("a.pdb", "--sp"), ["--spacing"])
        self.assertEqual(self.complete("a.pdb", "--per"), ["--per-atom", "--per-residue"])
        self.assertEqual(self.complete("bench", "--rep"), ["--repeat"])
        self.assertEqual(self.complete("a.pdb", "--rep"), [])
        for command in COMMANDS:
            flags = flags_of(self.run_program(*command.split(), "--help").stdout)
            self.assertLessEqual(flags, set(self.complete(*(command.split() or ["a.pdb"]), "--")))

    def test_values(self):
        self.assertEqual(self.complete("a.pdb", "--backend", ""), ["auto", "cpu", "cuda"])
        self.assertEqual(self.complete("a.pdb", "--backend", "cu"), ["cuda"])
        self.assertEqual(self.complete("a.pdb", "--backend", "=", "cu"), ["cuda"])
        self.assertEqual(self.complete("a.pdb", "--backend", "="), ["auto", "cpu", "cuda"])
        self.assertEqual(self.complete("a.pdb", "--surface", "s"), ["sas", "ses"])
        self.assertEqual(self.complete("a.pdb", "--creases", ""), ["off", "on"])
        self.assertEqual(self.complete("a.pdb", "--altloc", "h"), ["highest"])
        self.assertEqual(self.complete("bench", "--layout", "c"), ["compact"])
        self.assertEqual(self.complete("a.pdb", "--radii", "b"), ["bondi"])
        self.assertEqual(self.complete("a.pdb", "--radii", "f"), ["file.pdb"])
        self.assertEqual(self.complete("a.pdb", "--spacing", "-"), [])  # a number: nothing is known
        self.assertEqual(self.complete("a.pdb", "--json", "f"), [])  # bash completes files itself

    def test_commands(self):
        self.assertEqual(self.complete("me"), ["measure"])
        self.assertEqual(self.complete("f"), ["file.pdb"])


if __name__ == "__main__":
    cli_test.PROGRAM = program_to_test("", __doc__)
    unittest.main()
