#!/usr/bin/python3
"""Runs with wet particles in warm air: their books close, their outputs show it, they resume bit for bit and do not depend
on the number of threads; and what a case may not say about heat is refused."""
import csv
import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ.get("PELLICLE_PROGRAM")

# A spouted handful of wet beads in hot dry air; drier and colder ones fall in from above, some leave through the top.
CASE = """
domain: {min: [0, 0, 0], max: [0.03, 0.03, 0.08]}
time: {end: "0.06 s", gas_step: "2e-4 s", particle_step: "1e-5 s", settle: "0.01 s"}
materials:
  bead: {density: 1500, youngs_modulus: 1e6, poisson_ratio: 0.3, heat_capacity: 900}
contacts:
  pairs:
    - {between: [bead, bead], restitution: 0.8, sliding_friction: 0.3}
    - {between: [bead, wall], restitution: 0.8, sliding_friction: 0.3}
particles:
  - {material: bead, count: 150, diameter: "2 mm", initial_temperature: "60 degC", initial_liquid: 1e-6, initial_solids: 0.001,
     fill: {box: {min: [0, 0, 0], max: [0.03, 0.03, 0.04]}}}
  - {material: bead, diameter: "2 mm", initial_liquid: 0.01, velocity: [0, 0, -0.1],
     feed: {box: {min: [0.005, 0.005, 0.06], max: [0.025, 0.025, 0.06]}, rate: 500, from: "0.01 s"}}
  - {material: bead, diameter: "2 mm", initial_temperature: "20 degC", initial_liquid: 0.02,
     list: [{position: [0.015, 0.015, 0.07], velocity: [0, 0, 0.6]}]}
walls:
  - {name: vessel, box: domain, open: [top], material: wall}
gas:
  density: {law: ideal_gas}
  viscosity: {law: sutherland}
  heat: {initial_temperature: "80 degC"}
  moisture: {initial_relative_humidity: 0.02}
  grid: {cells: [6, 6, 16]}
  solver: {pressure_tolerance: 1e-13, momentum_tolerance: 1e-12}
  boundaries:
    - {name: in, on: bottom, inlet: {velocity: "1.5 m/s", temperature: "80 degC", relative_humidity: 0.02}}
    - {name: out, on: top, outlet: {}}
coupling: {transfer_grid: {cells: [TRANSFER]}}
heat: {stefan_flow: true}
output:
  checkpoint: {every: "0.03 s"}
  snapshots: {every: "0.03 s", particles: [id, temperature, film_liquid, film_solids, coating_thickness]}
  lines:
    - {name: axis, from: [0.015, 0.015, 0], to: [0.015, 0.015, 0.08], points: 8, quantity: particle_temperature,
       average: {from: "0.03 s"}}
  probes:
    - {name: one, particle: 0, every: "0.01 s",
       quantities: [particle_temperature, film_liquid, film_solids, coating_thickness]}
    - {name: high, point: [0.015, 0.015, 0.075], every: "0.01 s", quantities: [gas_temperature, vapour_mass_fraction]}
"""


