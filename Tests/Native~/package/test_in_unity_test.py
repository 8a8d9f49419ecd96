# SPDX-License-Identifier: MIT
"""Scripts~/test-in-unity.sh with a program that stands in for the Editor: it checks the project, then does what it is told.

    test_in_unity_test.py REPOSITORY [PACKAGE]

PACKAGE is one made by make-package; without it, that test is left out.
"""

import io
import os
import shutil
import stat
import subprocess
import sys
import tarfile
import tempfile
import unittest

REPOSITORY = PACKAGE = ""

PATIENCE = 150  # s: who takes longer hangs

MANIFEST = '{"name": "org.quickses.unity", "version": "1.2.3", "unity": "2021.3", "unityRelease": "7f2"}'

STAND_IN = r"""#!@PYTHON@
import json, os, sys, tarfile, time

def value_of(option):
    return sys.argv[sys.argv.index(option) + 1]

def result(cases, attributes='result="Passed"'):
    with open(value_of("-testResults"), "w", encoding="utf-8") as file:
        file.write('<?xml version="1.0" encoding="utf-8"?><test-run id="2" %s><test-suite type="TestSuite" name="Project">'
                   '%s</test-suite></test-run>' % (attributes, cases))

project, platform, log = value_of("-projectPath"), value_of("-testPlatform"), value_of("-logFile")
for option in ("-batchmode", "-runTests"):
    assert option in sys.argv, option
assert "-quit" not in sys.argv and not os.path.exists(value_of("-testResults"))
assert ("-nographics" in sys.argv) == ("nographics" in os.environ["STAND_IN"])
assert sorted(os.listdir(project)) == ["Assets", "Packages", "ProjectSettings"] and not os.listdir(project + "/Assets")
with open(project + "/Packages/manifest.json", encoding="utf-8") as file:
    manifest = json.load(file)
assert sorted(manifest["dependencies"]) == ["com.unity.test-framework", "org.quickses.unity"]
assert manifest["dependencies"]["com.unity.test-framework"] == "1.1.33"
assert manifest["testables"] == ["org.quickses.unity"]
kind, _, path = manifest["dependencies"]["org.quickses.unity"].partition(":")
assert kind == "file"
with tarfile.open(os.path.join(project, "Packages", path)) as archive:
    names = archive.getnames()
    package = json.load(archive.extractfile("package/package.json"))
assert package["name"] == "org.quickses.unity"
assert any(name.startswith("package/Tests/Runtime/") and name.endswith(".asmdef") for name in names)
with open(project + "/ProjectSettings/ProjectVersion.txt", encoding="utf-8") as file:
    assert file.read() == "m_EditorVersion: %s.%s\n" % (package["unity"], package["unityRelease"])
with open(log, "w", encoding="utf-8") as file:
    file.write("Assets/A.cs(1,2): error CS0103: no such name\n" + "nothing\n" * 100 + "the last line of " + platform)

PASSED = '<test-case fullname="A.Right" result="Passed"/>'
wanted = os.environ["STAND_IN"].split()[0]
if wanted == "pass":
    result(PASSED * 2 + '<test-case fullname="A.Left" result="Skipped" label="Ignored"/>')
elif wanted == "fail" and platform == "PlayMode":
    result(PASSED + '<test-case fullname="A.Wrong" result="Failed"><failure><message><![CDATA[Expected: 1\nBut was: 2]]>'
           '</message></failure></test-case>', 'result="Failed(Child)"')
    sys.exit(2)
elif wanted == "foreign":
    result('<test-case fullname="A.W\u00e4rme" result="Failed"><failure><message>1 \u00c5, \u6e29\u5ea6 \ufffd</message>'
           '</failure></test-case>', 'result="Failed(Child)"')
elif wanted == "teardown":
    result(PASSED + '<test-suite fullname="A" result="Failed" site="TearDown"><failure><message>left over</message>'
           '</failure></test-suite>', 'result="Failed(Child)"')
elif wanted == "failed-run":
    result(PASSED, 'result="Failed(Child)"')
elif wanted == "status":
    result(PASSED)
    sys.exit(3)
elif wanted == "empty":
    result("")
elif wanted == "broken":
    open(value_of("-testResults"), "w").write("<test-run>")
elif wanted == "crash":
    os.abort()
elif wanted == "hang":
    time.sleep(600)
elif wanted != "nothing":
    result(PASSED)
"""


