# SPDX-License-Identifier: MIT
"""The files of the repository that its pages name are there, what their links lead to, and the git URL.
    page_paths_test.py REPOSITORY

A name in backquotes is that of a file if it ends like a source: `arc.h`, `io/trajectory.h`, `Scripts~/setup.sh`. It may leave out
folders in front. Names of users' files (1crn.pdb.txt) don't end so; unitymol.md names files of UnityMol.
"""

import glob
import json
import os
import re
import sys
import unittest
import urllib.parse

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


def anchors_of(text):
    """What links can name of a page: its headings, as GitHub writes them in addresses."""
    anchors = {}
    for heading in re.findall(r"(?m)^#{1,6} +(.*?)[ #]*$", re.sub(r"(?ms)^```.*?^```", "", text)):
        heading = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)  # of a link its text
        anchor = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        count = anchors[anchor] = anchors.get(anchor, -1) + 1
        if count > 0:
            anchors[f"{anchor}-{count}"] = 0
    return set(anchors)


def broken_links(page, text):
    """Links to files that are not there, or to headings that their pages do not have."""
    broken = []
    for link in re.findall(r"\]\(([^)\s]+)", re.sub(r"(?ms)^```.*?^```|`[^`\n]*`", "", text)):
        target, _, anchor = urllib.parse.unquote(link).partition("#")
        if re.match(r"[a-z]+:", target):
            continue
        path = os.path.join(os.path.dirname(page), target) if target else page
        if not os.path.exists(path):
            broken.append(link)
        elif anchor:
            linked = text
            if target:
                with open(path, encoding="utf-8") as file:
                    linked = file.read()
            if anchor not in anchors_of(linked):
                broken.append(link)
    return broken


class PagePathsTest(unittest.TestCase):
    @staticmethod
    def pages():
        pages = glob.glob(os.path.join(REPOSITORY, "*.md"))
        pages += glob.glob(os.path.join(REPOSITORY, "Documentation~", "*.md"))
        assert len(pages) > 10
        return pages

    def test_files_that_pages_name(self):
        paths = paths_of(REPOSITORY)
        for page in self.pages():
            if os.path.basename(page) == "unitymol.md":
                continue
            with self.subTest(page), open(page, encoding="utf-8") as file:
                self.assertEqual(missing_names(file.read(), paths), [])

    def test_links_of_pages(self):
        for page in self.pages():
            with self.subTest(page), open(page, encoding="utf-8") as file:
                self.assertEqual(broken_links(page, file.read()), [])

    def test_broken_links_are_found(self):
        text = "\n".join(["# The `h.h`, & so on", "## [A link](LICENSE.md) there", "## Twice", "## Twice",
                          "```", "# none", "```", "[a](#the-hh--so-on) [b](#a-link-there) [c](#twice-1)",
                          "[d](https://example.org/#no) `[e](#no)`",
                          "[f](README.md) [g](./README.md#the-hh--so-on) [h](No.md#x) [i](#none) [j](#twice-2)"])
        page = os.path.join(REPOSITORY, "README.md")
        self.assertEqual(broken_links(page, text), ["./README.md#the-hh--so-on", "No.md#x", "#none", "#twice-2"])

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