@unittest.skipUnless(PROGRAM, "PELLICLE_PROGRAM is not set")
class ParticleHeat(unittest.TestCase):
    def start(self, place, name, text, *options, threads="1"):
        case = Path(place) / "case.yaml"
        case.write_text(text, encoding="utf-8")
        return subprocess.run([PROGRAM, "run", str(case), "--output", str(Path(place) / name), "--threads", threads, *options],
                              capture_output=True, text=True, check=False)

    def run_case(self, place, name, *options, transfer="6, 6, 16", threads="1"):
        run = self.start(place, name, CASE.replace("TRANSFER", transfer), *options, threads=threads)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return json.loads((Path(place) / name / "summary.json").read_text(encoding="utf-8"))

    def rows(self, place, name):
        with open(Path(place) / name, encoding="utf-8") as file:
            return list(csv.reader(file))

    def test_books_close_and_outputs_show_it(self):
        for transfer in ("6, 6, 16", "3, 3, 8"):
            with self.subTest(transfer=transfer), tempfile.TemporaryDirectory() as place:
                summary = self.run_case(place, "whole", transfer=transfer)
                self.assertGreater(summary["particles_fed"], 10)
                self.assertEqual(summary["particles_left_through_open_sides"], 1)
                self.assertLess(summary["defects"]["gas_mass"], 1e-10)
                self.assertLess(summary["defects"]["energy"], 1e-8)
                self.assertLess(summary["defects"]["water"], 1e-12)
                self.assertGreater(summary["wall_by_part"]["heat"], 0)
                one = self.rows(place, "whole/probes/one.csv")
                self.assertEqual(one[0], ["time [s]", "particle_temperature [K]", "film_liquid [kg]", "film_solids [kg]",
                                          "coating_thickness [m]"])
                # The listed particle counts first: 0.02 of its mass is water, and it leaves. Its mass is 6.2832e-6 kg.
                first = [float(x) for x in one[1]]
                self.assertAlmostEqual(first[1], 293.15, places=9)
                self.assertAlmostEqual(first[2] / (0.02 * 1500 * 4 / 3 * math.pi * 1e-9), 1, delta=1e-8)
                self.assertEqual(first[3], 0)
                # Warm air loses heat to the beads and gains vapour.
                high = self.rows(place, "whole/probes/high.csv")
                self.assertLess(float(high[-1][1]), 353.15)
                self.assertGreater(float(high[-1][2]), float(high[1][2]))

    def test_books_close_where_the_gas_gives_without_losing(self):
        # One way: what the beads took and gave is a source in the books, and the gas knows nothing of it.
        case = CASE.replace("TRANSFER", "6, 6, 16").replace("coupling: {", "coupling: {exchange: one_way, ")
        with tempfile.TemporaryDirectory() as place:
            run = self.start(place, "one", case)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            summary = json.loads((Path(place) / "one" / "summary.json").read_text(encoding="utf-8"))
            self.assertLess(summary["defects"]["energy"], 1e-8)
            self.assertLess(summary["defects"]["water"], 1e-12)
            high = self.rows(place, "one/probes/high.csv")
            self.assertAlmostEqual(float(high[-1][1]), 353.15, places=6)
            one = self.rows(place, "one/probes/one.csv")
            self.assertGreater(float(one[2][1]), float(one[1][1]))

    def test_goes_on_bit_for_bit(self):
        with tempfile.TemporaryDirectory() as place:
            whole = self.run_case(place, "whole")
            self.run_case(place, "halves", "--until", "0.03 s")
            halves = self.run_case(place, "halves", "--resume")
            self.assertEqual(whole["defects"], halves["defects"])
            for name in ("probes/high.csv", "probes/one.csv", "lines/axis.csv"):
                self.assertEqual((Path(place) / "whole" / name).read_bytes(), (Path(place) / "halves" / name).read_bytes())
            two = self.run_case(place, "two", threads="2")
            self.assertEqual(whole["defects"], two["defects"])
            for name in ("probes/high.csv", "probes/one.csv", "lines/axis.csv"):
                self.assertEqual((Path(place) / "whole" / name).read_bytes(), (Path(place) / "two" / name).read_bytes())

    # Films that weigh, contacts that conduct, a vessel that is warmer than what lies in it.
    CONDUCTING = (
        CASE.replace("TRANSFER", "6, 6, 16")
        .replace("heat_capacity: 900", "heat_capacity: 900, conductivity: 0.5, true_youngs_modulus: 1e9")
        .replace("open: [top], material: wall}", "open: [top], material: wall, temperature: \"120 degC\"}")
        .replace("heat: {stefan_flow: true}", "heat: {contact_conduction: true}\ncoating: {growth: mass}")
        .replace("  probes:\n", "  probes:\n    - {name: vessel, wall: vessel, every: \"0.01 s\"}\n    - {name: bed, bed: {}, every: \"0.01 s\"}\n")
    )

    def run_conducting(self, place, name, *options, threads="1"):
        run = self.start(place, name, self.CONDUCTING, *options, threads=threads)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return json.loads((Path(place) / name / "summary.json").read_text(encoding="utf-8"))

    def test_books_close_with_conduction_and_films_that_weigh(self):
        with tempfile.TemporaryDirectory() as place:
            whole = self.run_conducting(place, "whole")
            self.assertGreater(whole["particles_fed"], 10)
            self.assertLess(whole["defects"]["energy"], 1e-8)
            self.assertLess(whole["defects"]["water"], 1e-12)
            self.assertLess(whole["defects"]["particle_mass"], 1e-12)
            # What the gas solver leaves (2e-8 without growth); films unbooked would be 1e-3.
            self.assertLess(whole["defects"]["momentum"], 1e-7)
            # The warm vessel loses heat; the probe's rates, each over 0.01 s, add up to it.
            heat = whole["walls"]["vessel"]["heat"]
            self.assertLess(heat, 0)
            self.assertAlmostEqual(whole["walls"]["vessel"]["mean_heat_rate"] / (heat / 0.06), 1, places=12)
            rows = self.rows(place, "whole/probes/vessel.csv")
            rate, total = rows[0].index("wall_heat_rate [W]"), rows[0].index("wall_heat [J]")
            self.assertAlmostEqual(float(rows[-1][total]) / heat, 1, places=8)
            self.assertAlmostEqual(sum(float(row[rate]) for row in rows[1:]) * 0.01 / heat, 1, places=7)
            # On and after a restart, and on two threads, the same bits.
            self.run_conducting(place, "halves", "--until", "0.03 s")
            halves = self.run_conducting(place, "halves", "--resume")
            two = self.run_conducting(place, "two", threads="2")
            for other, summary in (("halves", halves), ("two", two)):
                self.assertEqual(whole["defects"], summary["defects"])
                self.assertEqual(whole["walls"], summary["walls"])
                for name in ("probes/high.csv", "probes/one.csv", "probes/vessel.csv", "probes/bed.csv"):
                    self.assertEqual((Path(place) / "whole" / name).read_bytes(),
                                     (Path(place) / other / name).read_bytes(), other + name)

    def test_refuses_what_cannot_be(self):
        case = CASE.replace("TRANSFER", "6, 6, 16")
        closed = case.replace("    - {name: in, on: bottom, inlet: {velocity: \"1.5 m/s\", temperature: \"80 degC\", "
                              "relative_humidity: 0.02}}\n    - {name: out, on: top, outlet: {}}\n",
                              "    - {name: out, on: top, wall: {}}\n").replace("{law: ideal_gas}", "1.0")
        for text, says in (
                (case.replace(", heat_capacity: 900", ""), "materials.bead.heat_capacity: missing"),
                (case.replace("heat: {stefan_flow: true}", "heat: {nusselt: gun}"), "gunn"),
                (case.replace("heat: {stefan_flow: true}\n", ""), "initial_liquid: without heat it is of no use"),
                (closed, "heat.evaporation: the vapour needs an outlet"),
                (self.CONDUCTING.replace("conductivity: 0.5, ", ""), "materials.bead.conductivity: missing"),
                (self.CONDUCTING.replace("{contact_conduction: true}", "{}"), "walls.vessel.temperature: nothing conducts"),
                (case.replace("  probes:\n", "  probes:\n    - {name: w, wall: vessel, every: 0.01, quantities: [wall_heat]}\n"),
                 "wall_heat needs heat.contact_conduction"),
                (self.CONDUCTING.replace(", temperature: \"120 degC\"}", "}").replace(
                    "{name: vessel, wall: vessel, every: \"0.01 s\"}",
                    "{name: vessel, wall: vessel, every: 0.01, quantities: [wall_heat]}"), "wall_heat needs a wall with a temperature"),
        ):
            with tempfile.TemporaryDirectory() as place:
                run = self.start(place, "refused", text)
                self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
                self.assertIn(says, run.stdout + run.stderr)


if __name__ == "__main__":
    unittest.main()
