# SPDX-License-Identifier: MIT
"""What .meta files must be like: for check-metas, check-package and make-package."""

import json
import os
import re
import sys

PLUGIN_BINARIES = {".so": "Linux64", ".dll": "Win64"}
NATIVE_SOURCES = {".a", ".bc", ".c", ".cc", ".cpp", ".def", ".h", ".jslib", ".jspre", ".m", ".mm", ".swift"}
TEXT = {".bytes", ".csv", ".html", ".json", ".md", ".txt", ".xml", ".yaml"}
EDITOR_OS = {"Linux64": "Linux", "Win64": "Windows"}


def is_hidden(name):
    lower = name.lower()
    return name.startswith(".") or name.endswith("~") or lower == "cvs" or lower.endswith(".tmp")


def visible_entries(root):
    """Yields (path relative to root, is folder) of all that Unity sees, .meta files included."""
    for folder, subfolders, files in os.walk(root):
        subfolders[:] = sorted(name for name in subfolders if not is_hidden(name))
        for names, is_folder in ((subfolders, True), (sorted(files), False)):
            for name in names:
                if not is_hidden(name):
                    yield os.path.relpath(os.path.join(folder, name), root), is_folder


def expected_importer(path, is_folder):
    """The importer a .meta must name, or None where several are right."""
    extension = os.path.splitext(path)[1].lower()
    if is_folder:
        return "DefaultImporter"
    if path == "package.json":
        return "PackageManifestImporter"
    if extension in PLUGIN_BINARIES or extension in NATIVE_SOURCES:
        return "PluginImporter"
    if extension in TEXT:
        return "TextScriptImporter"
    return {".cs": "MonoImporter", ".asmdef": "AssemblyDefinitionImporter", ".shader": "ShaderImporter",
            ".compute": "ComputeShaderImporter", ".cginc": "ShaderIncludeImporter", ".hlsl": "ShaderIncludeImporter",
            ".mat": "NativeFormatImporter", ".asset": "NativeFormatImporter", ".prefab": "PrefabImporter",
            ".unity": "DefaultImporter"}.get(extension)


def parse_plugin(text):
    """Platform data of a PluginImporter: {platform: {"enabled": "0" or "1", setting: value}}; "" holds the Excludes."""
    platforms = {}
    for block in re.split(r"(?m)^  - first:\n", text)[1:]:
        first = re.match(r"\s+(.*)\n", block).group(1)
        group, _, name = first.partition(":")
        key = "" if not group.strip() else name.strip() or group.strip()
        # Four blanks at most belong to the block's own keys; its settings are deeper.
        data = dict(re.findall(r"(?m)^\s{6,}([\w ]+): ?(.*)$", block))
        platforms[key] = {name.strip(): value.strip() for name, value in data.items()}
    return platforms


def check_plugin(path, text):
    extension = os.path.splitext(path)[1].lower()
    platforms = parse_plugin(text)
    own = PLUGIN_BINARIES.get(extension)
    faults = []
    if "Any" not in platforms or platforms["Any"].get("enabled") != "0":
        faults.append("must not be enabled for any platform")
    for name, data in platforms.items():
        if name in ("", "Any"):
            continue
        expected = "1" if own and name in (own, "Editor") else "0"
        if data.get("enabled") != expected:
            faults.append(f"{name}: enabled is {data.get('enabled')}, not {expected}")
    for setting, value in platforms.get("", {}).items():
        if not setting.startswith("Exclude "):
            continue
        name = setting[len("Exclude "):]
        enabled = platforms.get(name, {}).get("enabled", "0")
        if value == enabled:
            faults.append(f"{setting} is {value} but {name}'s enabled is {enabled}")
    if own:
        for name in (own, "Editor"):
            if name not in platforms:
                faults.append(f"{name} is not listed")
            elif platforms[name].get("CPU") != "x86_64":
                faults.append(f"{name}: CPU is {platforms[name].get('CPU')}, not x86_64")
        if platforms.get("Editor", {}).get("OS") != EDITOR_OS[own]:
            faults.append(f"Editor: OS is {platforms.get('Editor', {}).get('OS')}, not {EDITOR_OS[own]}")
        if not re.search(r"(?m)^  isPreloaded: 0$", text):
            faults.append("isPreloaded must be 0")
    return faults


