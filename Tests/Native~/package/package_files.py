# SPDX-License-Identifier: MIT
"""For tests of the scripts that look at the package's files: a folder with given files, and what a script says of it."""

import os
import subprocess
import sys
import tempfile
import unittest


class ScriptTest(unittest.TestCase):
    script = ""  # its path

    def run_on(self, files):
        """(exit status, what it printed) of a folder with {path: text}."""
        with tempfile.TemporaryDirectory() as root:
            for path, text in files.items():
                full = os.path.join(root, path)
                os.makedirs(os.path.dirname(full), exist_ok=True)
                with open(full, "w", encoding="utf-8", newline="") as file:
                    file.write(text)
            done = subprocess.run([sys.executable, "-B", self.script, root], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def assert_fault(self, files, sentence, count=1):
        """There is this fault; count: of all of them."""
        status, text = self.run_on(files)
        self.assertEqual(status, 1, text)
        self.assertIn(sentence, text)
        self.assertIn(f", {count} faults\n", text)


def main(test):
    """Runs a test's module; the script's path is the first argument."""
    test.script = os.path.abspath(sys.argv.pop(1))
    unittest.main()
