# SPDX-License-Identifier: MIT
"""Reads the files in which Unity keeps scenes, prefabs, materials and other assets: the part of YAML that it writes.

A file is a list of documents, each one object: a class number, a file ID that is unique in the file, and its fields.
Maps become dicts, sequences lists, and everything else strings; an empty value is "".
"""

import re

HEADER = "%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n"
DOCUMENT = re.compile(r"--- !u!(\d+) &(-?\d+)( stripped)?$")
KEY = re.compile(r"([^\s:{\[\"'-][^:{\[]*?|-?\w[^:]*?):(?: (.*))?$")


class UnityYamlError(Exception):
    """The text isn't what Unity writes."""


class UnityObject:
    """One object of a file: class_id, file_id, type_name such as "Transform", fields, line (from 1), is_stripped."""

    def __init__(self, class_id, file_id, is_stripped, line):
        self.class_id = class_id
        self.file_id = file_id
        self.is_stripped = is_stripped
        self.line = line
        self.type_name = ""
        self.fields = {}


def read_objects(text):
    """All objects of a file, in its order."""
    if not text.startswith(HEADER):
        raise UnityYamlError("must begin with %YAML 1.1 and the tag of unity3d.com")
    lines = text.split("\n")
    starts = [number for number, line in enumerate(lines) if line.startswith("--- ")] + [len(lines)]
    objects = []
    for start, end in zip(starts, starts[1:]):
        match = DOCUMENT.match(lines[start])
        if not match:
            raise UnityYamlError(f"line {start + 1}: not the head of a document: {lines[start]}")
        found = UnityObject(int(match.group(1)), int(match.group(2)), bool(match.group(3)), start + 1)
        body = _Block(lines, start + 1, end).read()
        if not isinstance(body, dict) or len(body) != 1:
            raise UnityYamlError(f"line {start + 1}: one object was expected")
        (found.type_name, found.fields), = body.items()
        found.fields = found.fields or {}
        objects.append(found)
    return objects


class _Block:
    """The lines of one document. Nesting is by indentation; sequences stand at the indentation of their key."""

    def __init__(self, lines, start, end):
        self.lines = lines
        self.at = start
        self.end = end

    def read(self):
        self._skip_blank()
        value = self._value(self._indentation())
        self._skip_blank()
        if self.at < self.end:
            raise UnityYamlError(f"line {self.at + 1}: unexpected: {self.lines[self.at].strip()}")
        return value

    def _skip_blank(self):
        while self.at < self.end and not self.lines[self.at].strip():
            self.at += 1

    def _indentation(self):
        if self.at >= self.end:
            return -1
        line = self.lines[self.at]
        return len(line) - len(line.lstrip(" "))

    def _is_item(self):
        return self.lines[self.at].lstrip(" ").startswith("- ")

    def _value(self, indentation):
        if self.at < self.end and self._is_item():
            return self._sequence(indentation)
        return self._map(indentation)

    def _map(self, indentation):
        fields = {}
        while self.at < self.end and self._indentation() == indentation and not self._is_item():
            line = self.lines[self.at].strip()
            match = KEY.match(line + " " if line.endswith(":") else line)
            if not match:
                raise UnityYamlError(f"line {self.at + 1}: no key: {line}")
            key, rest = match.group(1), (match.group(2) or "").strip()
            if key in fields:
                raise UnityYamlError(f"line {self.at + 1}: {key} a second time")
            self.at += 1
            fields[key] = self._inline(rest, indentation) if rest else self._nested(indentation)
            self._skip_blank()
        return fields

    def _nested(self, indentation):
        """What follows a key without a value: a deeper map, a sequence, or nothing."""
        self._skip_blank()
        if self.at >= self.end:
            return ""
        inner = self._indentation()
        if inner > indentation or (inner == indentation and self._is_item()):
            return self._value(inner)
        return ""

    def _sequence(self, indentation):
        items = []
        while self.at < self.end and self._indentation() == indentation and self._is_item():
            line = self.lines[self.at]
            rest = line[indentation + 2:]
            if KEY.match(rest.strip() + (" " if rest.strip().endswith(":") else "")) and rest.strip()[0] not in "{[":
                self.lines[self.at] = " " * (indentation + 2) + rest  # a map that begins on the line of the dash
                items.append(self._map(indentation + 2))
            else:
                self.at += 1
                items.append(self._inline(rest.strip(), indentation))
            self._skip_blank()
        return items

    def _inline(self, text, indentation):
        # Long values go on in deeper lines.
        while self.at < self.end and self.lines[self.at].strip() and self._indentation() > indentation:
            text += " " + self.lines[self.at].strip()
            self.at += 1
        value, rest = _flow(text)
        if rest.strip():
            raise UnityYamlError(f"line {self.at}: unexpected: {rest.strip()}")
        return value


def _flow(text):
    """Reads {a: 1, b: {c: 2}}, [1, 2], "quoted", or a plain text to its end. Returns (value, what follows it)."""
    if text.startswith("{"):
        fields, rest = {}, text[1:].lstrip()
        while not rest.startswith("}"):
            key, colon, rest = rest.partition(":")
            if not colon:
                raise UnityYamlError(f"a brace is not closed: {text}")
            fields[key.strip()], rest = _flow_item(rest.lstrip())
        return fields, rest[1:]
    if text.startswith("["):
        items, rest = [], text[1:].lstrip()
        while not rest.startswith("]"):
            if not rest:
                raise UnityYamlError(f"a bracket is not closed: {text}")
            value, rest = _flow_item(rest)
            items.append(value)
        return items, rest[1:]
    quoted = re.match(r"\"((?:[^\"\\]|\\.)*)\"|'((?:[^']|'')*)'", text)
    if quoted:
        return quoted.group(1) if quoted.group(1) is not None else quoted.group(2), text[quoted.end():]
    return text, ""


def _flow_item(text):
    """One value between the commas of a map or list in braces."""
    if text[:1] in ("{", "[", '"', "'"):
        value, rest = _flow(text)
    else:
        value, rest = re.match(r"([^,}\]]*)(.*)$", text, re.S).groups()
        value = value.strip()
    rest = rest.lstrip()
    if rest.startswith(","):
        return value, rest[1:].lstrip()
    if rest[:1] not in ("}", "]"):
        raise UnityYamlError(f"a comma or a closing bracket is missing: {text}")
    return value, rest
