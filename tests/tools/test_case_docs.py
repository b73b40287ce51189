#!/usr/bin/python3
"""docs/case_file.md holds the reference of keys that the program prints; its examples are cases that can be read.

test_case_docs.py --update writes the reference into the file (PELLICLE_PROGRAM names the program).
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
PROGRAM = os.environ.get("PELLICLE_PROGRAM", str(TOP / "build/release/pellicle"))
DOCS = TOP / "docs/case_file.md"
MARK = re.compile(r"^<!-- From here on written by .*-->\n", re.MULTILINE)


def program(*arguments):
    run = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)
    return run.returncode, run.stdout, run.stderr


def reference():
    code, text, errors = program("schema", "--markdown")
    if code != 0:
        sys.exit(errors)
    return "\n" + text


class CaseDocs(unittest.TestCase):
    def test_reference_is_current(self):
        text = DOCS.read_text()
        end = MARK.search(text).end()
        self.assertEqual(text[end:], reference(), "docs/case_file.md is stale: run this test with --update")

    def test_example_can_be_read(self):
        example = re.search(r"```yaml\n(.*?)```", DOCS.read_text(), re.DOTALL).group(1)
        with tempfile.TemporaryDirectory() as folder:
            case = pathlib.Path(folder) / "example.yaml"
            case.write_text(example)
            code, output, errors = program("check", str(case))
            self.assertEqual(code, 0, output + errors)
            self.assertIn("nothing wrong", output)
            self.assertNotIn("warning", output)

    def test_cases_can_be_read(self):
        for case in sorted(TOP.glob("cases/*/*.yaml")):
            code, output, errors = program("check", str(case))
            self.assertEqual(code, 0, f"{case}: {output}{errors}")

    def test_schema_is_json_and_says_what_the_reader_says(self):
        code, text, _ = program("schema")
        self.assertEqual(code, 0)
        schema = json.loads(text)
        self.assertEqual(schema["required"], ["domain", "time"])
        time = schema["properties"]["time"]
        self.assertFalse(time["additionalProperties"])
        self.assertEqual(time["properties"]["end"]["anyOf"][0], {"type": "number", "exclusiveMinimum": 0.0})
        drag = schema["properties"]["coupling"]["properties"]["drag"]
        self.assertIn("koch_hill", drag["enum"])
        self.assertEqual(drag["default"], "beetstra")
        boundary = schema["properties"]["gas"]["properties"]["boundaries"]["items"]
        self.assertEqual(boundary["allOf"][0]["oneOf"], [{"required": ["on"]}, {"required": ["on_wall"]}])
        self.assertEqual(len(boundary["allOf"][1]["oneOf"]), 5)

    def test_models_lists_every_drag_law_with_its_source(self):
        code, text, _ = program("models", "drag")
        self.assertEqual(code, 0)
        for name in ("ergun_wen_yu", "koch_hill", "beetstra", "di_felice", "rong"):
            self.assertRegex(text, rf"(?m)^  {name} .*\n +\[.*\]$")


if __name__ == "__main__":
    if "--update" in sys.argv:
        old = DOCS.read_text()
        DOCS.write_text(old[: MARK.search(old).end()] + reference())
    else:
        sys.exit(unittest.main())
