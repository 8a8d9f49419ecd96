# SPDX-License-Identifier: MIT
"""Reads from C# sources what Unity serialises, for check-references. No compiler: it knows the C# of this package, where
serialised fields are private with [SerializeField] and stand before nested types. Types have different plain names."""

import re

LITERAL = r"""@"(?:[^"]|"")*"|\$?"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)+'"""
COMMENT = r"//[^\n]*|/\*.*?\*/|^\s*#[^\n]*"
ATTRIBUTES = r"(?:\[[^\]]*\]\s*)*"
TYPE = re.compile(rf"({ATTRIBUTES})(?:\b\w+\s+)*?\b(class|struct|enum)\s+(\w+)\s*(?::\s*([^{{]*))?\{{")
FIELD = re.compile(rf"\[SerializeField\b[^\]]*\]\s*{ATTRIBUTES}(?:private|protected)\s+([\w.]+(?:<[\w.]+>|\[\])?)\s+(\w+)")


class CSharpType:
    """A class, struct or enum, all its parts together."""

    def __init__(self, kind):
        self.kind = kind
        self.attributes = ""
        self.bases = set()
        self.fields = {}  # {name: type as written}
        self.values = set()  # of an enum, as written in scenes


def without_comments(source):
    """The source without comments and preprocessor lines; strings stay."""
    return re.sub(f"{LITERAL}|{COMMENT}", lambda match: match.group() if match.group()[0] in "\"'@$" else " ", source,
                  flags=re.S | re.M)


def read_types(sources):
    """{name: CSharpType} of texts."""
    types = {}
    for source in sources:
        plain = re.sub(LITERAL, '""', without_comments(source))
        found = list(TYPE.finditer(plain))
        for match, end in zip(found, [later.start() for later in found[1:]] + [len(plain)]):
            attributes, kind, name, bases = match.groups()
            read = types.setdefault(name, CSharpType(kind))
            read.attributes += attributes
            read.bases |= {base.strip() for base in (bases or "").split(",")}
            read.fields.update({field: type_name for type_name, field in FIELD.findall(plain, match.end(), end)})
            if kind == "enum":
                read.values |= _enum_values(plain[match.end():plain.index("}", match.end())])
    return types


def _enum_values(body):
    values, last = set(), -1
    for item in re.sub(ATTRIBUTES, "", body).split(","):
        name, _, number = item.partition("=")
        if name.strip():
            last = last + 1 if not number else int(number, 0) if number.strip().isdigit() else 0  # no flags in scenes
            values.add(str(last))
    return values
