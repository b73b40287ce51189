#!/usr/bin/python3
"""The tables of the validation scripts, from a made-up results folder whose numbers can be worked out by hand."""

import contextlib
import io
import json
import os
import pathlib
import sys
import tempfile
import unittest

TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(TOP / "tools" / "validation"))

import campaign  # noqa: E402  (the path has to be set first)
import tabulate  # noqa: E402

SUMMARY = {
    "status": "done", "simulated_seconds": 2.0, "wall_seconds": 50.0, "wall_seconds_per_simulated_second": 25.0,
    "wall_by_part": {"contacts": 30.0, "gas": 15.0, "heat": 0.0}, "threads": 2, "particles": 10, "lost_particles": 1,
    "particles_left_through_open_sides": 2, "largest_overlap_ratio": 0.125, "largest_impact_speed": 1.5,
    "contacts_per_particle": 2.5, "defects": {"gas_mass": 1.23e-13, "momentum": 4.5e-9},
}


def make_results(folder, velocities):
    for name in ("lines", "probes"):
        (folder / name).mkdir(parents=True)
    (folder / "summary.json").write_text(json.dumps(SUMMARY), encoding="utf-8")
    rows = [f"{0.5 + i},{v},0.1,{n}" for i, (v, n) in enumerate(velocities)]
    (folder / "lines" / "low.csv").write_text(
        "\n".join(["x [m],particle_velocity_z [m/s],standard_deviation [m/s],samples [-]", *rows]) + "\n",
        encoding="utf-8")
    (folder / "probes" / "bed.csv").write_text(
        "time [s],pressure_drop [Pa]\n0,1000\n1,10\n2,20\n3,60\n", encoding="utf-8")


def table(*words):
    """The rows of a table as lists of cells, header first."""
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        code = tabulate.main([str(word) for word in words])
    assert code == 0
    rows = [line.strip("|").split("|") for line in text.getvalue().splitlines()]
    return [[cell.strip() for cell in row] for i, row in enumerate(rows) if i != 1]


class Tables(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        top = pathlib.Path(self.folder.name)
        make_results(top / "a", [(1, 10), (3, 10), (5, 30), ("nan", 0)])
        make_results(top / "b", [(2, 10), (3, 10), (3, 30), (0, 1)])
        self.a, self.b = f"A={top / 'a'}", f"B={top / 'b'}"
        self.top = top

    def test_summary(self):
        header, row = table("summary", self.a)
        cells = dict(zip(header, row))
        self.assertEqual(cells["state"], "done")
        self.assertEqual(cells["lost"], "3")  # lost, and left through open sides
        self.assertEqual(cells["largest overlap [% of R]"], "12.5")
        self.assertEqual(cells["defect of gas mass"], "1.2e-13")

    def test_parts_leave_out_what_took_no_time(self):
        header, row = table("parts", self.a)
        self.assertEqual(header, ["run", "wall [s]", "contacts [%]", "gas [%]"])
        self.assertEqual(row, ["A", "50", "60", "30"])

    def test_bed_takes_the_rows_of_its_window(self):
        # 10 (not after the start), 20, 60: mean of the last two 40, deviation 20.
        _, row = table("bed", self.a, "--quantities", "pressure_drop", "--from", 1)
        self.assertEqual(row, ["A", "40", "20"])
        _, row = table("bed", self.a, "--quantities", "pressure_drop", "--from", 0.5, "--to", 2)
        self.assertEqual(row, ["A", "15", "5"])

    def test_spout(self):
        # Centre at 1 m, halfway between 1 and 3. Annulus: the bins at 2.5 m only (3.5 m has no samples).
        _, row = table("spout", self.a, "--lines", "low", "--centre", 1, "--annulus", 1.5)
        self.assertEqual(row, ["A", "2", "5", "5", "1"])
        # From 0.5 m on, the bins at 0.5, 1.5 and 2.5 m, weighted by samples: (10 + 30 + 150) / 50.
        _, row = table("spout", self.a, "--lines", "low", "--centre", 1, "--annulus", 0.5)
        self.assertEqual(row[3], "3.8")

    def test_difference(self):
        # B - A at the three bins that A has: 1, 0, -2.
        header, row, scatter = table("difference", self.a, self.b, "--lines", "low", "--scatter", "low:low")
        self.assertEqual(header[2], "RMS difference from A")
        self.assertEqual(row, ["B", "low", "1.29", "-2", "25.8"])
        self.assertEqual(scatter, ["A itself", "low from low", "0", "0", "0"])

    def test_what_is_missing_is_named(self):
        for words in (["summary", "X=/nowhere"], ["profiles", self.a, "--lines", "high"],
                      ["bed", self.a, "--quantities", "bed_height"], ["bed", self.a, "--from", "99"]):
            with contextlib.redirect_stderr(io.StringIO()) as message:
                self.assertEqual(tabulate.main(words), 2)
            self.assertRegex(message.getvalue(), "tabulate: .*(summary.json|high.csv|bed_height|bed.csv)")

    def test_reference_of_the_mueller_bed_names_lines_of_its_case(self):
        folder = TOP / "cases" / "mueller_bed"
        case = (folder / "case.yaml").read_text(encoding="utf-8")
        points = {path.stem: len(next(iter(tabulate.read_csv(path).values())))
                  for path in (folder / "reference").glob("*.csv")}
        self.assertEqual(points, {"void_fraction_z16p4mm": 22, "void_fraction_z31p2mm": 22,
                                  "particle_velocity_z19p9mm": 26})
        for name in points:
            self.assertIn(f"name: {name},", case)


class Campaign(unittest.TestCase):
    def test_a_run_is_finished_when_it_is_done_as_far_as_asked(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            self.assertFalse(campaign.finished(folder, 2))
            for state, end, expected in (("done", 2, True), ("done", 4, False), ("running", 1, False),
                                         ("stopped", 2, True), ("stopped", 4, False), ("failed", 1, False)):
                (folder / "summary.json").write_text(json.dumps(SUMMARY | {"status": state}), encoding="utf-8")
                self.assertEqual(campaign.finished(folder, end), expected, (state, end))


if __name__ == "__main__":
    sys.exit(unittest.main())
