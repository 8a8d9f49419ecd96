# SPDX-License-Identifier: MIT
"""--help of the scripts prints the comment they begin with, all of it, and does nothing.   script_help_test.py PROJECT"""

import pathlib
import subprocess
import sys
import unittest

SCRIPTS = ("setup.sh", "demo.sh", "test.sh", "package.sh", "pictures.sh", "check-format")
PROJECT = pathlib.Path()


def head_of(script):
    """The lines of the comment, without the first two: which program runs it, and the licence."""
    lines = script.read_text(encoding="utf-8").splitlines()[2:]
    end = next(k for k, line in enumerate(lines) if not line.startswith("#"))
    return [line[2:] for line in lines[:end]]


class ScriptHelpTest(unittest.TestCase):
    def run_script(self, name, *options):
        return subprocess.run(["bash", PROJECT / "Scripts~" / name, *options], stdin=subprocess.DEVNULL, capture_output=True,
                              encoding="utf-8", check=False)

    def test_help(self):
        for name in SCRIPTS:
            for option in ("--help", "-h"):
                with self.subTest(script=name, option=option):
                    done = self.run_script(name, option)
                    self.assertEqual((done.returncode, done.stderr), (0, ""))
                    self.assertEqual(done.stdout.splitlines(), head_of(PROJECT / "Scripts~" / name))

    def test_unknown_option(self):
        for name in SCRIPTS:
            with self.subTest(script=name):
                done = self.run_script(name, "--no-such-option")
                self.assertEqual((done.returncode, done.stdout), (2, ""))
                self.assertNotEqual(done.stderr, "")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    PROJECT = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
