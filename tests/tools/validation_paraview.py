#!/usr/bin/python3
"""Runs the first moments of the quickstart case and opens its snapshots, all time steps, in ParaView (pvpython)."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
PROGRAM = os.environ.get("PELLICLE_PROGRAM", str(TOP / "build" / "release" / "pellicle"))


@unittest.skipUnless(shutil.which("pvpython"), "ParaView is not installed (Debian: apt-get install paraview)")
class ParaView(unittest.TestCase):
    def test_snapshots_of_a_run(self):
        with tempfile.TemporaryDirectory() as folder:
            results = pathlib.Path(folder) / "results"
            case = TOP / "cases" / "quickstart" / "case.yaml"
            subprocess.run([PROGRAM, "run", str(case), "--output", str(results), "--until", "0.02",
                            "--set", "output.snapshots.every=0.005", "--set", "output.average.from=0.005"], check=True)
            self.compare(results)
            # Moved elsewhere: the paths inside are relative.
            moved = pathlib.Path(folder) / "moved"
            results.rename(moved)
            self.compare(moved)

    def compare(self, results):
        check = subprocess.run(["pvpython", str(TOP / "tools" / "validation" / "check_paraview.py"), str(results)],
                               capture_output=True, text=True)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)
        for name in ("particles", "gas", "gas_average"):
            self.assertIn(f"{name}.xdmf with XDMFReader", check.stdout)


if __name__ == "__main__":
    unittest.main()
