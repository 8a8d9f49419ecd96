# SPDX-License-Identifier: MIT
"""What of ShaderLab the package's shaders use: passes, their programs, and the keywords that those are compiled for."""

import itertools
import re

# What Unity makes of its own names for sets of keywords; as many as the shaders tell apart.
SHORTHANDS = {
    "multi_compile_fog": ["", "FOG_LINEAR", "FOG_EXP2"],
    "multi_compile_instancing": ["", "INSTANCING_ON", "INSTANCING_ON STEREO_INSTANCING_ON"],
    "multi_compile_fwdbase": ["DIRECTIONAL", "DIRECTIONAL SHADOWS_SCREEN", "DIRECTIONAL VERTEXLIGHT_ON",
                              "DIRECTIONAL UNITY_SPECCUBE_BLENDING UNITY_SPECCUBE_BOX_PROJECTION"],
    "multi_compile_fwdadd_fullshadows": ["POINT", "DIRECTIONAL SHADOWS_SCREEN", "SPOT SHADOWS_DEPTH", "POINT SHADOWS_CUBE"],
    "multi_compile_shadowcaster": ["SHADOWS_DEPTH", "SHADOWS_CUBE"],
}


class Pass:
    def __init__(self, pipeline, text):
        self.pipeline = pipeline
        self.name = re.search(r'Name "(\w+)"', text)[1]
        self.light_mode = re.search(r'"LightMode" = "(\w+)"', text)[1]
        begin, code, end = re.search(r"\b(HLSL|CG)PROGRAM\n(.*?)\bEND(HLSL|CG)\b", text, re.S).groups()
        assert begin == end
        self.language = begin
        self.state = re.sub(r"\b(HLSL|CG)PROGRAM\n.*", "", text, flags=re.S)
        self.code = re.sub(r"(?m)^\s*#pragma.*$", "", code)
        self.pragmas = [line.split() for line in re.findall(r"(?m)^\s*#pragma (.*)$", code)]

    def entry(self, stage):
        return next(words[1] for words in self.pragmas if words[0] == stage)

    def keyword_sets(self):
        """Each keyword of each set with all others at their first, and all at their last: not all products."""
        choices = []
        for words in self.pragmas:
            name = words[0]
            if name in SHORTHANDS:
                choices.append(SHORTHANDS[name])
            elif name.startswith("multi_compile") or name.startswith("shader_feature"):
                choices.append(["" if word == "_" else word for word in words[1:]])
        first = [choice[0] for choice in choices]
        found = [first, [choice[-1] for choice in choices]]
        for k, choice in enumerate(choices):
            found += [first[:k] + [keyword] + first[k + 1:] for keyword in choice[1:]]
        names = {tuple(sorted(itertools.chain.from_iterable(keyword.split() for keyword in one))) for one in found}
        return sorted(names)


def read(path):
    """Name, properties {name: default} and passes of a shader."""
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"(?m)//.*$", "", file.read())
    name = re.search(r'Shader "([^"]+)"', text)[1]
    properties = dict(re.findall(r'(?m)^\s*(?:\[[^\]]*\]\s*)*(_\w+)\("[^"]*", [^=]*= (.*)$', text))
    passes = []
    for sub_shader in text.split("SubShader")[1:]:
        pipeline = "universal" if "PackageRequirements" in sub_shader else "built-in"
        tags = dict(re.findall(r'"(\w+)" = "(\w+)"', sub_shader.split("Pass")[0]))
        for part in re.split(r"\bPass\n", sub_shader)[1:]:
            one = Pass(pipeline, part)
            one.tags = tags
            passes.append(one)
    return name, properties, passes
