#!/usr/bin/python3
"""A small bed begins to float at the velocity that Ergun's equation gives for its own void fraction, within 10 %.

600 beads settle in a column without side walls. Below the minimum fluidisation velocity the bed must lie still and the
pressure drop must grow with the flow such that it reaches the weight of the bed at Ergun's velocity; above, the bed
must expand and the pressure drop stay at the weight. What is compared with comes from Ergun's equation and from the
weight alone.
"""

import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.environ.get("PELLICLE_PROGRAM")

SIDE, HEIGHT, CELLS = 0.021, 0.084, 14  # of the column [m], and gas cells over the height: 6 mm, two diameters
COUNT, DIAMETER, DENSITY = 600, 3e-3, 2505.0
GAS_DENSITY, VISCOSITY, GRAVITY = 1.149, 1.87e-5, 9.81
SOLIDS = COUNT * math.pi / 6 * DIAMETER**3
# The pressure without its hydrostatic part carries the weight less the buoyancy.
WEIGHT = SOLIDS * (DENSITY - GAS_DENSITY) * GRAVITY / SIDE**2  # per area [Pa]

CASE = f"""
domain: {{min: [0, 0, 0], max: [{SIDE}, {SIDE}, {HEIGHT}], periodic: [x, y]}}
time: {{end: "0.3 s", gas_step: "2e-4 s", particle_step: "1e-5 s", settle: "0.25 s"}}
materials:
  glass: {{density: {DENSITY}, youngs_modulus: 1e7, poisson_ratio: 0.22}}
contacts:
  pairs:  # little restitution, so that the bed is quiet before the gas comes
    - {{between: [glass, glass], restitution: 0.5, sliding_friction: 0.3}}
    - {{between: [glass, wall], restitution: 0.5, sliding_friction: 0.3}}
particles:
  - material: glass
    count: {COUNT}
    diameter: {DIAMETER}
    fill: {{box: {{min: [0, 0, 0], max: [{SIDE}, {SIDE}, 0.075]}}}}
walls:
  - {{name: floor, box: domain, material: wall}}
gas:
  density: {GAS_DENSITY}
  viscosity: {VISCOSITY}
  grid: {{cells: [1, 1, {CELLS}]}}
  boundaries:
    - {{name: floor, on: bottom, inlet: {{velocity: 1}}}}
    - {{name: top, on: top, outlet: {{pressure: 0}}}}
coupling: {{drag: ergun_wen_yu}}
output:
  lines:
    - {{name: pressure, from: [{SIDE / 2}, {SIDE / 2}, 0], to: [{SIDE / 2}, {SIDE / 2}, {HEIGHT}], points: {CELLS},
       thickness: {SIDE}, quantity: pressure, average: {{from: "0.1 s"}}}}
  probes:
    - {{name: bed, bed: {{}}, every: "1e-3 s", quantities: [mean_height]}}
"""


def ergun_pressure_drop(velocity, void_fraction, solids_height):
    """Ergun's pressure drop [Pa] of a packed bed, `solids_height` [m] being solids volume over cross-section."""
    viscous = 150 * (1 - void_fraction) * VISCOSITY / (void_fraction**3 * DIAMETER**2)
    inertial = 1.75 * GAS_DENSITY / (void_fraction**3 * DIAMETER)
    return solids_height * (viscous * velocity + inertial * velocity**2)


def ergun_minimum_fluidisation(void_fraction):
    """Velocity [m/s] at which Ergun's pressure drop carries the bed, by bisection."""
    low, high = 0.0, 100.0
    for _ in range(100):
        middle = (low + high) / 2
        if ergun_pressure_drop(middle, void_fraction, SOLIDS / SIDE**2) < WEIGHT:
            low = middle
        else:
            high = middle
    return low


def read(path):
    rows = [line.split(",") for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines()[1:]]
    return [[float(value) for value in row] for row in rows]


