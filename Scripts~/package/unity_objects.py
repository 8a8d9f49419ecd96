# SPDX-License-Identifier: MIT
"""What objects in scenes, prefabs, materials and assets may refer to: for check-references."""

import os
import re

from script_fields import FieldCheck
from unity_yaml import UnityYamlError, read_objects

EXTENSIONS = {".unity", ".prefab", ".mat", ".asset"}

# Class numbers of the objects that occur here, from https://docs.unity3d.com/Manual/ClassIDReference.html.
CLASSES = {1: "GameObject", 4: "Transform", 20: "Camera", 21: "Material", 23: "MeshRenderer",
           29: "OcclusionCullingSettings", 33: "MeshFilter", 81: "AudioListener", 104: "RenderSettings", 108: "Light",
           114: "MonoBehaviour", 157: "LightmapSettings", 196: "NavMeshSettings", 1001: "PrefabInstance"}

# Unity's own assets that a file may refer to: {GUID: {file ID: name}}.
BUILT_IN = {
    "0000000000000000f000000000000000": {46: "Shader Standard", 10303: "Default-Material", 10304: "Default-Skybox"},
    "0000000000000000e000000000000000": {10001: "Soft", 10202: "Cube", 10207: "Sphere"},
}

# File ID and type of what an importer makes of a file; what Unity writes itself is type 2, what it imports type 3.
IMPORTED = {".cs": (11500000, "MonoScript"), ".shader": (4800000, "Shader"), ".bytes": (4900000, "TextAsset"),
            ".txt": (4900000, "TextAsset"), ".json": (4900000, "TextAsset"), ".md": (4900000, "TextAsset"),
            ".xml": (4900000, "TextAsset"), ".csv": (4900000, "TextAsset")}


def is_reference(value):
    return isinstance(value, dict) and "fileID" in value


def references_in(value, place=""):
    """Yields (place, reference) of all references below a value."""
    if is_reference(value):
        yield place, value
    elif isinstance(value, dict):
        for key, inner in value.items():
            yield from references_in(inner, f"{place}.{key}" if place else key)
    elif isinstance(value, list):
        for number, inner in enumerate(value):
            yield from references_in(inner, f"{place}[{number}]")


def shader_properties(text):
    """Names in the Properties block of a shader."""
    block = re.search(r"(?m)^\s*Properties\s*\{(.*?)^\s*\}", text, re.S)
    without_comments = re.sub(r"//[^\n]*", "", block.group(1)) if block else ""
    return set(re.findall(r"(?m)^\s*(?:\[[^\]]*\]\s*)*(\w+)\s*\(", without_comments))


class Package:
    """All files with objects, checked: reference_count, faults."""

    def __init__(self, guids, files, types, shaders):
        self.guids = guids
        self.types = types
        self.shaders = shaders
        self.reference_count = 0
        self.faults = []
        self.objects = {}  # {path: {file ID: object}}
        for path, text in files.items():
            self._read(path, text)
        for path, objects in self.objects.items():
            File(self, path, objects).check()

    def _read(self, path, text):
        self.objects[path] = {}
        try:
            for found in read_objects(text):
                if found.file_id in self.objects[path]:
                    self.faults.append(f"{path}:{found.line}: file ID {found.file_id} a second time")
                self.objects[path][found.file_id] = found
        except UnityYamlError as error:
            self.faults.append(f"{path}: {error}")


