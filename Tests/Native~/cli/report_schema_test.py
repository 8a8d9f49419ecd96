# SPDX-License-Identifier: MIT
"""Every kind of report is what Documentation~/report.schema.json says.   report_schema_test.py PROGRAM PROJECT

Ends with 77, which CTest takes for skipped, where Python has no jsonschema.
"""
import json
import pathlib
import sys
import unittest

import cli_test
from cli_test import CRAMBIN, ProgramTest, program_to_test

try:
    import jsonschema
except ImportError:
    print("report_schema_test: skipped, Python has no jsonschema (python3-jsonschema)")
    sys.exit(77)

FRAMES_FAILED = INPUTS_FAILED = 6
SCHEMA = {}


class Schema(ProgramTest):
    def check(self, kind, *arguments, code=0):
        """Each line, or the whole, is a report of this kind and of no other. Gives the reports."""
        text = self.run_program(*arguments, "--backend", "cpu", "--json", "-", code=code).stdout
        try:
            reports = [json.loads(text)]
        except json.JSONDecodeError:
            reports = [json.loads(line) for line in text.splitlines()]
        self.assertTrue(reports)
        for report in reports:
            jsonschema.validate(report, SCHEMA)
            jsonschema.validate(report, dict(SCHEMA["definitions"][kind], definitions=SCHEMA["definitions"]))
            self.assertEqual(list(report)[0], "schema")
        return reports

    def models(self):
        atoms = [line for line in CRAMBIN.read_text().splitlines() if line.startswith("ATOM")][:60]
        return self.write("models.pdb", "".join("MODEL %8d\n%s\nENDMDL\n" % (k, "\n".join(atoms)) for k in (1, 2, 3)))

    def test_the_schema_is_one(self):
        jsonschema.Draft7Validator.check_schema(SCHEMA)
        objects = [SCHEMA]
        while objects:  # nothing may be there that it does not name
            item = objects.pop()
            if isinstance(item, dict):
                if "properties" in item and isinstance(item.get("type"), str):
                    self.assertIs(item["additionalProperties"], False)
                objects += item.values()
            elif isinstance(item, list):
                objects += item

    def test_surfaces(self):
        self.check("surface", CRAMBIN, "-v", "2")
        self.check("surface", CRAMBIN, "-v", "2", "-o", "a.obj", "--outer", "--slice", "64", "--memory", "1G", "--threads", "1")
        self.check("surface", CRAMBIN, "-v", "2", "--surface", "sas")
        self.check("surface", CRAMBIN, "-v", "2", "--method", "grid")
        self.check("surface", CRAMBIN, "-v", "2", "--surface", "gaussian", "--radius-scale", "1.5", "-o", "a.ply", "--occlusion", "on")
        self.check("surface", CRAMBIN, "-v", "2", "-o", "a.ply", "--color", "element", "--sharp-colors", "--center", "--scale", "2")
        self.check("surface", CRAMBIN, "-v", "2", "-o", "a.glb", "--color", "#C08000")
        for output, arguments, color in (("a.png", [], "element"), ("a.html", [], "element"), ("a.html", ["--color", "none"], None),
                                         ("a.ply", [], None)):
            (report,) = self.check("surface", CRAMBIN, "-v", "2", "-o", output, *arguments)
            self.assertEqual(report["settings"].get("color"), color)
        models = self.models()
        for report in self.check("surface_of_frame", models, "--trajectory", models, "-v", "2", "-o", "b.html"):
            self.assertEqual(report["settings"]["color"], "element")
        self.check("surface", CRAMBIN, "-v", "2", "-o", "a.png", "--size", "32x32", "--samples", "1")
        self.assertEqual(len(self.check("surface", self.models(), "-v", "2", "--model", "all")), 3)

    def test_frames(self):
        models = self.models()
        self.assertEqual(len(self.check("surface_of_frame", models, "--trajectory", models, "-v", "2")), 3)
        self.assertEqual(len(self.check("measurement_of_frame", "measure", models, "--trajectory", models)), 3)

    def test_failed_frames(self):
        models = self.models()
        reports = self.check("failed_frame", models, "--trajectory", models, "-v", "2", "--memory", "1K", code=FRAMES_FAILED)
        self.assertEqual(len(reports), 3)

    def test_failed_inputs(self):
        for command in ([], ["measure"]):
            reports = self.check("failed_input", *command, "none_1.pdb", "none_2.pdb", code=INPUTS_FAILED)
            self.assertEqual([report["input"] for report in reports], ["none_1.pdb", "none_2.pdb"])

    def test_numbers(self):
        self.check("measurement", "measure", CRAMBIN)
        self.check("measurement", "measure", CRAMBIN, "--surface", "ses,vdw", "-v", "1")
        self.check("cavities", "cavities", CRAMBIN)

    def test_bench(self):
        self.check("bench", "bench", CRAMBIN, "-v", "2", "--repeat", "2", "--stages", "--copies", "2")
        self.check("bench", "bench", CRAMBIN, "-v", "2", "--repeat", "1", "--small", "100")
        self.check("bench", "bench", CRAMBIN, "-v", "2", "--repeat", "1", "--jobs")

    def test_what_is_wrong_is_found(self):
        report = self.check("surface", CRAMBIN, "-v", "2")[0]
        for change in ({"more": 1}, {"schema": 2}, {"area": "large"}, {"mesh": {}}):
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.validate({**report, **change}, SCHEMA)
        for name in ("schema", "area", "memory"):
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.validate({key: value for key, value in report.items() if key != name}, SCHEMA)


if __name__ == "__main__":
    cli_test.PROGRAM = program_to_test("", __doc__)
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    SCHEMA = json.loads((pathlib.Path(sys.argv.pop(1)) / "Documentation~" / "report.schema.json").read_text())
    unittest.main()
