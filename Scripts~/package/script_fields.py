# SPDX-License-Identifier: MIT
"""Whether what a file sets in a script's fields suits the C# class: for check-references."""

import re

OF_THE_ENGINE = {"m_ObjectHideFlags", "m_CorrespondingSourceObject", "m_PrefabInstance", "m_PrefabAsset",
                 "m_GameObject", "m_Enabled", "m_EditorHideFlags", "m_Script", "m_Name", "m_EditorClassIdentifier"}
INTEGERS = {"sbyte", "byte", "short", "ushort", "int", "uint", "long", "ulong", "LayerMask"}
STRUCTS = {"Vector2": {"x", "y"}, "Vector3": {"x", "y", "z"}, "Vector4": {"x", "y", "z", "w"},
           "Quaternion": {"x", "y", "z", "w"}, "Color": {"r", "g", "b", "a"}, "Color32": {"serializedVersion", "rgba"},
           "Rect": {"serializedVersion", "x", "y", "width", "height"}}
# What a field of such a type may also refer to.
KINDS = {"Component": None, "Behaviour": None, "Object": None, "MonoBehaviour": None,
         "Renderer": {"MeshRenderer"}}


class FieldCheck:
    """The fields of one MonoBehaviour in a file."""

    def __init__(self, file, found):
        self.file = file
        self.found = found
        self.types = file.package.types

    def check(self):
        name = self.file.script_name(self.found)
        script = self.types.get(name)
        if self.file.target(self.found.fields["m_Script"]) != "MonoScript":
            self._fault("m_Script is not a script")
        elif script is None or script.kind != "class":
            self._fault(f"{name}.cs has no class {name}")
        elif not self._is_a(name, {"MonoBehaviour", "ScriptableObject"}):
            self._fault(f"{name} is neither a MonoBehaviour nor a ScriptableObject")
        else:
            values = {key: value for key, value in self.found.fields.items() if key not in OF_THE_ENGINE}
            self._check_fields(name, values, "")

    def _fault(self, sentence):
        self.file.fault(self.found, sentence)

    def _is_a(self, name, ancestors):
        return name in ancestors or any(self._is_a(base, ancestors) for base in self._bases(name))

    def _bases(self, name):
        return self.types[name].bases if name in self.types else []

    def _serialized(self, name):
        """{name, also former ones: field} of a type and those it is derived from."""
        fields = {}
        for base in self._bases(name):
            fields.update(self._serialized(base))
        for field in self.types[name].fields if name in self.types else []:
            fields.update({known: field for known in [field.name, *field.former_names]})
        return fields

    def _check_fields(self, name, values, place):
        fields = self._serialized(name)
        for key, value in values.items():
            if key == "serializedVersion":
                continue
            if key not in fields:
                self._fault(f"{place}{key}: {name} has no serialised field of this name")
            else:
                self._check_value(fields[key].type_name.rstrip("?"), value, place + key)

    def _check_value(self, type_name, value, place):
        element = re.fullmatch(r"(?:(.+)\[\]|List<(.+)>)", type_name)
        if element:
            self._check_list(element.group(1) or element.group(2), value, place)
            return
        type_name = type_name.split(".")[-1]
        known = self.types.get(type_name)
        if type_name in INTEGERS or type_name in ("bool", "float", "double"):
            self._check_number(type_name, value, place)
        elif type_name in ("string", "char"):
            if not isinstance(value, str):
                self._fault(f"{place}: not a {type_name}")
        elif type_name in STRUCTS:
            if not isinstance(value, dict) or set(value) != STRUCTS[type_name]:
                self._fault(f"{place}: not a {type_name}")
        elif known is not None and known.kind == "enum":
            is_value = isinstance(value, str) and value in {str(number) for number in known.values.values()}
            if not is_value and "Flags" not in known.attributes:
                self._fault(f"{place}: {value} is no value of {type_name}")
        elif known is not None and "Serializable" in known.attributes and not self._is_a(type_name, {"MonoBehaviour"}):
            if not isinstance(value, dict):
                self._fault(f"{place}: not a {type_name}")
            else:
                self._check_fields(type_name, value, place + ".")
        else:
            self._check_reference(type_name, value, place)

    def _check_list(self, element, value, place):
        is_packed = element in INTEGERS | {"bool"}  # written as hexadecimal digits
        if isinstance(value, str):
            if not re.fullmatch(r"([0-9a-f]{2})*", value) if is_packed else value != "":
                self._fault(f"{place}: not a list of {element}")
        elif not isinstance(value, list) or is_packed and value:
            self._fault(f"{place}: not a list of {element}")
        else:
            for number, item in enumerate(value):
                self._check_value(element, item, f"{place}[{number}]")

    def _check_number(self, type_name, value, place):
        pattern = {"bool": r"[01]", "float": r"-?[\d.]+(e[-+]?\d+)?", "double": r"-?[\d.]+(e[-+]?\d+)?"}
        if not isinstance(value, str) or not re.fullmatch(pattern.get(type_name, r"-?\d+"), value):
            self._fault(f"{place}: {value} is not a {type_name}")

    def _check_reference(self, type_name, value, place):
        if not isinstance(value, dict) or "fileID" not in value:
            self._fault(f"{place}: not a reference to a {type_name}")
            return
        target = self.file.target(value)
        allowed = KINDS.get(type_name, {type_name})
        if target and allowed is not None and target not in allowed and not self._is_a(target, allowed):
            self._fault(f"{place}: refers to a {target}, not a {type_name}")
