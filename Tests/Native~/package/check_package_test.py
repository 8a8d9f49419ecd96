# SPDX-License-Identifier: MIT
"""Scripts~/package/check-package must pass a right package and name each kind of fault.

    check_package_test.py REPOSITORY C_COMPILER [MINGW_C_COMPILER]

The packages are small, with libraries of empty functions. Without MinGW, faults of quickses.dll are not tried.
"""

import os
import re
import struct
import subprocess
import sys
import tarfile
import tempfile
import unittest

from small_package import LINUX, WINDOWS, SmallPackage, built, manifest, meta, write_archive, write_folder

REPOSITORY = COMPILER = MINGW = ""


def fat_binary(*kinds_and_architectures):
    """Code for GPUs, as far as check-package reads it: of each entry 2, machine code, or 1, PTX; and the architecture."""
    entries = b"".join(struct.pack("<HHIQ12xI32x", kind, 0, 64, 8, architecture) + b"8 bytes "
                       for kind, architecture in kinds_and_architectures)
    return struct.pack("<IHHQ", 0xba55ed50, 1, 16, len(entries)) + entries


class CheckPackageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.small = SmallPackage(REPOSITORY, COMPILER, MINGW)
        cls.source, cls.linux = cls.small.source, cls.small.linux
        cls.good, cls.dll = cls.small.good, cls.small.dll

    def right_package(self):
        return self.small.files()

    def check(self, package, *options):
        done = subprocess.run([sys.executable, "-B", os.path.join(REPOSITORY, "Scripts~/package/check-package"), package,
                               *options], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def run_on(self, files, *options, name="org.quickses.unity-1.2.3.tgz", change=lambda entries: entries, sums=None):
        with tempfile.TemporaryDirectory() as folder:
            archive = os.path.join(folder, name)
            write_archive(archive, files, change)
            if sums is not None:
                with open(archive + ".sha256", "w", encoding="utf-8") as file:
                    file.write(sums)
            return self.check(archive, *options)

    def assert_fault(self, files, sentence, *options, count=1, **how):
        status, text = self.run_on(files, *options, **how)
        self.assertEqual(status, 1, text)
        self.assertIn(sentence, text)
        self.assertIn(f" {count} faults", text)  # this fault, and no other one

    def assert_library_fault(self, library, sentence, path=LINUX + "libquickses.so"):
        files = self.right_package()
        files[path] = library
        self.assert_fault(files, f"{path}: {sentence}")

    # ---- what is in the package

    def test_right_package(self):
        platforms = ["--platform", "linux-x86_64"] + (["--platform", "windows-x86_64"] if self.dll else [])
        files = self.right_package()
        self.assertEqual(self.run_on(files, *platforms), (0, f"check-package: {len(files)} files, 0 faults\n"))

    def test_missing_document(self):
        files = self.right_package()
        del files["LICENSE.md"], files["LICENSE.md.meta"]
        self.assert_fault(files, "LICENSE.md: is missing")

    def test_files_that_do_not_belong(self):
        for path in ("NativePlugin/Source~/a.cpp", "UnityPackage/Runtime/.hidden.cs", "Documentation~/index.md.swp",
                     "Samples~/notes.docx", "Documentation~/build~/a.md", "Tests/DotNet~/a.cs", "Documentation~/a.md.meta"):
            files = self.right_package()
            files[path] = b""
            status, text = self.run_on(files)
            self.assertEqual(status, 1, text)
            self.assertIn(f"{path}: doesn't belong in the package", text)

    def test_meta_of_what_was_left_out(self):
        for name in ("NativePlugin", "CMakeLists.txt"):
            files = self.right_package()
            files[name + ".meta"] = meta(20, "DefaultImporter", folder=name == "NativePlugin")
            self.assert_fault(files, f"{name}.meta: {name} does not exist")

    def test_file_without_meta(self):
        files = self.right_package()
        files["UnityPackage/Runtime/A.cs"] = b""
        self.assert_fault(files, "UnityPackage/Runtime/A.cs: no .meta")

    def test_guid_of_the_package_in_a_sample(self):
        files = self.right_package()
        files["package.json"] = manifest(samples=[{"path": "Samples~/Player"}])
        files["Samples~/Player/A.cs"] = b""
        files["Samples~/Player/A.cs.meta"] = meta(21, "MonoImporter")
        self.assertEqual(self.run_on(files)[0], 0)
        files["Samples~/Player/A.cs.meta"] = meta(3, "MonoImporter")
        self.assert_fault(files, "Samples~/Player/A.cs.meta: same guid as UnityPackage/Runtime.meta")

    def test_sample_that_is_not_there(self):
        files = self.right_package()
        files["package.json"] = manifest(samples=[{"path": "Samples~/Player"}])
        self.assert_fault(files, "sample Samples~/Player is not there")

    def test_sample_that_is_not_listed(self):
        files = self.right_package()
        files["Samples~/Player/A.cs"] = b""
        self.assert_fault(files, "Samples~/Player: is no sample of package.json")

    def test_dead_links(self):
        files = self.right_package()
        files["Documentation~/index.md"] = (b"[a](index.md#manual) [b](../README.md) [c](https://example.org/no.md) "
                                            b"`[d](no.md)`\n```\n[e](no.md)\n```\n[f](no.md#x) <img src=\"no.png\">\n")
        self.assert_fault(files, "Documentation~/index.md: links to no.md, which is not there", count=2)

    def test_data_outside_of_its_folder(self):
        files = self.right_package()
        files["UnityPackage/Runtime/junk.bytes"] = b"1"
        files["UnityPackage/Runtime/junk.bytes.meta"] = meta(22, "TextScriptImporter")
        self.assert_fault(files, "UnityPackage/Runtime/junk.bytes: doesn't belong in the package")

    def test_other_guid_of_a_plugin(self):
        for path in (LINUX + "libquickses.so.meta", "UnityPackage/Plugins/linux-x86_64.meta", "UnityPackage/Plugins.meta"):
            files = self.right_package()
            files[path] = re.sub(rb"guid: ....", b"guid: 0123", files[path])
            self.assert_fault(files, f"{path}: differs from plugin_metas/")

    def test_archive_of_another_version(self):
        self.assert_fault(self.right_package(), "its archive is called org.quickses.unity-1.2.3.tgz",
                          name="org.quickses.unity-1.2.4.tgz")

    def test_repository(self):
        for repository in (None, {"type": "git"}, {"url": "git@quickses.test:quickses.git"}, {"url": "https://quickses.test/"}):
            files = self.right_package()
            files["package.json"] = manifest(repository=repository)
            self.assert_fault(files, "package.json: its repository has no url https://....git")
        url = "https://quickses.test/quickses.git"
        files["package.json"] = manifest(repository={"url": url, "revision": "0123456789abcdef" * 2 + "01234567"})
        self.assertEqual(self.run_on(files)[0], 0)
        files["package.json"] = manifest(repository={"url": url, "revision": "v1.2.3"})
        self.assert_fault(files, "package.json: the revision of its repository is no commit")

    def test_manifest_that_is_no_json(self):
        files = self.right_package()
        files["package.json"] = b"{"
        self.assert_fault(files, "package.json: JSONDecodeError")

    # ---- the archive

    def test_path_outside_of_the_package(self):
        def change(entries):
            entry = tarfile.TarInfo("package/../evil")
            return entries + [(entry, b"")]
        self.assert_fault(self.right_package(), "package/../evil: must be below package/", change=change)

    def test_link(self):
        def change(entries):
            entry = tarfile.TarInfo("package/zlink")
            entry.type, entry.linkname = tarfile.SYMTYPE, "README.md"
            return entries + [(entry, b"")]
        self.assert_fault(self.right_package(), "zlink: is no plain file", change=change)

    def test_order(self):
        self.assert_fault(self.right_package(), "the files are not sorted", change=lambda entries: entries[::-1])

    def test_time_of_the_machine(self):
        def change(entries):
            entries[0][0].mtime = 1700000000
            return entries
        self.assert_fault(self.right_package(), "has an owner or a time of its own", change=change)

    def test_damaged_archive(self):
        with tempfile.NamedTemporaryFile(suffix=".tgz") as file:
            file.write(b"\x1f\x8b no archive")
            file.flush()
            status, text = self.check(file.name)
        self.assertEqual(status, 1)
        self.assertNotIn("Traceback", text)

    def test_archive_that_is_too_large(self):
        files = self.right_package()
        files["Documentation~/noise.png"] = os.urandom(17_000_000)
        self.assert_fault(files, " bytes; 17,000,000 are allowed")

    def test_sums(self):
        with tempfile.TemporaryDirectory() as folder:
            archive = os.path.join(folder, "org.quickses.unity-1.2.3.tgz")
            write_archive(archive, self.right_package())
            lines = subprocess.run(["sha256sum", os.path.basename(archive)], cwd=folder, capture_output=True, text=True,
                                   check=True).stdout
            with tarfile.open(archive) as entries:
                entries.extractall(folder)
            libraries = [LINUX + "libquickses.so"] + [WINDOWS + "quickses.dll"] * bool(self.dll)
            lines += subprocess.run(["sha256sum", *("package/" + path for path in libraries)], cwd=folder, capture_output=True,
                                    text=True, check=True).stdout
            with open(archive + ".sha256", "w", encoding="utf-8") as file:
                file.write(lines)
            self.assertEqual(self.check(archive)[0], 0)
        self.assert_fault(self.right_package(), "1.2.3.tgz.sha256: has other sums than the archive", sums="0" * 64 + lines[64:])

    # ---- the unpacked package

    def test_folder(self):
        for more, sentence in (({}, ", 0 faults"), ({".git/config": b"", ".gitattributes": b""}, ", 0 faults"),
                               ({".gitignore": b""}, ".gitignore: doesn't belong in the package"),
                               ({"README.md.meta": b""}, "README.md.meta: must begin with fileFormatVersion")):
            with self.subTest(more), tempfile.TemporaryDirectory() as folder:
                write_folder(folder, {**self.right_package(), **more})
                status, text = self.check(folder, "--platform", "linux-x86_64")
                self.assertIn(sentence, text)
                self.assertEqual(status, 0 if "0 faults" in sentence else 1)

    # ---- native libraries

    def test_platform_that_is_missing(self):
        files = {path: data for path, data in self.right_package().items() if "windows" not in path}
        status, text = self.run_on(files, "--platform", "windows-x86_64")
        self.assertEqual(status, 1)
        self.assertIn("UnityPackage/Plugins/windows-x86_64/quickses.dll is missing", text)
        self.assertIn(" 1 faults", text)

    def test_no_library_at_all(self):
        files = {path: data for path, data in self.right_package().items() if "Plugins" not in path}
        self.assert_fault(files, "has no native library")

    def test_library_for_a_wrong_platform(self):
        files = self.right_package()
        path = LINUX + "libquickses.so.meta"
        files[path] = files[path].replace(b"Exclude Win64: 1", b"Exclude Win64: 0")
        self.assert_fault(files, "Exclude Win64 is 0 but Win64's enabled is 0", count=2)  # and it is not the template

    def test_stray_library(self):
        files = self.right_package()
        files[LINUX + "libgomp.so"] = self.good
        files[LINUX + "libgomp.so.meta"] = re.sub(rb"guid: .*", b"guid: " + b"a" * 32, files[LINUX + "libquickses.so.meta"])
        self.assert_fault(files, LINUX + "libgomp.so: doesn't belong in the package")

    def test_no_library(self):
        self.assert_library_fault(b"version https://git-lfs.github.com/spec/v1\n", "is no shared library of Linux")

    def test_needs_what_is_not_on_every_machine(self):
        for name in ("libtbb.so.12", "libgomp.so.1", "libstdc++.so.6", "libcudart.so.12", "libcuda.so.1"):
            other = built(COMPILER, "void other(void) {}", "-fPIC", f"-Wl,-soname,{name}")
            self.assert_library_fault(self.small.built_beside(other, name, self.source, *self.linux), f"needs {name}")

    def test_symbol_that_the_header_does_not_declare(self):
        self.assert_library_fault(built(COMPILER, self.source + "void inflate(void) {}", *self.linux),
                                  "exports inflate, which no header declares")

    def test_symbol_that_is_missing(self):
        source = re.sub(r"void qses_compute\(void\) {}\n", "", self.source)
        self.assert_library_fault(built(COMPILER, source, *self.linux), "doesn't export qses_compute")

    def test_rpath(self):
        for tags in ("--enable-new-dtags", "--disable-new-dtags"):
            library = built(COMPILER, self.source, *self.linux, f"-Wl,{tags}", "-Wl,-rpath,$ORIGIN:/opt/lib")
            self.assert_library_fault(library, "looks for libraries in $ORIGIN:/opt/lib")

    def test_wrong_soname(self):
        library = built(COMPILER, self.source, "-fPIC", "-nostartfiles", "-Wl,-soname,libquickses.so.0")
        self.assert_library_fault(library, "has the soname libquickses.so.0, not its name")

    def test_newer_glibc(self):
        with tempfile.TemporaryDirectory() as folder:
            script = os.path.join(folder, "versions.map")
            with open(script, "w", encoding="utf-8") as file:
                file.write("GLIBC_2.36 { global: arc4random; local: *; };\n")
            other = built(COMPILER, "unsigned arc4random(void) { return 4; }", "-fPIC", "-nostdlib",
                          "-Wl,-soname,libc.so.6", f"-Wl,--version-script={script}")
        source = self.source.replace("void qses_compute(void) {}", "unsigned arc4random(void);"
                                     "unsigned qses_compute(void) { return arc4random(); }")
        library = self.small.built_beside(other, "libc.so.6", source, *self.linux, "-nostdlib")
        self.assert_library_fault(library, "needs GLIBC_2.36; 2.34 is the newest allowed")

    def test_dll_that_is_none(self):
        if not self.dll:
            self.skipTest("no MinGW")
        self.assert_library_fault(self.good, "is no library of Windows", WINDOWS + "quickses.dll")

    def test_dll_that_needs_the_compilers(self):
        if not self.dll:
            self.skipTest("no MinGW")
        source = self.source.replace("void qses_compute(void) {}",
                                     "__declspec(dllimport) int omp_get_num_threads(void);"
                                     "int qses_compute(void) { return omp_get_num_threads(); }")
        with tempfile.TemporaryDirectory() as folder:
            imports = os.path.join(folder, "libgomp.dll.a")
            subprocess.run([MINGW, "-x", "c", "-", "-shared", "-o", os.path.join(folder, "libgomp-1.dll"),
                            f"-Wl,--out-implib={imports}"], input="int omp_get_num_threads(void) { return 1; }",
                           text=True, check=True)
            library = built(MINGW, source, "-Wl,--export-all-symbols", imports)
        self.assert_library_fault(library, "needs libgomp-1.dll", WINDOWS + "quickses.dll")

    def test_dll_that_needs_more_of_windows(self):
        if not self.dll:
            self.skipTest("no MinGW")
        source = self.source.replace("void qses_compute(void) {}", "__declspec(dllimport) int __stdcall MessageBeep(unsigned);"
                                     "int qses_compute(void) { return MessageBeep(0); }")
        self.assert_library_fault(built(MINGW, source, "-Wl,--export-all-symbols", "-luser32"), "needs USER32.dll",
                                  WINDOWS + "quickses.dll")

    def test_gpu_code(self):
        everything = [(2, 75), (2, 80), (2, 86), (2, 89), (1, 90), (2, 90)]
        files = {path: data for path, data in self.right_package().items() if "windows" not in path}
        library = LINUX + "libquickses.so"
        self.assert_fault(files, f"{library}: has no code for GPUs", "--cuda")
        files[library] = self.good + fat_binary(*everything) + b"between" + fat_binary(*everything)
        self.assertEqual(self.run_on(files, "--cuda")[0], 0)
        files[library] = self.good + fat_binary(*everything) + fat_binary(*everything[1:])
        self.assert_fault(files, f"{library}: has no machine code for compute capability 7.5", "--cuda")
        files[library] = self.good + fat_binary(*everything[:4], (2, 90))
        self.assert_fault(files, f"{library}: has no PTX for compute capability 9.0", "--cuda")
        files[library] = self.good + fat_binary(*everything)[:-100]
        self.assert_fault(files, f"{library}: has damaged code for GPUs", "--cuda")

    def test_dll_that_exports_something_else(self):
        if not self.dll:
            self.skipTest("no MinGW")
        self.assert_library_fault(built(MINGW, self.source + "void inflate(void) {}"),
                                  "exports inflate, which no header declares", WINDOWS + "quickses.dll")


if __name__ == "__main__":
    REPOSITORY, COMPILER = os.path.abspath(sys.argv.pop(1)), sys.argv.pop(1)
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        MINGW = sys.argv.pop(1)
    unittest.main()
