# SPDX-License-Identifier: MIT
"""Tests of the quickses program where outputs are streams: standard output, and other descriptors that have names.

usage: cli_streams_test.py PROGRAM [unittest options]      (or QUICKSES_PROGRAM in the environment)
"""
import json
import os
import subprocess
import unittest

try:
    import resource
except ImportError:  # on Windows
    resource = None

import cli_test
from cli_files_test import FilesTest
from cli_test import COMPUTE, IS_WINDOWS, OK, OUTPUT, SOME_FAILED, USAGE, is_closed, read_obj


@unittest.skipIf(IS_WINDOWS, "no such devices")
class StandardOutput(FilesTest):
    PRINTING = (["--version"], ["--help"], ["bench", "--help"], ["p.pdb"], ["p.pdb", "--json", "-"],
                ["bench", "p.pdb", "--repeat", "1"], ["p.pdb", "--trajectory", "many.pdb"],
                ["p.pdb", "--trajectory", "many.pdb", "--csv", "-"])

    def assert_can_not_print(self, arguments, **keywords):
        result = subprocess.run([cli_test.PROGRAM, *arguments], stderr=subprocess.PIPE, cwd=self.folder, **keywords)
        self.assertEqual(result.returncode, OUTPUT, result.stderr)
        self.assertIn(b"standard output can't be written", result.stderr)

    @unittest.skipUnless(os.path.exists("/dev/full"), "there is no device that is always full")
    def test_other_names_that_begin_like_it_are_files(self):
        names = ["-.csv", "-.csv.gz", "-.json"]
        flags = ["--per-atom", "--per-residue", "--json"]
        arguments = [word for flag, name in zip(flags, names) for word in (flag + "=" + name,)]
        result = self.run_cpu("measure", "p.pdb", "--surface", "sas", *arguments)
        self.assertEqual(len(result.stdout.splitlines()), 3, result.stdout)  # the summary
        for name in names:
            self.assertTrue((self.folder / name).is_file(), name)

    def test_it_is_full(self):
        for arguments in self.PRINTING:
            with self.subTest(arguments=arguments), open("/dev/full", "w") as full:
                self.assert_can_not_print(arguments, stdout=full)
        (self.folder / "full.obj").symlink_to("/dev/full")
        self.assert_fails(OUTPUT, ["full.obj", "space"], "p.pdb", "-o", "full.obj", "--quiet")

    def test_it_is_closed(self):
        for arguments in self.PRINTING:
            with self.subTest(arguments=arguments):
                self.assert_can_not_print(arguments, preexec_fn=lambda: os.close(1))
        # No file takes its place.
        self.assert_can_not_print(["p.pdb", "-v", "2", "-o", "a.obj"], preexec_fn=lambda: os.close(1))
        self.assertTrue(is_closed(read_obj(self.folder / "a.obj")[2]))
        measure = ["measure", *["p.pdb"] * 40, "--surface", "vdw", "--per-atom"]  # more lines than are kept back
        self.run_cpu(*measure, "expected.csv")
        self.assert_can_not_print([*measure, "b.csv"], preexec_fn=lambda: os.close(1))
        self.assertEqual((self.folder / "b.csv").read_text(), (self.folder / "expected.csv").read_text())

    def test_nobody_reads_it(self):
        for arguments in self.PRINTING:
            reader, writer = os.pipe()
            os.close(reader)
            with self.subTest(arguments=arguments):
                self.assert_can_not_print(arguments, stdout=writer)
            os.close(writer)
        self.assertEqual(sorted(self.content()), ["many.pdb", "p.pdb", "radii.txt"])


@unittest.skipIf(IS_WINDOWS, "no such limits")
class SmallFiles(FilesTest):
    def test_a_file_that_may_not_be_as_large(self):
        """The system would end the program by a signal, which is not the way in which it fails."""
        before = self.content()

        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
        for arguments in (["-v", "2", "-o", "a.obj"], ["--per-atom", "a.csv"], ["-o", "a.png"]):
            result = subprocess.run([cli_test.PROGRAM, "p.pdb", "--quiet", "--backend", "cpu", *arguments], cwd=self.folder,
                                    capture_output=True, encoding="utf-8", timeout=cli_test.PATIENCE, preexec_fn=limit)
            self.assertEqual(result.returncode, OUTPUT, result.stderr)
            self.assertIn(arguments[-1], result.stderr)
            self.assertEqual(self.content(), before)


