# SPDX-License-Identifier: MIT
"""The files of the repository that its pages name are there, and so is the git URL.   page_paths_test.py REPOSITORY

A name in backquotes is that of a file if it ends like a source: `arc.h`, `io/trajectory.h`, `Scripts~/setup.sh`. It may leave out
folders in front. Names of users' files (1crn.pdb.txt) don't end so; unitymol.md names files of UnityMol.
"""

import glob
import json
import os
import re
import sys
import unittest

REPOSITORY = ""
NAME = re.compile(r"`([\w~./-]+\.(?:h|hpp|c|cpp|cu|cuh|cs|py|sh|cmake|asmdef|shader))`")


def paths_of(root):
    """Paths of all files below root as "/…/name", but those in folders that begin with a dot or hold build results."""
    paths = set()
    for folder, subfolders, files in os.walk(root):
        subfolders[:] = [name for name in subfolders if not name.startswith(".") and name not in ("bin", "obj")]
        paths |= {"/" + os.path.relpath(os.path.join(folder, name), root).replace(os.sep, "/") for name in files}
    return paths


def missing_names(text, paths):
    return sorted(name for name in set(NAME.findall(text)) if not any(path.endswith("/" + name) for path in paths))


class PagePathsTest(unittest.TestCase):
    def test_files_that_pages_name(self):
        paths = paths_of(REPOSITORY)
        pages = glob.glob(os.path.join(REPOSITORY, "*.md")) + glob.glob(os.path.join(REPOSITORY, "Documentation~", "*.md"))
        pages = [page for page in pages if os.path.basename(page) != "unitymol.md"]
        self.assertGreater(len(pages), 10)
        for page in pages:
            with self.subTest(page), open(page, encoding="utf-8") as file:
                self.assertEqual(missing_names(file.read(), paths), [])

    def test_git_url_is_the_repository_of_package_json(self):
        with open(os.path.join(REPOSITORY, "package.json"), encoding="utf-8") as file:
            expected = json.load(file)["repository"]["url"]
        for page in ("README.md", "Documentation~/unity.md"):
            with self.subTest(page), open(os.path.join(REPOSITORY, page), encoding="utf-8") as file:
                self.assertEqual(set(re.findall(r"(https://[^\s`]+)#upm", file.read())), {expected})

    def test_missing_files_are_found(self):
        paths = {"/io/trajectory.h", "/Scripts~/setup.sh"}
        self.assertEqual(missing_names("`trajectory.h` `io/trajectory.h` `Scripts~/setup.sh` `x.txt` y.h", paths), [])
        self.assertEqual(missing_names("`jectory.h` `cli/trajectory.h` `setup.cmake`", paths),
                         ["cli/trajectory.h", "jectory.h", "setup.cmake"])


if __name__ == "__main__":
    REPOSITORY = os.path.abspath(sys.argv.pop(1))
    unittest.main()
