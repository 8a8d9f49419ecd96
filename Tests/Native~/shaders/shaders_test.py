#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compiles every pass of the package's shaders as HLSL, for both pipelines and its keywords, by glslangValidator.

    shaders_test.py ROOT

Unity's own include files are not to be had without it; stand_ins has those names of them that the shaders use, with the same
types. So this shows that the shaders are right HLSL and agree among each other, and not that Unity's compiler and files agree with
them. Without glslangValidator: 77 (skipped).
"""

import concurrent.futures
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import shader_lab

ROOT = os.path.realpath(sys.argv[1] if len(sys.argv) > 1 else ".")
FOLDER = os.path.join(ROOT, "UnityPackage", "Runtime", "Unity", "Shaders")
STAND_INS = os.path.join(os.path.dirname(os.path.realpath(__file__)), "stand_ins")
SHADERS = {name: shader_lab.read(os.path.join(FOLDER, name)) for name in sorted(os.listdir(FOLDER)) if name.endswith(".shader")}


def preprocess_for_glslang(text):
    """VFACE, a number of Direct3D 9 that Unity still takes, is a truth value in later HLSL."""
    return re.sub(r"fixed (\w+) : VFACE", r"bool \1 : SV_IsFrontFace", text)


def flatten(code, folders, seen):
    """The code with its include files in it, as the compiler gets it; each is found beside the one that includes it, or in Unity."""
    def replace(match):
        for folder in folders:
            path = os.path.join(folder, match[1])
            if os.path.isfile(path):
                seen.add(path)
                with open(path, encoding="utf-8") as file:
                    return flatten(file.read(), [os.path.dirname(path), STAND_INS], seen)
        raise FileNotFoundError(match[1])
    return re.sub(r'(?m)^\s*#include "([^"]+)"$', replace, code)


def compile_one(code, entry, stage, keywords, output=None):
    """What the compiler says against it; "" if nothing."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "program.hlsl")
        with open(path, "w", encoding="utf-8") as file:
            file.write("".join(f"#define {keyword} 1\n" for keyword in keywords) + preprocess_for_glslang(code))
        result = subprocess.run(
            ["glslangValidator", "-D", "-V", "--target-env", "vulkan1.2", "--auto-map-bindings", "--auto-map-locations", "-S",
             "vert" if stage == "vertex" else "frag", "-e", entry, "-o", output or os.path.join(folder, "program.spv"), path],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        return "" if result.returncode == 0 else result.stdout


class ShadersTest(unittest.TestCase):
    def test_every_pass_compiles(self):
        jobs, included = [], set()
        for file, (_, _, passes) in SHADERS.items():
            for one in passes:
                code = flatten(one.code, [FOLDER, STAND_INS], included)
                for keywords in one.keyword_sets():
                    for gamma in ((), ("UNITY_COLORSPACE_GAMMA",)):
                        for stage in ("vertex", "fragment"):
                            jobs.append((f"{file}, {one.pipeline}, {one.name}, {stage}, {keywords + gamma}", code,
                                         one.entry(stage), stage, keywords + gamma))
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for job, said in zip(jobs, pool.map(lambda job: compile_one(*job[1:]), jobs)):
                self.assertEqual(said, "", job[0])
        print(f"{len(jobs)} programs")
        self.assertGreater(len(jobs), 200)
        ours = {path for path in included if path.startswith(FOLDER)}
        self.assertEqual(ours, {os.path.join(FOLDER, name) for name in os.listdir(FOLDER) if name.endswith(".hlsl")},
                         "include files that no pass needs")

    def test_faults_are_found(self):
        one = SHADERS["MolecularSurface.shader"][2][0]
        code = flatten(one.code, [FOLDER, STAND_INS], set())
        self.assertEqual(compile_one(code, "Fragment", "fragment", ()), "")
        self.assertIn("no such field", compile_one(code.replace("input.color.a", "input.hue.a"), "Fragment", "fragment", ()))

    def test_shader_graph_functions_compile(self):
        with open(os.path.join(FOLDER, "QuickSesAtomColor.hlsl"), encoding="utf-8") as file:
            code = file.read()
        for precision in ("float", "half"):
            main = (f"float4 Main(float4 color : COLOR) : SV_Target {{ {precision}3 rgb; {precision} alpha; "
                    f"QuickSesAtomColor_{precision}(color, rgb, alpha); return float4(rgb, alpha); }}\n")
            self.assertEqual(compile_one(code + main, "Main", "fragment", ()), "")

    def test_every_pass_hides_atoms(self):
        for file, (_, _, passes) in SHADERS.items():
            for one in passes:
                code = flatten(one.code, [FOLDER, STAND_INS], set())
                self.assertRegex(code.split("Fragment(")[-1], r"\bSurfaceAlpha\(", f"{file}: {one.name}")
                self.assertEqual("#define QUICKSES_TRANSPARENT" in one.code, "Transparent" in file, f"{file}: {one.name}")

    def test_motion_is_drawn_by_pipelines_that_have_its_include_file(self):
        for file, (_, _, passes) in SHADERS.items():
            for one in passes:
                included = set()
                flatten(one.code, [FOLDER, STAND_INS], included)
                needs_it = any(path.endswith("MotionVectorsCommon.hlsl") for path in included)
                self.assertEqual(needs_it, one.light_mode == "MotionVectors", f"{file}: {one.name}")
                self.assertEqual(needs_it, '"com.unity.render-pipelines.universal": "16.0"' in one.state, f"{file}: {one.name}")
        self.assertIn("MotionVectors", [one.light_mode for one in SHADERS["MolecularSurface.shader"][2]])

    def test_nearest_layer_comes_first(self):
        _, _, passes = SHADERS["MolecularSurfaceTransparent.shader"]
        for pipeline, modes in (("universal", ["SRPDefaultUnlit", "UniversalForwardOnly"]), ("built-in", ["Always", "ForwardBase"])):
            depth, color = [one for one in passes if one.pipeline == pipeline][:2]
            self.assertEqual([depth.light_mode, color.light_mode], modes)
            self.assertEqual(depth.tags["Queue"], "Transparent")
            self.assertRegex(depth.state, r"ZWrite On\s+ColorMask 0\b")
            self.assertRegex(color.state, r"Blend SrcAlpha OneMinusSrcAlpha.*\n\s*ZWrite Off")

    def test_materials_of_one_can_be_given_the_other(self):
        opaque, transparent = (SHADERS[name][1] for name in ("MolecularSurface.shader", "MolecularSurfaceTransparent.shader"))
        self.assertEqual(opaque.keys(), transparent.keys())
        self.assertTrue({"_Color", "_BaseColor", "_QuickSesAtomColors", "_QuickSesAtomColorsWidth"} <= opaque.keys())

    def test_constants_of_the_material_are_in_one_block(self):
        with open(os.path.join(FOLDER, "UniversalSurface.hlsl"), encoding="utf-8") as file:
            block = re.search(r"CBUFFER_START\(UnityPerMaterial\)(.*?)CBUFFER_END", file.read(), re.S)[1]
        numbers = {name for name, default in SHADERS["MolecularSurface.shader"][1].items() if "{" not in default} - {"_Cull"}
        self.assertEqual(set(re.findall(r"(_\w+);", block)), numbers)


if __name__ == "__main__":
    if not shutil.which("glslangValidator"):
        print("glslangValidator is not here (Debian's glslang-tools).")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