@unittest.skipIf(IS_WINDOWS, "no such limits")
class StarvedMemory(FilesTest):
    """Address space may end anywhere, also where no exception may pass."""
    START, STEP = 64, 200  # kB

    def run_within(self, kilobytes, *arguments):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (kilobytes << 10, kilobytes << 10))
        return subprocess.run([cli_test.PROGRAM, *arguments], cwd=self.folder, capture_output=True, encoding="utf-8",
                              timeout=cli_test.PATIENCE, preexec_fn=limit)

    def least_to_start(self):
        low, high = 0, 1 << 18
        if self.run_within(high, "--version").returncode != OK:
            self.skipTest("the program is of a build that takes much more, as with a sanitizer")
        while high - low > self.START:
            middle = (low + high) // 2
            low, high = (low, middle) if self.run_within(middle, "--version").returncode == OK else (middle, high)
        return high

    def test_it_ends_with_a_message_and_leaves_nothing_behind(self):
        before = set(self.content())
        least = self.least_to_start()
        codes = set()
        for k in range(40):
            limit = least + k * self.STEP
            result = self.run_within(limit, "p.pdb", "--trajectory", "many.pdb", "--json", "a.json", "-o", "f_%02d.obj",
                                     "--threads", "2", "--backend", "cpu", "-v", "1", "--quiet")
            with self.subTest(kilobytes=limit, stderr=result.stderr):
                self.assertIn(result.returncode, (OK, COMPUTE, SOME_FAILED))
                codes.add(result.returncode)
                if result.returncode != OK:
                    self.assertIn("memory", result.stderr)
                for name in set(self.content()) - before:
                    self.assertIn(name, ("a.json", "f_00.obj", "f_01.obj", "f_02.obj"))
                    if name != "a.json":
                        self.assertTrue(is_closed(read_obj(self.folder / name)[2]), name)
                    (self.folder / name).unlink()
        self.assertIn(COMPUTE, codes)


@unittest.skipIf(IS_WINDOWS, "descriptors have no names there")
class Descriptors(FilesTest):
    """What a shell leads /dev/stdout, /dev/stderr and /dev/fd/N to is written on, not replaced."""
    TABLE = ["p.pdb", "--per-atom", "/dev/stdout", "--quiet"]

    def setUp(self):
        super().setUp()
        self.run_cpu("p.pdb", "--per-atom", "t.csv", "--quiet")
        self.table = (self.folder / "t.csv").read_text()

    def shell(self, script):
        result = subprocess.run(["sh", "-c", script, "sh", cli_test.PROGRAM, "--backend", "cpu"], cwd=self.folder, capture_output=True,
                                encoding="utf-8", timeout=cli_test.PATIENCE)
        self.assertEqual(result.stderr, "")
        return result.stdout

    def test_what_is_before_and_behind_stays(self):
        (self.folder / "link").symlink_to("/dev/stdout")
        for name in ("/dev/stdout", "/dev/fd/1", "/proc/self/fd/1", "link"):
            for begin in (">", ">>"):
                with self.subTest(name=name, begin=begin):
                    self.write("out.txt", "old\n")
                    self.shell(f'{{ echo header; "$@" p.pdb --per-atom {name} --quiet; echo footer; }} {begin} out.txt')
                    expected = f"header\n{self.table}footer\n"
                    self.assertEqual((self.folder / "out.txt").read_text(), ("old\n" if begin == ">>" else "") + expected)

    def test_other_descriptors(self):
        for number in (2, 3):
            self.shell(f'{{ echo header >&{number}; "$@" p.pdb --per-atom /dev/fd/{number}; "$@" nowhere.pdb 2>&{number}; }} '
                       f'{number}> out.txt')
            text = (self.folder / "out.txt").read_text()
            self.assertTrue(text.startswith(f"header\n{self.table}"))
            self.assertIn("nowhere.pdb", text)
        self.assert_fails(OUTPUT, ["/dev/fd/77"], "p.pdb", "--per-atom", "/dev/fd/77")

    def test_meshes(self):
        self.run_cpu("p.pdb", "-v", "2", "-o", "a.ply")
        (self.folder / "out.ply").symlink_to("/dev/stdout")
        self.shell('{ echo header; "$@" p.pdb -v 2 -o out.ply; } > out.txt')
        self.assertEqual((self.folder / "out.txt").read_bytes(), b"header\n" + (self.folder / "a.ply").read_bytes())
        self.assertTrue((self.folder / "out.ply").is_symlink())

    def test_nothing_else_is_printed_there(self):
        json.loads(self.shell('"$@" p.pdb --json /dev/stdout | cat'))
        self.assertEqual(self.shell('"$@" p.pdb --per-atom /dev/stdout | cat'), self.table)
        self.assert_fails(USAGE, ["--per-atom", "--json", "standard output"], "p.pdb", "--per-atom", "-", "--json",
                          "/dev/stdout")


if __name__ == "__main__":
    cli_test.PROGRAM = cli_test.program_to_test(cli_test.PROGRAM, __doc__)
    unittest.main()