def packed(files):
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode="w:gz") as archive:
        for path, text in files.items():
            entry = tarfile.TarInfo("package/" + path)
            entry.size = len(text)
            archive.addfile(entry, io.BytesIO(text.encode()))
    return data.getvalue()


class TestInUnityTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.editor = os.path.join(self.folder, "Unity")
        with open(self.editor, "w", encoding="utf-8") as file:
            file.write(STAND_IN.replace("@PYTHON@", sys.executable))
        os.chmod(self.editor, stat.S_IRWXU)
        os.mkdir(os.path.join(self.folder, "temporary"))
        self.package = self.make_package({"package.json": MANIFEST, "Tests/Runtime/A.asmdef": "{}"})

    def make_package(self, files):
        path = os.path.join(self.folder, "org.quickses.unity-1.2.3.tgz")
        with open(path, "wb") as file:
            file.write(packed(files))
        return path

    def run_script(self, *options, wanted="pass", **environment):
        """(exit status, all that it printed)"""
        environment = dict(os.environ, STAND_IN=wanted, TMPDIR=os.path.join(self.folder, "temporary"),
                           **{"DISPLAY": ":9", **environment})
        done = subprocess.run(["bash", os.path.join(REPOSITORY, "Scripts~/test-in-unity.sh"), *options], env=environment,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8", check=False, timeout=PATIENCE)
        return done.returncode, done.stdout

    def run_tests(self, wanted, *options, **environment):
        return self.run_script(self.editor, "--package", self.package, "--output", os.path.join(self.folder, "out"), *options,
                               wanted=wanted, **environment)

    def without_display(self):
        """The environment of a machine with xvfb-run, or what stands in for it."""
        with open(os.path.join(self.folder, "xvfb-run"), "w", encoding="utf-8") as file:
            file.write('#!/bin/sh\necho "a display for $2"\nshift\n"$@"\n')
        os.chmod(file.name, stat.S_IRWXU)
        return {"DISPLAY": "", "PATH": self.folder + ":" + os.environ["PATH"]}

    def assert_fails(self, wanted, *sentences, options=(), **environment):
        status, text = self.run_tests(wanted, *options, **environment)
        self.assertEqual(status, 1, text)
        for sentence in sentences:
            self.assertIn(sentence, text)

    def test_all_pass(self):
        status, text = self.run_tests("pass")
        self.assertEqual(status, 0, text)
        for mode in ("EditMode", "PlayMode"):
            self.assertIn(f"{mode}: 2 passed, 0 failed, 1 skipped\n", text)
            self.assertTrue(os.path.isfile(os.path.join(self.folder, "out", mode + ".xml")))
        self.assertEqual(os.listdir(os.path.join(self.folder, "temporary")), [])  # the project is gone

    def test_the_package_of_this_build(self):
        if not PACKAGE:
            self.skipTest("no package is given")
        self.package = PACKAGE
        status, text = self.run_tests("pass")
        self.assertEqual(status, 0, text)

    def test_failed_test(self):
        self.assert_fails("fail", "EditMode: 1 passed, 0 failed", "PlayMode: 1 passed, 1 failed",
                          "FAILED A.Wrong\n    Expected: 1\n    But was: 2")

    def test_failure_after_the_tests_of_a_class(self):
        self.assert_fails("teardown", "EditMode: 1 passed, 1 failed", "FAILED A\n    left over")

    def test_messages_in_any_language_whatever_the_encoding_of_the_console(self):
        for encoding in ("cp1252", "ascii", "utf-8"):
            self.assert_fails("foreign", "FAILED A.W\u00e4rme\n    1 \u00c5, \u6e29\u5ea6 \ufffd", "PlayMode: 0 passed, 1 failed",
                              PYTHONIOENCODING=encoding)

    def programs(self, **texts):
        """A folder of them, and of what the script needs else."""
        folder = os.path.join(self.folder, "programs")
        os.mkdir(folder)
        for name in ("bash", "dirname", "env"):
            os.symlink(shutil.which(name), os.path.join(folder, name))
        for name, text in texts.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
            os.chmod(file.name, stat.S_IRWXU)
        return folder

    def test_python_by_any_name(self):
        shop = "#!/bin/sh\necho 'Python was not found; run without arguments to install from the Store'\nexit 49\n"
        works = f'#!/bin/sh\nexec "{sys.executable}" "$@"\n'
        launcher = f'#!/bin/sh\n[ "$1" = -3 ] && shift && exec "{sys.executable}" "$@"\n'
        for names in ({"python3": works}, {"python3": shop, "python": works}, {"python": works},
                      {"python3": shop, "python": shop, "py": launcher}):
            with self.subTest(names):
                folder = self.programs(**names)
                status, text = self.run_tests("pass", PATH=folder)
                self.assertEqual(status, 0, text)
                self.assertNotIn("Store", text)
                shutil.rmtree(folder)
        status, text = self.run_tests("pass", PATH=self.programs(python3=shop))
        self.assertEqual(status, 2, text)
        self.assertIn("there is no Python 3", text)

    def test_run_that_failed_by_itself(self):
        self.assert_fails("failed-run", "FAILED <test-run>\n    Failed(Child)")

    def test_editor_that_ends_badly_after_good_results(self):
        self.assert_fails("status", "EditMode: 1 passed, 0 failed", "the Editor ended with 3", "the last line of EditMode")

    def test_no_test_was_found(self):
        self.assert_fails("empty", "EditMode: 0 passed", "no test was found", "error CS0103")

    def test_no_results(self):
        self.assert_fails("nothing", "EditMode: no results", "error CS0103", "the last line of PlayMode")

    def test_results_of_an_earlier_run(self):
        self.assertEqual(self.run_tests("pass")[0], 0)
        self.assert_fails("nothing", "EditMode: no results", "PlayMode: no results")

    def test_results_that_are_no_xml(self):
        self.assert_fails("broken", "EditMode: no results")

    def test_editor_that_dies(self):
        self.assert_fails("crash", "EditMode: no results (the Editor ended with -6)", "the last line of EditMode")

    def test_editor_that_hangs(self):
        for seconds in ("5", "15", "45"):  # meanwhile the stand-in writes its log, unless the machine stands still
            status, text = self.run_tests("hang", "--timeout", seconds)
            self.assertEqual(status, 1, text)
            self.assertIn(f"the Editor did not end within {seconds} s", text)
            if "the last line of EditMode" in text:
                return
        self.fail(text)

    def test_nographics(self):
        status, text = self.run_tests("pass nographics", "--nographics")
        self.assertEqual(status, 0, text)

    @unittest.skipUnless(sys.platform.startswith("linux"), "X is for Linux")
    def test_no_display(self):
        status, text = self.run_tests("pass", **self.without_display())
        self.assertEqual(status, 0, text)
        self.assertEqual(text.count(f"a display for {self.editor}\n"), 2, text)

    @unittest.skipUnless(sys.platform.startswith("linux"), "X is for Linux")
    def test_what_hangs_ends_with_what_started_it(self):
        # What goes on would keep this script's output open.
        self.assert_fails("hang", "the Editor did not end within 1 s", options=("--timeout", "1"), **self.without_display())

    def test_the_project_is_kept_if_wanted(self):
        status, text = self.run_tests("pass", "--keep")
        self.assertEqual(status, 0, text)
        project, = os.listdir(os.path.join(self.folder, "temporary"))
        self.assertIn(project, text)

    def test_wrong_use(self):
        self.assertEqual(self.run_script()[0], 2)
        self.assertEqual(self.run_script(self.editor, "--what")[0], 2)
        for options, sentence in (((self.folder + "/none", "--package", self.package), "none is no program"),
                                  ((self.editor, "--package", self.folder + "/none.tgz"), "is no package for Unity"),
                                  ((self.editor, "--package", self.editor), "is no package for Unity")):
            status, text = self.run_script(*options)
            self.assertEqual(status, 2, text)
            self.assertIn(sentence, text)

    def test_package_without_tests(self):
        self.make_package({"package.json": MANIFEST})
        status, text = self.run_tests("pass")
        self.assertEqual(status, 2, text)
        self.assertIn("holds no tests", text)

    def test_help(self):
        status, text = self.run_script("--help")
        self.assertEqual(status, 0, text)
        for word in ("EDITOR", "--package", "Exit status"):
            self.assertIn(word, text)


if __name__ == "__main__":
    REPOSITORY = os.path.abspath(sys.argv.pop(1))
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        PACKAGE = os.path.abspath(sys.argv.pop(1))
    unittest.main()
