#!/usr/bin/python3
"""Particles alone, fed and leaving: the books, all outputs, and going on after a stop; and settling until quiet."""
import csv
import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

PROGRAM = os.environ.get("PELLICLE_PROGRAM")

HEAD = """
materials:
  glass: {density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.25}
contacts:
  model: {tangential: mindlin}
  pairs:
    - {between: [glass, glass], restitution: 0.9, sliding_friction: 0.3}
    - {between: [glass, wall], restitution: 0.9, sliding_friction: 0.3}
"""
STREAM = HEAD + """
domain: {min: [0, 0, 0], max: ["20 mm", "20 mm", "60 mm"]}
time: {end: "60 ms", gas_step: "1e-4 s", particle_step: "2.5e-6 s", impact_speed: "2 m/s"}
particles:
  - {material: glass, diameter: {normal: {mean: "2 mm", sd: "0.3 mm", min: "1 mm", max: "3 mm"}}, velocity: [0, 0, -1],
     feed: {disc: {centre: ["10 mm", "10 mm", "55 mm"], normal: [0, 0, 1], radius: "8 mm"}, mass_rate: "0.05 kg/s"}}
walls:
  - {name: sides, box: domain, open: [bottom], material: wall}
output:
  checkpoint: {every: "20 ms"}
  snapshots: {every: "10 ms"}
  lines:
    - {name: vz, from: [0, "10 mm", "20 mm"], to: ["20 mm", "10 mm", "20 mm"], points: 4, depth_average: y,
       thickness: "5 mm", quantity: particle_velocity_z}
  probes: [{name: bed, bed: {}, every: "1 ms"}, {name: third, particle: 3, every: "1 ms"},
           {name: out, side: bottom, every: "1 ms"}]
  histograms: [{name: sizes, quantity: particle_diameter, every: "20 ms"}]
"""
BED = HEAD + """
domain: {min: [0, 0, 0], max: ["9 mm", "9 mm", "30 mm"]}
time: {end: "1 ms", gas_step: "1e-4 s", particle_step: "5e-6 s", settle: {until: quiet, at_most: "%s", speed: "5 mm/s"}}
particles:
  - {material: glass, diameter: "2 mm", count: 60, fill: {box: {min: [0, 0, 0], max: ["9 mm", "9 mm", "20 mm"]}}}
walls:
  - {name: sides, box: domain, material: wall}
output:
  probes: [{name: bed, bed: {}, every: "1 ms"}]
"""


def run(case, folder, *more):
    return subprocess.run([PROGRAM, "run", str(case), "--output", str(folder), "--threads", "1", *more],
                          capture_output=True, text=True, check=False)


def arrays(path):
    with h5py.File(path) as file:
        found = {}
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return {name: value for name, value in found.items() if name != "case"}


