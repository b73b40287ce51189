#!/usr/bin/python3
"""The force of the gas on walls: gas between two planes, driven along them; probes, summary and going on after a stop."""
import csv
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ.get("PELLICLE_PROGRAM")

CASE = """
domain: {min: [0, 0, 0], max: [0.05, 0.05, 0.1], periodic: [x, y]}
time: {end: 0.2, gas_step: 0.01}
walls:
  - {name: floor, plane: {point: [0, 0, 0.0123], normal: [0, 0, 1]}, material: steel}
  - {name: lid, plane: {point: [0, 0, 0.0877], normal: [0, 0, -1]}, material: steel}
gas:
  density: 1
  viscosity: 1
  inside: [0.02, 0.02, 0.05]
  body_force: [3, 0, 0]
  grid: {cells: [2, 2, 20]}
output:
  checkpoint: {every: 0.1}
  probes: [{name: floor, wall: floor, every: 0.01}, {name: lid, wall: lid, quantities: [gas_force_x], every: 0.02}]
"""
# The same between two sides of the domain, and the gas is pressed down.
SIDES = """
domain: {min: [0, 0, 0], max: [0.05, 0.05, 0.1], periodic: [x, y]}
time: {end: 0.3, gas_step: 0.01}
walls:
  - {name: sides, box: domain, material: steel}
  - {name: floor, box: domain, open: [top], material: steel}
gas:
  density: 1
  viscosity: 1
  body_force: [3, 0, -2]
  grid: {cells: [2, 2, 20]}
output:
  probes: [{name: sides, wall: sides, every: 0.01}, {name: floor, wall: floor, every: 0.01}]
"""
# In steady state the walls take what drives the gas: force per volume times volume, half each.
EACH = 3 * 0.05 * 0.05 * (0.0877 - 0.0123) / 2


def run(case, folder, *more):
    return subprocess.run([PROGRAM, "run", str(case), "--output", str(folder), "--threads", "1", *more],
                          capture_output=True, text=True, check=False)


def rows_of(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(file))


@unittest.skipUnless(PROGRAM, "needs PELLICLE_PROGRAM")
class GasForces(unittest.TestCase):
    def test_walls_take_what_drives_the_gas(self):
        with tempfile.TemporaryDirectory() as folder:
            case = Path(folder) / "case.yaml"
            case.write_text(CASE, encoding="utf-8")
            done = run(case, Path(folder) / "whole")
            self.assertEqual(done.returncode, 0, done.stderr)
            floor = rows_of(Path(folder) / "whole/probes/floor.csv")
            self.assertEqual(list(floor[0]), ["time [s]", "gas_force_x [N]", "gas_force_y [N]", "gas_force_z [N]"])
            # The slowest part of the start is gone after 0.2 s: exp(-pi^2 0.2/0.0754^2).
            self.assertAlmostEqual(float(floor[-1]["gas_force_x [N]"]), EACH, delta=1e-6 * EACH)
            self.assertAlmostEqual(float(floor[-1]["gas_force_y [N]"]), 0, delta=1e-9)
            lid = rows_of(Path(folder) / "whole/probes/lid.csv")
            self.assertAlmostEqual(float(lid[-1]["gas_force_x [N]"]), EACH, delta=1e-6 * EACH)
            # The mean of the summary is that of the rows.
            summary = json.loads((Path(folder) / "whole/summary.json").read_text(encoding="utf-8"))
            rows = [float(row["gas_force_x [N]"]) for row in floor[1:]]
            self.assertAlmostEqual(summary["walls"]["floor"]["mean_gas_force"][0], sum(rows) / len(rows),
                                   delta=1e-9 * EACH)
            # Stopped half way, between two rows of the lid, and gone on: the same files.
            self.assertEqual(run(case, Path(folder) / "parts", "--until", "0.11").returncode, 0)
            self.assertEqual(run(case, Path(folder) / "parts", "--resume").returncode, 0)
            for name in ("floor.csv", "lid.csv"):
                self.assertEqual((Path(folder) / "parts/probes" / name).read_text(encoding="utf-8"),
                                 (Path(folder) / "whole/probes" / name).read_text(encoding="utf-8"))

    def test_sides_of_the_domain_are_walls_too(self):
        volume = 0.05 * 0.05 * 0.1
        with tempfile.TemporaryDirectory() as folder:
            case = Path(folder) / "case.yaml"
            case.write_text(SIDES, encoding="utf-8")
            done = run(case, Path(folder) / "out")
            self.assertEqual(done.returncode, 0, done.stderr)
            sides = rows_of(Path(folder) / "out/probes/sides.csv")[-1]
            # exp(-pi^2 0.3/0.1^2) of the start is left.
            self.assertAlmostEqual(float(sides["gas_force_x [N]"]), 3 * volume, delta=1e-6 * volume)
            self.assertAlmostEqual(float(sides["gas_force_y [N]"]), 0, delta=1e-9)
            self.assertAlmostEqual(float(sides["gas_force_z [N]"]), -2 * volume, delta=1e-4 * volume)  # tolerance of pressure
            floor = rows_of(Path(folder) / "out/probes/floor.csv")[-1]
            self.assertAlmostEqual(float(floor["gas_force_x [N]"]), 1.5 * volume, delta=1e-6 * volume)

    def test_what_cannot_be_shown_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            case = Path(folder) / "case.yaml"
            case.write_text(CASE.replace("wall: lid, ", "wall: roof, "), encoding="utf-8")
            done = run(case, Path(folder) / "out")
            self.assertEqual(done.returncode, 2)
            self.assertIn('no wall "roof"; floor, lid', done.stderr)
            case.write_text(CASE.replace("[gas_force_x]", "[wall_force_x]"), encoding="utf-8")
            done = run(case, Path(folder) / "out")
            self.assertEqual(done.returncode, 2)
            self.assertIn("wall_force_x needs particles", done.stderr)


if __name__ == "__main__":
    unittest.main()
