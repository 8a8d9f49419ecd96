# SPDX-License-Identifier: MIT
"""What CMake makes of the project's options and of the machine. Nothing is compiled but what CMake tries out.

    configure_test.py REPOSITORY CMAKE NINJA C_COMPILER CXX_COMPILER
"""

import glob
import json
import os
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest

REPOSITORY = CMAKE = NINJA = CC = CXX = ""

PARENT = """cmake_minimum_required(VERSION 3.22)
project(parent LANGUAGES C CXX)
add_library(before a.c)
add_subdirectory("@REPOSITORY@" quickses)
add_library(after a.c)
foreach(target IN ITEMS before after quickses)
  get_target_property(type ${target} TYPE)
  message(STATUS "${target} is a ${type}")
endforeach()
"""
OF_CMAKE_TOO = ("CC", "CXX", "CFLAGS", "CXXFLAGS", "LDFLAGS", "CMAKE_BUILD_TYPE", "CMAKE_GENERATOR")


class ConfigureTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.build = os.path.join(self.folder, "build")

    def write(self, path, text, mode=0o644):
        path = os.path.join(self.folder, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(path, mode)
        return path

    def configure(self, *options, source=None, generator="Ninja", cxx=None, **environment):
        """(exit status, all that it printed in one line)"""
        kept = {name: value for name, value in os.environ.items() if name not in OF_CMAKE_TOO}
        done = subprocess.run([CMAKE, "-S", source or REPOSITORY, "-B", self.build, "-G", generator,
                               f"-DCMAKE_MAKE_PROGRAM={NINJA}", f"-DCMAKE_C_COMPILER={CC}", f"-DCMAKE_CXX_COMPILER={cxx or CXX}",
                               "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DQUICKSES_BUILD_CLI=OFF", "-DQUICKSES_BUILD_TESTS=OFF",
                               *options], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8",
                              env={**kept, "LC_ALL": "C", **environment}, check=False)
        return done.returncode, " ".join(done.stdout.split())

    def commands(self):
        """{name of a source: its compiler's command lines}"""
        found = {}
        with open(os.path.join(self.build, "compile_commands.json"), encoding="utf-8") as file:
            for entry in json.load(file):
                found.setdefault(os.path.basename(entry["file"]), []).append(entry["command"])
        return found

    # ---- as a part of another project

    def test_the_other_projects_targets_stay_as_they_are(self):
        self.write("parent/CMakeLists.txt", PARENT.replace("@REPOSITORY@", REPOSITORY))
        self.write("parent/a.c", "int a(void) { return 1; }\n")
        for _ in range(2):  # what was cached counts the second time
            status, text = self.configure(source=os.path.join(self.folder, "parent"))
            self.assertEqual(status, 0, text)
            self.assertIn("before is a STATIC_LIBRARY -- after is a STATIC_LIBRARY -- quickses is a SHARED_LIBRARY", text)
            commands = self.commands()
            self.assertTrue(all(" -O" not in command for command in commands["a.c"]), commands["a.c"])
            for name in ("quickses.cpp", "cpu_engine.cpp"):
                self.assertTrue(all(" -O3 -DNDEBUG " in command for command in commands[name]), commands[name])

    def test_the_other_project_decides(self):
        self.write("parent/CMakeLists.txt", PARENT.replace("@REPOSITORY@", REPOSITORY))
        self.write("parent/a.c", "int a(void) { return 1; }\n")
        status, text = self.configure("-DBUILD_SHARED_LIBS=OFF", "-DCMAKE_BUILD_TYPE=Debug",
                                      source=os.path.join(self.folder, "parent"))
        self.assertEqual(status, 0, text)
        self.assertIn("quickses is a STATIC_LIBRARY", text)
        self.assertTrue(all(" -O" not in command for command in self.commands()["quickses.cpp"]))

    # ---- what is installed

    def test_what_is_installed_is_made_with_the_program(self):  # by demo.sh, after which the README installs
        status, text = self.configure("-DQUICKSES_BUILD_CLI=ON")
        self.assertEqual(status, 0, text)
        made = subprocess.run([NINJA, "-C", self.build, "-t", "commands", "quickses_cli"], capture_output=True, encoding="utf-8",
                              check=True).stdout
        installed = []
        for path in glob.glob(os.path.join(self.build, "**", "cmake_install.cmake"), recursive=True):
            with open(path, encoding="utf-8") as file:
                for files in re.findall(r" FILES ([^)]*)\)", file.read()):
                    installed += [name for name in re.findall('"([^"]+)"', files) if name.startswith(self.build)]
        self.assertIn(os.path.join(self.build, "bin", "quickses"), installed)
        for name in installed:
            self.assertTrue(os.path.exists(name) or os.path.relpath(name, self.build) in made, name)

    # ---- what can't be

    def test_static_library_with_a_fetched_gemmi(self):
        self.write("gemmi/CMakeLists.txt", "add_library(gemmi_cpp STATIC a.cpp)\n")
        self.write("gemmi/a.cpp", "")
        options = ["-DQUICKSES_FETCH=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_gemmi=ON",
                   f"-DFETCHCONTENT_SOURCE_DIR_GEMMI={self.folder}/gemmi"]
        status, text = self.configure("-DBUILD_SHARED_LIBS=OFF", *options)
        self.assertNotEqual(status, 0, text)
        self.assertIn("A static library can't be installed with a gemmi that was fetched", text)
        for other in ("-DQUICKSES_INSTALL=OFF", "-DBUILD_SHARED_LIBS=ON"):
            status, text = self.configure(*options, other)
            self.assertEqual(status, 0, text)

    # ---- what the machine has

    def test_python_without_yaml_comes_first(self):
        if subprocess.run(["/usr/bin/python3", "-c", "import yaml"], capture_output=True, check=False).returncode:
            self.skipTest("the system's Python has no PyYAML")
        programs = os.path.dirname(self.write("programs/python3", "#!/bin/sh\nexit 1\n", stat.S_IRWXU))
        status, text = self.configure("-DQUICKSES_PLUGIN=ON", PATH=programs + ":" + os.environ["PATH"])
        self.assertEqual(status, 0, text)
        with open(os.path.join(self.build, "CMakeCache.txt"), encoding="utf-8") as file:
            self.assertIn("\nQUICKSES_PYTHON:FILEPATH=/usr/bin/python3\n", file.read())

    def test_compiler_that_knows_no_newer_processors(self):
        older = self.write("older", f'#!/bin/sh\ncase "$*" in *-march=x86-64-v*) exit 1; esac\nexec "{CXX}" "$@"\n', stat.S_IRWXU)
        status, text = self.configure(cxx=older)
        self.assertEqual(status, 0, text)
        commands = self.commands()
        self.assertEqual(len(commands["cpu_kernels_features.cpp"]), 1)
        self.assertNotIn("HAS_NEWER_CPU_KERNELS", str(commands))

    def test_cuda_is_optimized_whatever_the_generator(self):
        for generator, options in (("Ninja Multi-Config", ()), ("Ninja", ("-DCMAKE_BUILD_TYPE=None",)), ("Ninja", ())):
            with self.subTest(generator, options=options):
                shutil.rmtree(self.build, ignore_errors=True)
                status, text = self.configure("-DQUICKSES_CUDA=ON", *options, generator=generator)
                if status and "which takes the CUDA Toolkit" in text:
                    self.skipTest("no CUDA Toolkit, or no Clang for it")
                self.assertEqual(status, 0, text)
                lines = []
                for path in glob.glob(os.path.join(self.build, "**", "*.ninja"), recursive=True):
                    with open(path, encoding="utf-8") as file:
                        lines += [line for line in file if " -x cuda " in line]
                self.assertTrue(lines)
                self.assertTrue(all(" -O3 " in line for line in lines), lines[0])


if __name__ == "__main__":
    if len(sys.argv) < 6:
        sys.exit(__doc__)
    REPOSITORY, CMAKE, NINJA, CC, CXX = os.path.abspath(sys.argv[1]), *sys.argv[2:6]
    del sys.argv[1:6]
    unittest.main()