def check(root, guids=None):
    """Returns (number of visible files and folders, list of faults). guids, {guid: path}, may hold others; it grows."""
    entries = dict(visible_entries(root))
    faults = []
    guids = {} if guids is None else guids
    assets = {path: is_folder for path, is_folder in entries.items() if is_folder or not path.endswith(".meta")}
    for path, is_folder in assets.items():
        if path + ".meta" not in entries:
            faults.append(f"{path}: no .meta")
    for path, is_folder in entries.items():
        if is_folder or not path.endswith(".meta"):
            continue
        asset = path[:-len(".meta")]
        if asset not in assets:
            faults.append(f"{path}: {asset} does not exist")
            continue
        with open(os.path.join(root, path), encoding="utf-8", newline="") as file:
            text = file.read()
        if "\r" in text:
            faults.append(f"{path}: line ends must be LF")
            text = text.replace("\r\n", "\n")
        if not text.startswith("fileFormatVersion: 2\n"):
            faults.append(f"{path}: must begin with fileFormatVersion: 2")
        found = re.findall(r"(?m)^guid: (.*)$", text)
        if len(found) != 1 or not re.fullmatch(r"[0-9a-f]{32}", found[0]):
            faults.append(f"{path}: needs one guid of 32 lower-case hexadecimal digits")
        elif found[0] in guids:
            faults.append(f"{path}: same guid as {guids[found[0]]}")
        else:
            guids[found[0]] = path
        if bool(re.search(r"(?m)^folderAsset: yes$", text)) != assets[asset]:
            faults.append(f"{path}: folderAsset: yes belongs to folders, and only to them")
        importers = re.findall(r"(?m)^(\w+Importer):", text)
        expected = expected_importer(asset, assets[asset])
        if len(importers) != 1:
            faults.append(f"{path}: needs one importer")
        elif expected and importers[0] != expected:
            faults.append(f"{path}: {importers[0]}, but {expected} was expected")
        elif importers[0] == "NativeFormatImporter" and not re.search(r"(?m)^  mainObjectFileID: \d+$", text):
            faults.append(f"{path}: needs a mainObjectFileID")
        elif importers[0] == "PluginImporter":
            faults += [f"{path}: {fault}" for fault in check_plugin(asset, text)]
    return len(assets), faults


def check_package(root):
    """(what was looked at, list of faults), also of the samples in package.json: their folders are copied into projects."""
    guids = {}
    count, faults = check(root, guids)
    with open(os.path.join(root, "package.json"), encoding="utf-8") as file:
        samples = [sample["path"].rstrip("/") for sample in json.load(file).get("samples", [])]
    for sample in samples:
        folder = os.path.join(root, sample)
        if not os.path.isdir(folder):
            faults.append(f"{sample}: package.json lists this sample, but there is no such folder")
        more, found = check(folder, guids)
        count += more
        faults += [f"{sample}/{fault}" for fault in found]
    return f"{count} visible files and folders", faults


def main(arguments, description, check_root):
    """The command of check-metas and check-references. check_root(folder) gives (what was looked at, list of faults)."""
    name = os.path.basename(arguments[0])
    if len(arguments) > 2 or any(argument.startswith("-") for argument in arguments[1:]):
        print(description.strip(), file=sys.stderr)
        return 2
    here = os.path.dirname(os.path.realpath(__file__))
    root = arguments[1] if len(arguments) > 1 else os.path.dirname(os.path.dirname(here))
    if not os.path.isfile(os.path.join(root, "package.json")):
        print(f"{name}: {root} has no package.json", file=sys.stderr)
        return 2
    looked_at, faults = check_root(root)
    for fault in faults:
        print(fault)
    print(f"{name}: {looked_at}, {len(faults)} faults")
    return 1 if faults else 0
