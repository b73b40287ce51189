#!/usr/bin/python3
"""A run with warm moist air: its books close, its outputs show temperature and moisture, and it resumes bit for bit."""
import csv
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ.get("PELLICLE_PROGRAM")

# Cold dry air is blown out by hot moist air; one wall loses heat.
CASE = """
domain: {min: [0, 0, 0], max: [0.1, 0.1, 0.4]}
time: {end: "0.2 s", gas_step: "2 ms"}
gas:
  density: {law: ideal_gas}
  viscosity: {law: sutherland}
  heat: {initial_temperature: "20 degC"}
  moisture: {initial_relative_humidity: 0.2}
  grid: {cells: [4, 4, 16]}
  solver: {pressure_tolerance: 1e-13, momentum_tolerance: 1e-12}
  boundaries:
    - {name: in, on: bottom, inlet: {velocity: "1 m/s", temperature: "80 degC", relative_humidity: 0.3}}
    - {name: out, on: top, outlet: {}}
    - {name: side, on: left, wall: {heat_transfer: {coefficient: "20 W/m2/K", temperature: "10 degC"}}}
output:
  snapshots: {every: "0.1 s", gas: [temperature, vapour_mass_fraction, density]}
  lines:
    - {name: axis, from: [0.05, 0.05, 0], to: [0.05, 0.05, 0.4], points: 16, quantity: gas_temperature,
       average: {from: "0.1 s"}}
  probes:
    - {name: low, point: [0.05, 0.05, 0.01], every: "0.1 s",
       quantities: [gas_temperature, vapour_mass_fraction, relative_humidity, gas_density]}
"""


@unittest.skipUnless(PROGRAM, "PELLICLE_PROGRAM is not set")
class HumidAir(unittest.TestCase):
    def run_case(self, place, name, *options):
        case = Path(place) / "case.yaml"
        case.write_text(CASE, encoding="utf-8")
        run = subprocess.run([PROGRAM, "run", str(case), "--output", str(Path(place) / name), "--threads", "1", *options],
                             capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return json.loads((Path(place) / name / "summary.json").read_text(encoding="utf-8"))

    def test_books_close_and_outputs_show_it(self):
        with tempfile.TemporaryDirectory() as place:
            summary = self.run_case(place, "whole")
            self.assertLess(summary["defects"]["gas_mass"], 1e-10)
            self.assertLess(summary["defects"]["energy"], 1e-8)
            self.assertLess(summary["defects"]["water"], 1e-12)
            through = summary["gas_boundaries"]
            # 1 m/s over 0.01 m2 for 0.2 s; X = 0.3 * 47411 / 101325 makes M 27.428 g/mol: 0.94648 kg/m3 at 80 degC.
            self.assertAlmostEqual(through["in"]["mass_in"] / (0.01 * 0.2 * 0.94648), 1, delta=1e-3)
            self.assertGreater(through["out"]["mass_out"], 0)
            self.assertGreater(through["in"]["heat_in"], 0)
            self.assertLess(through["side"]["heat_in"], 0)
            self.assertEqual(through["side"]["vapour_in"], 0)
            # w = 0.622 X / (1 - 0.378 X), X = 0.14037
            moisture = 0.622 * 0.14037 / (1 - 0.378 * 0.14037)
            self.assertAlmostEqual(through["in"]["vapour_in"] / (through["in"]["mass_in"] * moisture), 1, delta=5e-3)
            rows = list(csv.reader(open(Path(place) / "whole" / "probes" / "low.csv", encoding="utf-8")))
            self.assertEqual(rows[0], ["time [s]", "gas_temperature [K]", "vapour_mass_fraction [-]",
                                       "relative_humidity [-]", "gas_density [kg/m3]"])
            first, last = ([float(x) for x in rows[i]] for i in (1, -1))
            self.assertAlmostEqual(first[1], 293.15, places=9)
            self.assertAlmostEqual(first[3], 0.2, places=9)
            self.assertAlmostEqual(last[1], 353.15, delta=1)
            self.assertAlmostEqual(last[2], moisture, delta=1e-3)
            axis = list(csv.reader(open(Path(place) / "whole" / "lines" / "axis.csv", encoding="utf-8")))
            self.assertEqual(axis[0][1], "gas_temperature [K]")
            self.assertGreater(float(axis[1][1]), float(axis[-1][1]) + 10)

    def test_goes_on_bit_for_bit(self):
        with tempfile.TemporaryDirectory() as place:
            whole = self.run_case(place, "whole")
            self.run_case(place, "halves", "--until", "0.1 s")
            halves = self.run_case(place, "halves", "--resume")
            self.assertEqual(whole["gas_boundaries"], halves["gas_boundaries"])
            self.assertEqual(whole["defects"], halves["defects"])
            for name in ("probes/low.csv", "lines/axis.csv"):
                self.assertEqual((Path(place) / "whole" / name).read_bytes(), (Path(place) / "halves" / name).read_bytes())


if __name__ == "__main__":
    unittest.main()
