# SPDX-License-Identifier: MIT
"""Reads packages: for make-package, verify-package and make-release-branch."""

import hashlib
import json
import os
import tarfile
import zlib

PREFIX = "package/"
PLUGINS = "UnityPackage/Plugins/"


def read(archive):
    """{path below package/: bytes}. Says ValueError of an archive that make-package wouldn't make."""
    files = {}
    try:
        with tarfile.open(archive) as entries:
            for entry in entries:
                if not entry.isfile() or not entry.name.startswith(PREFIX):
                    raise ValueError(f"{archive}: {entry.name} is no file below {PREFIX}")
                files[entry.name[len(PREFIX):]] = entries.extractfile(entry).read()
    except (tarfile.TarError, EOFError, zlib.error) as error:
        raise ValueError(f"{archive}: {error}") from error
    return files


def manifest(archive, files):
    """package.json, which must have a name and a version."""
    try:
        found = json.loads(files["package.json"])
        if all(isinstance(found[key], str) for key in ("name", "version")):
            return found
    except (KeyError, TypeError, ValueError):
        pass
    raise ValueError(f"{archive} has no package.json with a name and a version")


def commit(archive, files):
    """The commit that make-package wrote into package.json: the sources of everything in the package."""
    repository = manifest(archive, files).get("repository")
    revision = repository.get("revision") if isinstance(repository, dict) else None
    if not isinstance(revision, str):
        raise ValueError(f"{archive} names no commit: it was made from a checkout with changes, or without git")
    return revision


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def sums(archive):
    """SHA-256 sums of the archive and of the native libraries in it, as sha256sum writes them and checks them."""
    with open(archive, "rb") as file:
        lines = [f"{sha256(file.read())}  {os.path.basename(archive)}\n"]
    return "".join(lines + [f"{sha256(data)}  {PREFIX}{path}\n" for path, data in sorted(read(archive).items())
                            if path.startswith(PLUGINS) and not path.endswith(".meta")])
