# SPDX-License-Identifier: MIT
"""Scripts~/package/check-package must pass a right package and name each kind of fault.

    check_package_test.py REPOSITORY C_COMPILER [MINGW_C_COMPILER]

The packages are small, with libraries of empty functions. Without MinGW, faults of quickses.dll are not tried.
"""

import io
import json
import os
import re
import subprocess
import sys
import tarfile
import tempfile
import unittest

REPOSITORY = COMPILER = MINGW = ""
LINUX = "UnityPackage/Plugins/linux-x86_64/"
WINDOWS = "UnityPackage/Plugins/windows-x86_64/"


def meta(number, importer, folder=False):
    return (f"fileFormatVersion: 2\nguid: {number:032x}\n" + ("folderAsset: yes\n" if folder else "") +
            f"{importer}:\n  externalObjects: {{}}\n  userData: \n  assetBundleName: \n  assetBundleVariant: \n").encode()


def built(compiler, source, *options):
    """The bytes of a shared library."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "library.bin")
        subprocess.run([compiler, "-shared", "-o", path, "-x", "c", "-", "-x", "none", *options], input=source,
                       text=True, check=True)
        with open(path, "rb") as file:
            return file.read()


def built_beside(other, name, source, *options):
    """The same, linked to a library of the given bytes and name."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, name)
        with open(path, "wb") as file:
            file.write(other)
        return built(COMPILER, source, *options, "-Wl,--no-as-needed", path)


class CheckPackageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(os.path.join(REPOSITORY, "NativePlugin/Source~/include/quickses/quickses.h"), encoding="utf-8") as file:
            names = re.findall(r"QSES_API [^;(]*[ *](qses_[a-z0-9_]+)\(", file.read())
        cls.source = "".join(f"void {name}(void) {{}}\n" for name in names)
        cls.linux = ("-fPIC", "-nostartfiles", "-Wl,-soname,libquickses.so")
        cls.tbb = built(COMPILER, "void tbb(void) {}", "-fPIC", "-Wl,-soname,libquickses_tbb.so")
        cls.good = built_beside(cls.tbb, "libquickses_tbb.so", cls.source, *cls.linux, "-Wl,-rpath,$ORIGIN")
        cls.dll = built(MINGW, cls.source) if MINGW else None

    def right_package(self):
        """{path: bytes} of a small package without faults."""
        templates = os.path.join(REPOSITORY, "NativePlugin/Source~/plugin_metas")

        def template(name):
            with open(os.path.join(templates, name), "rb") as file:
                return file.read()

        files = {"package.json": json.dumps({"name": "org.quickses.unity", "version": "1.2.3"}).encode(),
                 "package.json.meta": meta(1, "PackageManifestImporter"), "Documentation~/index.md": b"# Manual\n",
                 "UnityPackage.meta": meta(2, "DefaultImporter", folder=True),
                 "UnityPackage/Plugins.meta": template("Plugins.meta"),
                 "UnityPackage/Plugins/linux-x86_64.meta": template("linux-x86_64.meta"),
                 LINUX + "libquickses.so": self.good, LINUX + "libquickses_tbb.so": self.tbb,
                 LINUX + "libquickses.so.meta": template("linux-x86_64/libquickses.so.meta"),
                 LINUX + "libquickses_tbb.so.meta": template("linux-x86_64/libquickses_tbb.so.meta"),
                 "UnityPackage/Runtime.meta": meta(3, "DefaultImporter", folder=True),
                 "UnityPackage/Runtime/Core.meta": meta(4, "DefaultImporter", folder=True),
                 "UnityPackage/Runtime/Core/QuickSes.Core.asmdef": b"{}",
                 "UnityPackage/Runtime/Core/QuickSes.Core.asmdef.meta": meta(5, "AssemblyDefinitionImporter")}
        documents = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE.md", "SECURITY.md",
                     "Third Party Notices.md")
        for number, name in enumerate(documents, 6):
            files[name] = b"text\n"
            files[name + ".meta"] = meta(number, "TextScriptImporter")
        if self.dll:
            files["UnityPackage/Plugins/windows-x86_64.meta"] = template("windows-x86_64.meta")
            files[WINDOWS + "quickses.dll"] = self.dll
            files[WINDOWS + "quickses.dll.meta"] = template("windows-x86_64/quickses.dll.meta")
        return files

    def run_on(self, files, *options, name="org.quickses.unity-1.2.3.tgz", change=lambda entries: entries):
        entries = []
        for path, data in sorted(files.items()):
            entry = tarfile.TarInfo("package/" + path)
            entry.size, entry.mtime = len(data), 499162500
            entries.append((entry, data))
        with tempfile.TemporaryDirectory() as folder:
            archive_name = os.path.join(folder, name)
            with tarfile.open(archive_name, "w:gz", format=tarfile.USTAR_FORMAT) as archive:
                for entry, data in change(entries):
                    archive.addfile(entry, io.BytesIO(data))
            done = subprocess.run([sys.executable, "-B", os.path.join(REPOSITORY, "Scripts~/package/check-package"), archive_name,
                                   *options], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def assert_fault(self, files, sentence, count=1, **how):
        status, text = self.run_on(files, **how)
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
        files["package.json"] = json.dumps({"name": "org.quickses.unity", "version": "1.2.3",
                                            "samples": [{"path": "Samples~/Player"}]}).encode()
        files["Samples~/Player/A.cs"] = b""
        files["Samples~/Player/A.cs.meta"] = meta(21, "MonoImporter")
        self.assertEqual(self.run_on(files)[0], 0)
        files["Samples~/Player/A.cs.meta"] = meta(3, "MonoImporter")
        self.assert_fault(files, "Samples~/Player/A.cs.meta: same guid as UnityPackage/Runtime.meta")

    def test_sample_that_is_not_there(self):
        files = self.right_package()
        files["package.json"] = json.dumps({"name": "org.quickses.unity", "version": "1.2.3",
                                            "samples": [{"path": "Samples~/Player"}]}).encode()
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
            done = subprocess.run([sys.executable, "-B", os.path.join(REPOSITORY, "Scripts~/package/check-package"), file.name],
                                  capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertNotIn("Traceback", done.stderr)

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
        files[LINUX + "libgomp.so"] = self.tbb
        files[LINUX + "libgomp.so.meta"] = re.sub(rb"guid: .*", b"guid: " + b"a" * 32, files[LINUX + "libquickses.so.meta"])
        self.assert_fault(files, LINUX + "libgomp.so: doesn't belong in the package")

    def test_library_that_is_missing_beside(self):
        files = self.right_package()
        del files[LINUX + "libquickses_tbb.so"], files[LINUX + "libquickses_tbb.so.meta"]
        self.assert_fault(files, "libquickses.so: needs libquickses_tbb.so, which isn't beside it")

    def test_no_library(self):
        self.assert_library_fault(b"version https://git-lfs.github.com/spec/v1\n", "is no shared library of Linux")

    def test_needs_what_is_not_on_every_machine(self):
        for name in ("libtbb.so.12", "libgomp.so.1", "libstdc++.so.6", "libcudart.so.12"):
            other = built(COMPILER, "void other(void) {}", "-fPIC", f"-Wl,-soname,{name}")
            self.assert_library_fault(built_beside(other, name, self.source, *self.linux), f"needs {name}")

    def test_symbol_that_the_header_does_not_declare(self):
        self.assert_library_fault(built(COMPILER, self.source + "void inflate(void) {}", *self.linux),
                                  "exports inflate, which the header doesn't declare")

    def test_symbol_that_is_missing(self):
        source = re.sub(r"void qses_compute\(void\) {}\n", "", self.source)
        self.assert_library_fault(built(COMPILER, source, *self.linux), "doesn't export qses_compute")

    def test_absolute_rpath(self):
        for tags in ("--enable-new-dtags", "--disable-new-dtags"):
            library = built(COMPILER, self.source, *self.linux, f"-Wl,{tags}", "-Wl,-rpath,$ORIGIN:/opt/lib")
            self.assert_library_fault(library, "looks for libraries in /opt/lib")

    def test_no_rpath(self):
        library = built_beside(self.tbb, "libquickses_tbb.so", self.source, *self.linux)
        self.assert_library_fault(library, "doesn't look for libraries in its own folder")

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
        library = built_beside(other, "libc.so.6", source, *self.linux, "-nostdlib")
        self.assert_library_fault(library, "needs GLIBC_2.36; 2.35 is the newest allowed")

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

    def test_dll_that_exports_something_else(self):
        if not self.dll:
            self.skipTest("no MinGW")
        self.assert_library_fault(built(MINGW, self.source + "void inflate(void) {}"),
                                  "exports inflate, which the header doesn't declare", WINDOWS + "quickses.dll")


if __name__ == "__main__":
    REPOSITORY, COMPILER = os.path.abspath(sys.argv.pop(1)), sys.argv.pop(1)
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        MINGW = sys.argv.pop(1)
    unittest.main()
