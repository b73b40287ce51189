#!/usr/bin/python3
"""The momentum that a run accounts for in summary.json closes: stock, boundaries and sources, each from its own books.

Each case has something that the books must not forget: fixed particles that others hit, fixed particles in a stream,
particles that left before the gas was let in, a gas that does not lose what it gives.
"""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ.get("PELLICLE_PROGRAM")

PARTICLES = """
domain: {{min: [0, 0, 0], max: [0.02, 0.02, 0.04]}}
time: {{end: "{end}", gas_step: "1e-4 s", particle_step: "1e-5 s", impact_speed: "2 m/s", settle: "{settle}"}}
materials:
  glass: {{density: 2505, youngs_modulus: 1e7, poisson_ratio: 0.22}}
contacts:
  pairs:
    - {{between: [glass, glass], restitution: 0.9, sliding_friction: 0.3}}
    - {{between: [glass, wall], restitution: 0.9, sliding_friction: 0.3}}
particles:
  - {{material: glass, list: [{list}]}}
walls:
  - {{name: sides, box: domain, open: [top], material: wall}}
"""
# Iterated, so that the books of the gas close too (docs/theory/gas.md).
GAS = """
gas:
  density: 1.149
  viscosity: 1.87e-5
  grid: {{cells: [4, 4, 8]}}
  solver: {{max_outer_iterations: 60, outer_tolerance: 1e-13, momentum_tolerance: 1e-14, pressure_tolerance: 1e-13}}
  boundaries:
    - {{name: floor, on: bottom, inlet: {{velocity: "1 m/s"}}}}
    - {{name: top, on: top, outlet: {{pressure: 0}}}}
coupling: {{drag: beetstra{options}}}
"""
FIXED = "{position: [0.01, 0.01, 0.01], diameter: 3e-3, fixed: true}"
ABOVE = "{position: [0.0103, 0.01, 0.0135], velocity: [0, 0, -0.3], diameter: 3e-3}"
LEAVING = "{position: [0.0053, 0.01, 0.035], velocity: [0, 0, 1], diameter: 3e-3}"


@unittest.skipUnless(PROGRAM, "PELLICLE_PROGRAM is not set")
class Ledger(unittest.TestCase):
    def run_case(self, particles, gas=None, end="10 ms", settle="0 s"):
        text = PARTICLES.format(list=", ".join(particles), end=end, settle=settle)
        if gas is not None:
            text += GAS.format(options=gas)
        with tempfile.TemporaryDirectory() as place:
            case = Path(place) / "case.yaml"
            case.write_text(text, encoding="utf-8")
            run = subprocess.run([PROGRAM, "run", str(case), "--output", str(Path(place) / "results"), "--threads", "1"],
                                 capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            return json.loads((Path(place) / "results" / "summary.json").read_text(encoding="utf-8"))

    def check(self, summary):
        # Some thousand substeps of round-off.
        self.assertLess(summary["defects"]["momentum"], 1e-11)
        self.assertLess(summary["defects"]["gas_mass"], 1e-10)

    def test_fixed_particle_that_another_hits(self):
        summary = self.run_case([FIXED, ABOVE], end="30 ms")
        self.assertGreater(summary["largest_impact_speed"], 0.1)
        self.check(summary)

    def test_particle_that_leaves_while_the_bed_settles(self):
        summary = self.run_case([LEAVING, ABOVE], settle="30 ms")
        self.assertEqual(summary["particles_left_through_open_sides"], 1)
        self.check(summary)

    def test_fixed_and_free_particles_in_a_stream(self):
        for options in ("", ", exchange: explicit", ", exchange: one_way", ", pressure_gradient_force: false"):
            with self.subTest(options):
                self.check(self.run_case([FIXED, ABOVE], gas=options))


if __name__ == "__main__":
    unittest.main()
