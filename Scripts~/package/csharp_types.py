# SPDX-License-Identifier: MIT
"""Reads from C# sources what Unity serialises: the fields of classes and structs, and the values of enums.

No compiler: it knows the C# that is in this package. Types are looked up by their plain names.
"""

import re

TOKEN = re.compile(r"""//[^\n]*|/\*.*?\*/|@"(?:[^"]|"")*"|\$?"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)+'|^\s*\#[^\n]*""",
                   re.S | re.M)
DECLARATION = re.compile(r"\b(class|struct|enum|interface)\s+(\w+)(?:\s*<[^>]*>)?\s*(?::\s*([^{]*))?$", re.S)
FIELD = re.compile(r"\s*((?:\w+\s+)*?)([\w.]+(?:\s*<[^()]*>)?(?:\s*\[[\s,]*\])*\??)\s+(\w+)\s*", re.S)
MODIFIERS = {"public", "private", "protected", "internal", "static", "readonly", "const", "volatile", "new", "unsafe"}


class CSharpField:
    """A field that Unity serialises: name, type as written, names it had before (FormerlySerializedAs)."""

    def __init__(self, name, type_name, former_names):
        self.name = name
        self.type_name = type_name
        self.former_names = former_names


class CSharpType:
    """A class, struct or enum, all its parts together."""

    def __init__(self, kind, name):
        self.kind = kind
        self.name = name
        self.bases = []
        self.attributes = ""
        self.fields = []
        self.values = {}  # of an enum: {name: number, or None where it isn't a plain number}
        self.paths = set()


def without_comments(source):
    """The source without comments and preprocessor lines; strings stay."""
    return TOKEN.sub(lambda match: match.group() if match.group().lstrip()[:1] in "\"'@$" else " ", source)


def read_types(sources):
    """{name: CSharpType} of {path: text}."""
    types = {}
    for path, source in sources.items():
        _read_members(without_comments(source), path, types, None)
    return types


def _matching(text, start, opening, closing):
    """The place after the bracket that closes the one at start."""
    depth, at = 0, start
    while at < len(text):
        quoted = TOKEN.match(text, at) if text[at] in "\"'@$" else None
        if quoted:
            at = quoted.end()
            continue
        depth += (text[at] == opening) - (text[at] == closing)
        at += 1
        if depth == 0:
            return at
    return len(text)


def _read_members(text, path, types, owner):
    """Members of a file or namespace (owner None) or of a type."""
    at = start = 0
    while at < len(text):
        char = text[at]
        quoted = TOKEN.match(text, at) if char in "\"'@$" else None
        if quoted:
            at = quoted.end()
        elif char in "([":
            at = _matching(text, at, char, ")" if char == "(" else "]")
        elif char == "{":
            head, end = text[start:at], _matching(text, at, "{", "}")
            if re.search(r"=\s*(new\b[^;{]*)?$", head):  # the value of a field goes on to its semicolon
                at = end
                continue
            _read_block(head, text[at + 1:end - 1], path, types)
            at = start = end
        elif char == ";":
            if owner is not None:
                _add_field(text[start:at], owner)
            at += 1
            start = at
        else:
            at += 1


def _read_block(head, body, path, types):
    attributes, declaration = _split_attributes(head)
    if re.search(r"\bnamespace\s+[\w.]+\s*$", declaration):
        _read_members(body, path, types, None)
        return
    match = DECLARATION.search(declaration)
    if not match or "(" in declaration:
        return  # a method or property
    kind, name, bases = match.groups()
    found = types.setdefault(name, CSharpType(kind, name))
    found.paths.add(path)
    found.attributes += attributes
    bases = re.sub(r"<[^>]*>", "", bases or "").split(",")
    found.bases += [base.strip().split(".")[-1] for base in bases if base.strip()]
    if kind == "enum":
        found.values.update(_enum_values(body))
    else:
        _read_members(body, path, types, found)


def _split_attributes(text):
    """("[A][B(1)]", what follows them)."""
    at = 0
    while True:
        while at < len(text) and text[at].isspace():
            at += 1
        if at >= len(text) or text[at] != "[":
            return text[:at], text[at:]
        at = _matching(text, at, "[", "]")


def _add_field(statement, owner):
    attributes, rest = _split_attributes(statement)
    declaration = re.split(r"=(?!>)", rest, maxsplit=1)[0]
    match = FIELD.fullmatch(declaration)
    if not match or "=>" in rest:
        return
    modifiers, type_name, name = set(match.group(1).split()), match.group(2), match.group(3)
    if not modifiers <= MODIFIERS or modifiers & {"static", "readonly", "const"} or type_name in ("event", "using"):
        return
    if "NonSerialized" in attributes if "public" in modifiers else "SerializeField" not in attributes:
        return
    former = re.findall(r"FormerlySerializedAs\(\s*\"(\w+)\"", attributes)
    owner.fields.append(CSharpField(name, type_name.replace(" ", ""), former))


def _enum_values(body):
    values, last = {}, -1
    for item in body.split(","):
        name, equals, number = _split_attributes(item)[1].partition("=")
        if not name.strip():
            continue
        try:
            last = int(number.strip(), 0) if equals else None if last is None else last + 1
        except ValueError:
            last = None
        values[name.strip()] = last
    return values
