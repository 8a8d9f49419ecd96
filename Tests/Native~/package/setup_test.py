# SPDX-License-Identifier: MIT
"""Scripts~/setup.sh with programs that stand in for apt's, which speak German unless LC_ALL is C, as apt does.

    setup_test.py REPOSITORY
"""

import os
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = ""

APT_CACHE = """#!/bin/sh
if [ "$LC_ALL" = C ]; then word=Candidate; else word=Installationskandidat; fi
echo "$2:"
case "$2" in
  @MISSING@) printf '  Installed: (none)\\n  %s: (none)\\n' "$word" ;;
  *) printf '  Installed: (none)\\n  %s: 1.0\\n' "$word" ;;
esac
"""
APT_GET = """#!/bin/sh
echo "$@" >>"$APT_LOG"
"""


class SetupTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.programs, self.log = os.path.join(folder.name, "programs"), os.path.join(folder.name, "log")
        os.mkdir(self.programs)
        # No pigz and no ccache, whatever is here.
        for name in ("bash", "cat", "cut", "env", "grep", "id", "python3", "sed", "sh"):
            os.symlink(shutil.which(name), os.path.join(self.programs, name))
        self.write_program("sudo", '#!/bin/sh\nexec "$@"\n')
        self.write_program("apt-get", APT_GET)
        self.write_program("apt-cache", APT_CACHE)

    def write_program(self, name, text):
        path = os.path.join(self.programs, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(path, stat.S_IRWXU)

    def run_script(self, **environment):
        """(exit status, all that it printed, the packages that it has installed)"""
        open(self.log, "w", encoding="utf-8").close()
        done = subprocess.run(["bash", os.path.join(REPOSITORY, "Scripts~/setup.sh")], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False,
                              env={**os.environ, "PATH": self.programs, "APT_LOG": self.log, **environment})
        with open(self.log, encoding="utf-8") as file:
            installed = [line.split("--no-install-recommends")[1].split() for line in file if " install " in line]
        return done.returncode, done.stdout, sum(installed, [])

    def test_installs_what_is_missing_whatever_the_language(self):
        for language in ("C.UTF-8", "de_DE.UTF-8"):
            with self.subTest(language):
                status, text, installed = self.run_script(LC_ALL=language, LANGUAGE="de")
                self.assertEqual(status, 0, text)
                self.assertIn("pigz", installed)  # is needed
                self.assertIn("ccache", installed)  # is optional

    def test_what_the_system_does_not_offer(self):
        self.write_program("apt-cache", APT_CACHE.replace("@MISSING@", "ccache"))
        status, text, installed = self.run_script()
        self.assertEqual(status, 0, text)
        self.assertNotIn("ccache", installed)
        self.write_program("apt-cache", APT_CACHE.replace("@MISSING@", "pigz"))
        status, text, installed = self.run_script()
        self.assertEqual((status, installed), (1, []), text)
        self.assertIn("offers no package pigz", text)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    REPOSITORY = os.path.abspath(sys.argv.pop(1))
    unittest.main()
