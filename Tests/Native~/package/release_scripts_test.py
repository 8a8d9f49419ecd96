# SPDX-License-Identifier: MIT
"""make-package, verify-package and make-release-branch, on a small repository of their own.

    release_scripts_test.py REPOSITORY

Scripts~/package.sh of the small repository compiles nothing: its library is a line of text.
"""

import glob
import gzip
import json
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

from small_package import LINUX, MANIFEST, manifest, sources, write_archive, write_folder

REPOSITORY = ""
LIBRARY = "\0ELF\r\n\0"  # git takes it for binary, and would change its line end if not
PACKAGE_SH = r"""set -e
cd "$(dirname "$0")/.."
mkdir -p UnityPackage/Plugins/linux-x86_64 "$1"
printf '\0ELF\r\n\0%s' "LEAK" > UnityPackage/Plugins/linux-x86_64/libquickses.so
python3 -B Scripts~/package/make-package "$1"
"""
# The machine's own settings of git stay out of it.
ENVIRONMENT = {**{name: value for name, value in os.environ.items() if not name.startswith("GIT_")},
               "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_SYSTEM": os.devnull}


def run(*command, folder=None, check=True):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env=ENVIRONMENT)
    if check and done.returncode:
        raise AssertionError(f"{command}: {done.stdout}{done.stderr}")
    return done


class ReleaseScriptsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.repository = os.path.join(self.folder, "repository")
        write_folder(self.repository, {**sources(), ".gitignore": b"/UnityPackage/Plugins/\n",
                                       "Scripts~/package.sh": PACKAGE_SH.encode()})
        shutil.copytree(os.path.join(REPOSITORY, "Scripts~", "package"), os.path.join(self.repository, "Scripts~", "package"),
                        ignore=shutil.ignore_patterns("__pycache__"))
        run("git", "init", "--quiet", "--initial-branch=main", self.repository)
        self.git("config", "user.name", "A")
        self.git("config", "user.email", "a@quickses.test")
        self.commit("v1.2.3")

    def git(self, *arguments, check=True):
        return run("git", "-C", self.repository, *arguments, check=check).stdout.strip()

    def commit(self, tag=None, **files):
        write_folder(self.repository, {path: text.encode() for path, text in files.items()})
        self.git("add", "--all")
        self.git("commit", "--quiet", "--allow-empty", "--message", "A change")
        if tag:
            self.git("tag", tag)
        return self.git("rev-parse", "HEAD")

    def package(self):
        built = os.path.join(self.folder, "built")
        run("bash", os.path.join(self.repository, "Scripts~", "package.sh"), built)
        return max(glob.glob(os.path.join(built, "*.tgz")), key=os.path.getmtime)

    def script(self, name, *arguments):
        done = run(sys.executable, "-B", os.path.join(REPOSITORY, "Scripts~", "package", name), *arguments, "--repository",
                   self.repository, check=False)
        return done.returncode, done.stdout + done.stderr

    def files_of(self, package):
        with tarfile.open(package) as archive:
            return {entry.name[len("package/"):]: archive.extractfile(entry).read() for entry in archive}

    def changed(self, package, **files):
        """The package with other files, in another folder."""
        folder = tempfile.mkdtemp(dir=self.folder)
        name = os.path.join(folder, os.path.basename(package))
        write_archive(name, {**self.files_of(package), **files})
        return name

    # ---- make-package

    def test_package_names_the_commit_of_a_clean_checkout(self):
        found = json.loads(self.files_of(self.package())["package.json"])
        repository = {**MANIFEST["repository"], "revision": self.git("rev-parse", "HEAD")}
        self.assertEqual(found, {**MANIFEST, "repository": repository})
        for name in ("README.md", "UnityPackage/new.md"):
            write_folder(self.repository, {name: b"changed"})
            self.assertEqual(json.loads(self.files_of(self.package())["package.json"]), MANIFEST)
            self.git("clean", "--quiet", "--force")
            self.git("checkout", "--quiet", ".")

    def test_sums_are_beside_the_package(self):
        package = self.package()
        folder = os.path.dirname(package)
        with tarfile.open(package) as archive:
            archive.extractall(folder)
        said = run("sha256sum", "--check", os.path.basename(package) + ".sha256", folder=folder).stdout
        self.assertEqual(said, f"org.quickses.unity-1.2.3.tgz: OK\npackage/{LINUX}libquickses.so: OK\n")

    # ---- verify-package

    def test_the_same_bytes(self):
        status, text = self.script("verify-package", self.package())
        self.assertEqual(status, 0, text)
        self.assertIn("gives the same bytes", text)

    def test_another_library(self):
        status, text = self.script("verify-package", self.changed(self.package(), **{LINUX + "libquickses.so": b"other"}))
        self.assertEqual(status, 1, text)
        self.assertIn(f"\n{LINUX}libquickses.so: differs, ", "\n" + text)
        self.assertEqual(text.count("differs"), 1, text)

    def test_another_file(self):
        status, text = self.script("verify-package", self.changed(self.package(), more=b""))
        self.assertEqual(status, 1, text)
        self.assertIn("more: only in the package given\n", text)

    def test_another_compression(self):
        package = self.package()
        with gzip.open(package) as file:
            data = file.read()
        with gzip.open(package, "wb", compresslevel=1) as file:
            file.write(data)
        status, text = self.script("verify-package", package)
        self.assertEqual(status, 1, text)
        self.assertIn("the files are the same; their order", text)

    def test_build_that_depends_on_its_folder(self):
        self.commit(**{"Scripts~/package.sh": PACKAGE_SH.replace("LEAK", "$PWD")})
        status, text = self.script("verify-package", self.package())
        self.assertEqual(status, 1, text)
        self.assertIn(f"{LINUX}libquickses.so: differs", text)

    def test_package_that_can_not_be_verified(self):
        write_folder(self.repository, {"README.md": b"changed"})
        self.assertIn("names no commit", self.script("verify-package", self.package())[1])
        self.git("checkout", "--quiet", ".")
        package = self.package()
        unknown = self.changed(package, **{"package.json": manifest(repository={"revision": "0" * 40})})
        for name in (unknown, os.path.join(self.repository, "README.md"), "none.tgz"):
            status, text = self.script("verify-package", name)
            self.assertEqual(status, 1, text)
            self.assertNotIn("Traceback", text)

    # ---- make-release-branch

    def test_release_branch_is_the_package(self):
        package = self.package()
        before = self.git("status", "--branch", "--porcelain"), self.git("rev-parse", "HEAD")
        status, text = self.script("make-release-branch", package)
        self.assertEqual(status, 0, text)
        self.assertEqual((self.git("status", "--branch", "--porcelain"), self.git("rev-parse", "HEAD")), before)
        # As a user's git on Windows would take it.
        clone = os.path.join(self.folder, "clone")
        run("git", "clone", "--quiet", "--config", "core.autocrlf=true", "--depth=1", "--branch=upm/v1.2.3",
            "file://" + self.repository, clone)
        expected = {**self.files_of(package), ".gitattributes": b"* -text\n"}
        found = {}
        for name in run("git", "-C", clone, "ls-files", "-z").stdout.split("\0")[:-1]:
            with open(os.path.join(clone, name), "rb") as file:
                found[name] = file.read()
        self.assertEqual(found, expected)
        self.assertIn(LIBRARY.encode(), found[LINUX + "libquickses.so"])

    def test_the_same_package_gives_the_same_commit(self):
        package = self.package()
        self.script("make-release-branch", package)
        first = self.git("rev-parse", "upm")
        self.assertEqual(self.git("rev-parse", "upm/v1.2.3"), first)
        self.git("tag", "--delete", "upm/v1.2.3")
        self.git("branch", "--quiet", "-D", "upm")
        self.assertEqual(self.script("make-release-branch", package)[0], 0)
        self.assertEqual(self.git("rev-parse", "upm"), first)

    def test_next_version_follows(self):
        self.script("make-release-branch", self.package())
        first = self.git("rev-parse", "upm")
        self.commit("v1.3.0", **{"package.json": manifest(version="1.3.0").decode(),
                                 "CHANGELOG.md": "# Changes\n\n## [1.3.0] - 2026-02-01\n\n## [1.2.3] - 2026-01-31\n"})
        status, text = self.script("make-release-branch", self.package())
        self.assertEqual(status, 0, text)
        self.assertEqual(self.git("rev-parse", "upm^"), first)
        self.assertEqual(self.git("rev-parse", "upm/v1.3.0"), self.git("rev-parse", "upm"))
        self.assertEqual(self.git("rev-parse", "upm/v1.2.3"), first)

    def refuses(self, package, sentence):
        refs = self.git("show-ref")
        status, text = self.script("make-release-branch", package)
        self.assertEqual(status, 1, text)
        self.assertIn(sentence, text)
        self.assertEqual(self.git("show-ref"), refs)

    def test_what_is_refused(self):
        write_folder(self.repository, {"README.md": b"changed"})
        self.refuses(self.package(), "names no commit")
        self.git("checkout", "--quiet", ".")
        package = self.package()
        revision = json.loads(self.files_of(package)["package.json"])["repository"]

        self.git("tag", "v1.2.4")
        other = manifest(version="1.2.4", repository=revision)
        self.refuses(self.changed(package, **{"package.json": other}), "has org.quickses.unity 1.2.4, package.json of its commit")
        unknown = manifest(repository={**revision, "revision": "0" * 40})
        self.refuses(self.changed(package, **{"package.json": unknown}), "isn't in this repository")
        self.refuses(self.changed(package, **{"package.json": b"{}"}), "has no package.json with a name and a version")
        example = manifest(repository={**revision, "url": "https://example.org/a.git"})
        self.refuses(self.changed(package, **{"package.json": example}), "is an example")

        for heading in (b"## [1.2.3] - unreleased\n", b"## [1.2.4] - 2026-01-31\n\n## [1.2.3] - 2026-01-31\n", b""):
            self.refuses(self.changed(package, **{"CHANGELOG.md": heading}), "the first heading of CHANGELOG.md is not [1.2.3]")

        self.git("tag", "--delete", "v1.2.3")
        self.refuses(package, "the tag v1.2.3 is not at commit")
        self.commit("v1.2.3")
        self.refuses(package, "the tag v1.2.3 is not at commit")
        self.assertEqual(self.script("make-release-branch", self.package())[0], 0)
        self.refuses(self.package(), "there is a tag upm/v1.2.3")


if __name__ == "__main__":
    REPOSITORY = os.path.abspath(sys.argv.pop(1))
    unittest.main()