class Result:
    """What a run at one velocity shows."""

    def __init__(self, folder):
        pressure = [row[1] for row in read(folder / "lines" / "pressure.csv")]
        # The lowest value is that of a cell's centre; half a cell below it is the floor, inside the bed.
        self.pressure_drop = pressure[0] + (pressure[0] - pressure[1]) / 2 - pressure[-1]
        heights = read(folder / "probes" / "bed.csv")
        self.settled_height = heights[0][1]
        self.height = heights[-1][1]
        # Centres in a column of constant void fraction: their mean height is half the height of the bed.
        late = [height for time, height in heights if time > 0.1]
        self.void_fraction = 1 - SOLIDS / SIDE**2 / (2 * sum(late) / len(late))


@unittest.skipUnless(PROGRAM, "PELLICLE_PROGRAM is not set")
class MinimumFluidisation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.case = pathlib.Path(cls.folder.name) / "case.yaml"
        cls.case.write_text(CASE, encoding="utf-8")
        packed = cls.run_at(0.8)
        cls.expected = ergun_minimum_fluidisation(packed.void_fraction)
        cls.results = {share: cls.run_at(share * cls.expected) for share in (0.7, 0.9, 1.1, 1.3)}
        for share, result in cls.results.items():
            print(f"{share:.1f} u_mf = {share * cls.expected:.4f} m/s: pressure drop {result.pressure_drop:.2f} Pa "
                  f"({result.pressure_drop / WEIGHT:.3f} of the weight), mean height {1e3 * result.height:.3f} mm, "
                  f"settled {1e3 * result.settled_height:.3f} mm, void fraction {result.void_fraction:.4f}")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def run_at(cls, velocity):
        results = pathlib.Path(cls.folder.name) / f"results_{velocity:.6f}"
        run = subprocess.run([PROGRAM, "run", str(cls.case), "--threads", "1", "--output", str(results), "--set",
                              f"gas.boundaries.floor.inlet.velocity={velocity!r}"],
                             capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise AssertionError(f"the run at {velocity} m/s ended with {run.returncode}:\n{run.stdout}{run.stderr}")
        return Result(results)

    def test_packed_branch_reaches_the_weight_at_ergun(self):
        # dp = a u + b u^2 through two points of the packed bed, then dp = weight.
        points = [(share * self.expected, self.results[share].pressure_drop) for share in (0.7, 0.9)]
        (u1, p1), (u2, p2) = points
        b = (p2 / u2 - p1 / u1) / (u2 - u1)
        a = p1 / u1 - b * u1
        measured = (-a + math.sqrt(a * a + 4 * b * WEIGHT)) / (2 * b)
        expected = ergun_minimum_fluidisation(self.results[0.9].void_fraction)
        print(f"minimum fluidisation velocity: {measured:.4f} m/s from the packed branch, {expected:.4f} m/s by Ergun "
              f"at the void fraction {self.results[0.9].void_fraction:.4f}")
        self.assertAlmostEqual(measured / expected, 1, delta=0.1)

    def test_bed_lies_still_below_and_floats_above(self):
        # A bed that stays packed changes by less than 1 % (beads roll a little); one that floats goes on rising: in
        # 0.3 s by well over 5 % of its height even at 1.1 u_mf.
        for share in (0.7, 0.9):
            result = self.results[share]
            self.assertAlmostEqual(result.height / result.settled_height, 1, delta=0.01, msg=f"at {share} u_mf")
        for share in (1.1, 1.3):
            result = self.results[share]
            self.assertGreater(result.height / result.settled_height, 1.05, msg=f"at {share} u_mf")

    def test_pressure_drop_of_a_floating_bed_is_its_weight(self):
        # 10 %: the bed bounces, so that the floor bears some of it in the mean, and 1 % is the momentum that the gas
        # gains where it enters the bed. A packed bed would show 1.2 and 1.6 times the weight.
        for share in (1.1, 1.3):
            self.assertAlmostEqual(self.results[share].pressure_drop / WEIGHT, 1, delta=0.1, msg=f"at {share} u_mf")


if __name__ == "__main__":
    sys.exit(unittest.main())