class File:
    """The objects of one file."""

    def __init__(self, package, path, objects):
        self.package = package
        self.path = path
        self.objects = objects

    def fault(self, found, sentence):
        self.package.faults.append(f"{self.path}:{found.line}: {found.type_name}: {sentence}")

    def check(self):
        for found in self.objects.values():
            self._check_class(found)
            is_right = True
            for place, reference in references_in(found.fields):
                self.package.reference_count += 1
                sentence = self._fault_of_reference(reference)
                if sentence:
                    is_right = False
                    self.fault(found, f"{place}: {sentence}")
            if not is_right or found.is_stripped:
                continue  # links and types are told once references are right
            if found.type_name == "GameObject":
                self._check_components(found)
            elif "m_GameObject" in found.fields:
                self._check_owner(found)
            if found.type_name == "Transform":
                self._check_family(found)
            elif found.type_name == "MonoBehaviour":
                FieldCheck(self, found).check()
            elif found.type_name == "Material":
                self._check_material(found)
        self._check_roots()

    def target(self, reference):
        """What a right reference leads to: the name of a type or, for nothing, ""."""
        guid, file_id = reference.get("guid"), int(reference["fileID"])
        if file_id == 0:
            return ""
        if guid in BUILT_IN:
            return BUILT_IN[guid][file_id]
        path = self.path if guid is None else self.package.guids[guid]
        extension = os.path.splitext(path)[1]
        if extension in IMPORTED:
            return IMPORTED[extension][1]
        found = self.package.objects[path][file_id]
        return self.script_name(found) or found.type_name

    def script_name(self, found):
        """Of a MonoBehaviour: the name of its class, which is that of its file."""
        path = self.package.guids.get(found.fields.get("m_Script", {}).get("guid", ""), "")
        return os.path.splitext(os.path.basename(path))[0]

    def _check_class(self, found):
        name = CLASSES.get(found.class_id)
        if name is None:
            self.fault(found, f"class {found.class_id} is not known to this check")
        elif name != found.type_name:
            self.fault(found, f"class {found.class_id} is {name}")

    def _fault_of_reference(self, reference):
        """What is wrong with it, or None."""
        guid, kind = reference.get("guid"), reference.get("type")
        if not re.fullmatch(r"-?\d+", str(reference["fileID"])):
            return f"file ID {reference['fileID']} is not a number"
        file_id = int(reference["fileID"])
        if guid is None:
            return None if file_id == 0 or file_id in self.objects else f"no object {file_id} in this file"
        if guid in BUILT_IN:
            if file_id not in BUILT_IN[guid]:
                return f"file ID {file_id} of Unity's own {guid} is not known to this check"
            return None if kind == "0" else f"type {kind}, but Unity's own assets have type 0"
        if guid not in self.package.guids:
            return f"no .meta has the GUID {guid}"
        path = self.package.guids[guid]
        extension = os.path.splitext(path)[1]
        if extension in IMPORTED:
            expected, expected_kind = IMPORTED[extension][0], "3"
        elif extension in EXTENSIONS:
            if file_id not in self.package.objects.get(path, {}):
                return f"no object {file_id} in {path}"
            expected, expected_kind = file_id, "3" if extension == ".prefab" else "2"
        else:
            return f"{path} is nothing that can be referred to"
        if file_id != expected:
            return f"file ID {file_id}, but that of {path} is {expected}"
        return None if kind == expected_kind else f"type {kind}, but that of {path} is {expected_kind}"

    def _check_components(self, found):
        ids = [int(item["component"]["fileID"]) for item in found.fields.get("m_Component") or []]
        components = [self.objects.get(file_id) for file_id in ids]
        if len(set(ids)) != len(ids):
            self.fault(found, "names a component twice")
        for file_id, component in zip(ids, components):
            if component is None or int(component.fields.get("m_GameObject", {}).get("fileID", 0)) != found.file_id:
                self.fault(found, f"component {file_id} does not name it as its m_GameObject")
        names = [component.type_name for component in components if component]
        if names[:1] != ["Transform"] or names.count("Transform") != 1:
            self.fault(found, "its first component, and no other one, must be its Transform")
        present = set(names) | {self.script_name(component) for component in components if component}
        for component in components:
            script = self.package.types.get(self.script_name(component)) if component else None
            for required in re.findall(r"typeof\(\s*([\w.]+)\s*\)", requirements_of(script)):
                if required.split(".")[-1] not in present:
                    self.fault(found, f"{script.name} requires a {required} beside it")

    def _check_owner(self, found):
        owner = self.objects.get(int(found.fields["m_GameObject"]["fileID"]))
        if owner is None:
            if found.type_name != "MonoBehaviour":  # one without is an asset
                self.fault(found, "has no GameObject")
        elif owner.type_name != "GameObject":
            self.fault(found, f"its m_GameObject is a {owner.type_name}")
        elif found.file_id not in [int(item["component"]["fileID"]) for item in owner.fields.get("m_Component") or []]:
            self.fault(found, f"its GameObject {owner.file_id} does not name it among its components")

    def _check_family(self, found):
        father = self.objects.get(int(found.fields["m_Father"]["fileID"]))
        if father is not None and found.file_id not in children_of(father):
            self.fault(found, f"its father {father.file_id} does not name it among its children")
        for order, file_id in enumerate(children_of(found)):
            child = self.objects[file_id]
            if child.type_name != "Transform" or int(child.fields["m_Father"]["fileID"]) != found.file_id:
                self.fault(found, f"child {file_id} does not name it as its father")
            elif int(child.fields.get("m_RootOrder", order)) != order:
                self.fault(child, f"m_RootOrder {child.fields['m_RootOrder']}, but it is child {order}")

    def _check_roots(self):
        orders = {}
        for found in self.objects.values():
            if found.type_name == "Transform" and found.fields.get("m_Father", {}).get("fileID") == "0":
                order = found.fields.get("m_RootOrder", "0")
                if order in orders:
                    self.fault(found, f"m_RootOrder {order} is that of {orders[order]} as well")
                orders[order] = found.file_id

    def _check_material(self, found):
        path = self.package.guids.get(found.fields["m_Shader"].get("guid", ""), "")
        if path not in self.package.shaders:
            return
        known = shader_properties(self.package.shaders[path])
        for group in ("m_TexEnvs", "m_Ints", "m_Floats", "m_Colors"):
            for item in found.fields["m_SavedProperties"].get(group) or []:
                for name in item:
                    if name not in known:
                        self.fault(found, f"{path} has no property {name}")


def children_of(transform):
    return [int(item["fileID"]) for item in transform.fields.get("m_Children") or []]


def requirements_of(script):
    """The arguments of a class's RequireComponent attributes."""
    return " ".join(re.findall(r"RequireComponent\s*\((.*?\))\s*\)", script.attributes, re.S)) if script else ""