@unittest.skipUnless(PROGRAM, "PELLICLE_PROGRAM is not set")
class Feed(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)
        self.folder = Path(self.place.name)
        self.case = self.folder / "case.yaml"

    def test_stream(self):
        self.case.write_text(STREAM, encoding="utf-8")
        whole = run(self.case, self.folder / "whole")
        self.assertEqual(whole.returncode, 0, whole.stdout + whole.stderr)
        summary = json.loads((self.folder / "whole" / "summary.json").read_text(encoding="utf-8"))
        # 0.05 kg/s until the last outer step at 59.9 ms, less at most one sphere of 3 mm, 35 mg.
        self.assertLessEqual(summary["mass_fed"], 0.05 * 0.0599 + 1e-12)
        self.assertGreater(summary["mass_fed"], 0.05 * 0.0599 - 2500 * math.pi / 6 * 0.003**3)
        self.assertEqual(summary["particles_fed"], summary["particles"] + summary["particles_left_through_open_sides"])
        self.assertGreater(summary["particles"], 50)
        self.assertGreater(summary["mass_left"], 0)
        # All leave through the floor; the probe's rates add up to what left.
        left = summary["left_by_side"]
        self.assertEqual(list(left), ["bottom"])
        self.assertEqual(left["bottom"]["particles"], summary["particles_left_through_open_sides"])
        self.assertAlmostEqual(left["bottom"]["mass"], summary["mass_left"], delta=1e-12)
        report = subprocess.run([PROGRAM, "report", str(self.folder / "whole")], capture_output=True, text=True, check=True)
        self.assertRegex(report.stdout, rf"(?m)^  bottom +{left['bottom']['particles']}, ")
        with open(self.folder / "whole" / "probes" / "out.csv", encoding="utf-8") as file:
            rows = [[float(value) for value in row] for row in list(csv.reader(file))[1:]]
        self.assertEqual(rows[-1][4], left["bottom"]["particles"])
        self.assertAlmostEqual(rows[-1][3], left["bottom"]["mass"], delta=1e-12)
        steps = [now[0] - before[0] for before, now in zip(rows, rows[1:])]
        self.assertAlmostEqual(sum(row[1] * step for row, step in zip(rows[1:], steps)), rows[-1][3], delta=1e-9)
        self.assertAlmostEqual(sum(row[2] * step for row, step in zip(rows[1:], steps)), rows[-1][4], delta=1e-3)
        # A hundred particles come and go: their masses and impulses add up to round-off.
        self.assertLess(summary["defects"]["particle_mass"], 1e-13)
        self.assertLess(summary["defects"]["momentum"], 1e-11)
        for file in ("lines/vz.csv", "probes/bed.csv", "probes/third.csv", "probes/out.csv", "histograms/sizes.csv", "particles.h5"):
            self.assertTrue((self.folder / "whole" / file).exists(), file)

        stopped = run(self.case, self.folder / "stopped", "--until", "40 ms")
        self.assertEqual(stopped.returncode, 0, stopped.stdout + stopped.stderr)
        resumed = run(self.case, self.folder / "stopped", "--resume")
        self.assertEqual(resumed.returncode, 0, resumed.stdout + resumed.stderr)
        one, other = arrays(self.folder / "whole" / "checkpoint.h5"), arrays(self.folder / "stopped" / "checkpoint.h5")
        self.assertEqual(one.keys(), other.keys())
        self.assertEqual((self.folder / "whole" / "probes" / "out.csv").read_bytes(),
                         (self.folder / "stopped" / "probes" / "out.csv").read_bytes())
        for name, value in one.items():
            self.assertTrue(np.array_equal(value, other[name]), name)

    def test_is_refused_where_walls_leave_no_room(self):
        lid = '  - {name: lid, block: {min: [0, 0, "%s"], max: ["20 mm", "20 mm", "60 mm"]}, material: wall}\noutput:'
        for height, refused in (("50 mm", True), ("57 mm", False)):
            self.case.write_text(STREAM.replace("output:", lid % height, 1), encoding="utf-8")
            check = subprocess.run([PROGRAM, "check", str(self.case)], capture_output=True, text=True, check=False)
            self.assertEqual(check.returncode, 2 if refused else 0, check.stderr)
            if refused:
                self.assertIn("particles.0.feed: the wall lid leaves no room for a particle of 0.003 m, the largest of "
                              "this feed; a disc where spheres of that size are clear of walls", check.stderr)

    def test_settles_until_quiet(self):
        for at_most in ("1 s", "20 ms"):
            self.case.write_text(BED % at_most, encoding="utf-8")
            done = run(self.case, self.folder / "bed", "--overwrite")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            with open(self.folder / "bed" / "probes" / "bed.csv", encoding="utf-8") as file:
                first = next(csv.DictReader(file))
            speed = next(float(value) for name, value in first.items() if name.startswith("mean_speed"))
            log = (self.folder / "bed" / "run.log").read_text(encoding="utf-8")
            # A mean is below a root mean square. Beads that fall for 20 ms are still on the way.
            if at_most == "1 s":
                self.assertLess(speed, 5e-3)
                self.assertRegex(log, r"settled after 0\.\d+ s")
            else:
                self.assertGreater(speed, 5e-3)
                self.assertIn("not settled after 0.02 s", log)


if __name__ == "__main__":
    unittest.main()
