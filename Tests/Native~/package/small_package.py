# SPDX-License-Identifier: MIT
"""For tests of the scripts that make and check packages: a small package without faults, with libraries of empty functions."""

import io
import json
import os
import re
import subprocess
import tarfile
import tempfile

LINUX = "UnityPackage/Plugins/linux-x86_64/"
WINDOWS = "UnityPackage/Plugins/windows-x86_64/"
MANIFEST = {"name": "org.quickses.unity", "version": "1.2.3",
            "repository": {"type": "git", "url": "https://quickses.test/quickses.git"}}
DOCUMENTS = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE.md", "SECURITY.md", "Third Party Notices.md")


def meta(number, importer, folder=False):
    return (f"fileFormatVersion: 2\nguid: {number:032x}\n" + ("folderAsset: yes\n" if folder else "") +
            f"{importer}:\n  externalObjects: {{}}\n  userData: \n  assetBundleName: \n  assetBundleVariant: \n").encode()


def manifest(**changes):
    return json.dumps({**MANIFEST, **changes}).encode()


def sources():
    """{path: bytes} of what a package has without native libraries."""
    files = {"package.json": manifest(), "package.json.meta": meta(1, "PackageManifestImporter"),
             "Documentation~/index.md": b"# Manual\n", "UnityPackage.meta": meta(2, "DefaultImporter", folder=True),
             "UnityPackage/Runtime.meta": meta(3, "DefaultImporter", folder=True),
             "UnityPackage/Runtime/Core.meta": meta(4, "DefaultImporter", folder=True),
             "UnityPackage/Runtime/Core/QuickSes.Core.asmdef": b"{}",
             "UnityPackage/Runtime/Core/QuickSes.Core.asmdef.meta": meta(5, "AssemblyDefinitionImporter")}
    for number, name in enumerate(DOCUMENTS, 6):
        files[name] = b"## [1.2.3] - 2026-01-31\n" if name == "CHANGELOG.md" else b"text\n"
        files[name + ".meta"] = meta(number, "TextScriptImporter")
    return files


def write_archive(name, files, change=lambda entries: entries):
    """As make-package writes it; change: makes other entries of [(TarInfo, bytes)]."""
    entries = []
    for path, data in sorted(files.items()):
        entry = tarfile.TarInfo("package/" + path)
        entry.size, entry.mtime = len(data), 499162500
        entries.append((entry, data))
    with tarfile.open(name, "w:gz", format=tarfile.USTAR_FORMAT) as archive:
        for entry, data in change(entries):
            archive.addfile(entry, io.BytesIO(data))


def write_folder(folder, files):
    for path, data in files.items():
        full = os.path.join(folder, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, "wb") as file:
            file.write(data)


def built(compiler, source, *options):
    """The bytes of a shared library."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "library.bin")
        subprocess.run([compiler, "-shared", "-o", path, "-x", "c", "-", "-x", "none", *options], input=source,
                       text=True, check=True)
        with open(path, "rb") as file:
            return file.read()


class SmallPackage:
    """The libraries; mingw: "" where there is no such compiler, and then no quickses.dll."""

    def __init__(self, repository, compiler, mingw):
        self.repository, self.compiler, self.mingw = repository, compiler, mingw
        names = []
        for header in ("quickses.h", "quickses_gpu.h"):
            path = os.path.join(repository, "NativePlugin/Source~/include/quickses", header)
            with open(path, encoding="utf-8") as file:
                names += re.findall(r"QSES_API [^;(]*[ *](qses_[a-z0-9_]+)\(", file.read())
        self.source = "".join(f"void {name}(void) {{}}\n" for name in names)
        self.linux = ("-fPIC", "-nostartfiles", "-Wl,-soname,libquickses.so")
        self.good = built(compiler, self.source, *self.linux)
        self.dll = built(mingw, self.source) if mingw else None

    def built_beside(self, other, name, source, *options):
        """A library that is linked to another one of the given bytes and name."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, name)
            with open(path, "wb") as file:
                file.write(other)
            return built(self.compiler, source, *options, "-Wl,--no-as-needed", path)

    def files(self):
        """{path: bytes}"""
        def template(name):
            with open(os.path.join(self.repository, "NativePlugin/Source~/plugin_metas", name), "rb") as file:
                return file.read()

        files = {**sources(), "UnityPackage/Plugins.meta": template("Plugins.meta"),
                 "UnityPackage/Plugins/linux-x86_64.meta": template("linux-x86_64.meta"),
                 LINUX + "libquickses.so": self.good,
                 LINUX + "libquickses.so.meta": template("linux-x86_64/libquickses.so.meta")}
        if self.dll:
            files["UnityPackage/Plugins/windows-x86_64.meta"] = template("windows-x86_64.meta")
            files[WINDOWS + "quickses.dll"] = self.dll
            files[WINDOWS + "quickses.dll.meta"] = template("windows-x86_64/quickses.dll.meta")
        return files
