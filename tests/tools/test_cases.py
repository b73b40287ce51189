#!/usr/bin/python3
"""The cases are in order: each is accepted by `pellicle check`, and the stiff twin differs as it says and no more."""

import os
import pathlib
import re
import subprocess
import sys
import unittest

TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
PROGRAM = os.environ.get("PELLICLE_PROGRAM")
# Nothing here gains from threads.
ENVIRONMENT = os.environ | {"OMP_NUM_THREADS": "1"}
CASES = sorted((TOP / "cases").glob("*/*.yaml"))


def before_lines(path):
    """A case file without comments, up to its lines, and what follows them."""
    text = re.sub(r"\s*#.*", "", path.read_text(encoding="utf-8"))
    head, _, tail = text.partition("\n  lines:")
    return head + tail[tail.index("\n  probes:") :]


class Cases(unittest.TestCase):
    def test_there_are_cases_and_each_is_described(self):
        self.assertGreaterEqual(len(CASES), 4)
        for case in CASES:
            self.assertTrue((case.parent / "README.md").exists(), case)

    @unittest.skipUnless(PROGRAM, "PELLICLE_PROGRAM is not set")
    def test_each_case_is_accepted(self):
        for case in CASES:
            run = subprocess.run([PROGRAM, "check", str(case)], capture_output=True, text=True, check=False,
                                 env=ENVIRONMENT)
            self.assertEqual(run.returncode, 0, f"{case}:\n{run.stdout}{run.stderr}")

    @unittest.skipUnless(PROGRAM, "PELLICLE_PROGRAM is not set")
    def test_variations_of_the_validation_scripts_are_accepted(self):
        for script in sorted((TOP / "tools" / "validation").glob("run_*")):
            listing = subprocess.run([sys.executable, str(script), "--list"], capture_output=True, text=True,
                                     check=True)
            for line in listing.stdout.splitlines():
                if " run " not in line:
                    continue  # not a case, but a program of the tests
                words = line.split()[2:]  # after `pellicle run`
                if pathlib.Path(words[0]).parent.name == "results":
                    continue  # made from another run by case_from_snapshot.py
                words = [words[0]] + [w for i, w in enumerate(words) if "--set" in (w, words[i - 1])]
                run = subprocess.run([PROGRAM, "check", *words], capture_output=True, text=True, check=False,
                                     env=ENVIRONMENT)
                self.assertEqual(run.returncode, 0, f"{line}:\n{run.stdout}{run.stderr}")

    def test_stiff_twin_differs_only_where_it_says(self):
        spout = TOP / "cases" / "single_spout"
        soft, stiff = (before_lines(spout / name) for name in ("case.yaml", "stiff.yaml"))
        for of_soft, of_stiff in (("title: single-spout fluidised bed", "title: single-spout fluidised bed, ten times "
                                   "stiffer beads"),
                                  ('end: "4 s"', 'end: "1 s"'),
                                  ('particle_step: "1e-5 s"', 'particle_step: "4e-6 s"'),
                                  ('youngs_modulus: "1e7 Pa"', 'youngs_modulus: "1e8 Pa"')):
            self.assertIn(of_soft, soft)
            self.assertIn(of_stiff, stiff)
            soft = soft.replace(of_soft, of_stiff, 1)
        self.assertEqual(soft, stiff)


if __name__ == "__main__":
    sys.exit(unittest.main())
