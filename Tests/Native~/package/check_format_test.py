# SPDX-License-Identifier: MIT
"""Scripts~/check-format with programs that stand in for clang-format: they write "a = b" for "a=b".

    check_format_test.py PATH_OF_CHECK_FORMAT
"""

import os
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest

CHECK_FORMAT = ""

STAND_IN = """#!/bin/sh
for file in "$@"; do :; done
case "$*" in
  --version) echo "Debian clang-format version @VERSION@" ;;
  *" -i "*) sed -i 's/a=b/a = b/' "$file" ;;
  *) sed 's/a=b/a = b/' "$file" ;;
esac
"""


class CheckFormatTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = os.path.join(folder.name, "sources")
        self.programs = os.path.join(folder.name, "programs")
        os.mkdir(self.programs)
        for name in ("bash", "cmp", "dirname", "find", "sed", "sh", "sort"):
            os.symlink(shutil.which(name), os.path.join(self.programs, name))
        self.write(".clang-format", "")
        for name in ("right.cpp", "wide name/right.h"):
            self.write(name, "a = b;")
        for name in ("notes.txt", ".build/wrong.cpp"):
            self.write(name, "a=b;")

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def add_formatter(self, name, version):
        path = os.path.join(self.programs, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(STAND_IN.replace("@VERSION@", version))
        os.chmod(path, stat.S_IRWXU)

    def run_script(self, *options):
        done = subprocess.run(["bash", CHECK_FORMAT, *options, self.folder], env={"PATH": self.programs}, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        return done.returncode, done.stdout.splitlines()

    def test_right_files(self):
        self.add_formatter("clang-format-14", "14.0.6")
        status, lines = self.run_script()
        self.assertEqual((status, len(lines)), (0, 1), lines)

    def test_wrong_files_are_named_then_fixed(self):
        self.add_formatter("clang-format-14", "14.0.6")
        self.add_formatter("clang-format", "19.1.7")
        wrong = ["a.c", "b.cu", "c.cuh", "wide name/wrong.h"]
        for name in wrong:
            self.write(name, "a=b;")
        for options, expected in (((), 1), (("--fix",), 0)):
            status, lines = self.run_script(*options)
            self.assertEqual((status, lines[:-1]), (expected, wrong))
        self.assertEqual(self.run_script()[0], 0)
        with open(os.path.join(self.folder, "notes.txt"), encoding="utf-8") as file:
            self.assertEqual(file.read(), "a=b;")

    def test_another_version_tells_but_does_not_judge(self):
        self.add_formatter("clang-format", "19.1.7")
        self.write("wrong.cpp", "a=b;")
        status, lines = self.run_script()
        self.assertEqual((status, lines[0]), (77, "wrong.cpp"))
        self.assertEqual(self.run_script("--fix")[0], 2)

    def test_no_formatter(self):
        self.write("wrong.cpp", "a=b;")
        self.assertEqual(self.run_script()[0], 77)

    def test_wrong_use(self):
        self.add_formatter("clang-format-14", "14.0.6")
        self.assertEqual(self.run_script("--what")[0], 2)
        os.remove(os.path.join(self.folder, ".clang-format"))
        self.assertEqual(self.run_script()[0], 2)


if __name__ == "__main__":
    CHECK_FORMAT = os.path.abspath(sys.argv.pop(1))
    unittest.main()
