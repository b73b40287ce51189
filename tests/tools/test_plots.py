#!/usr/bin/python3
"""The plotting scripts against made-up results whose deviations are known by hand."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
PLOT = TOP / "tools" / "plot"


def run(script, *arguments):
    return subprocess.run([sys.executable, str(PLOT / script), *map(str, arguments)], capture_output=True, text=True)


def write_line(folder, name, value):
    (folder / "lines").mkdir(parents=True, exist_ok=True)
    rows = "".join(f"{x:.9g},{value(x):.9g},0.1,100\n" for x in np.linspace(0.005, 0.095, 10))
    (folder / "lines" / f"{name}.csv").write_text(
        "x [m],void_fraction [-],standard_deviation [-],samples [-]\n" + rows)


def write_snapshots(folder):
    with h5py.File(folder / "particles.h5", "w") as h5:
        for step in range(3):
            group = h5.create_group(f"step{step:010}")
            group.attrs["time"], group.attrs["step"] = 0.1 * step, step
            group["position"] = np.array([[0.02, 0.01, 0.02 + 0.01 * step], [0.06, 0.01, 0.03]])
            group["velocity"] = np.array([[0, 0, 0.1], [0.2, 0, 0]])
            group["radius"] = np.array([0.005, 0.004])
    with h5py.File(folder / "spray.h5", "w") as h5:
        for step in range(3):
            group = h5.create_group(f"step{step:010}")
            group.attrs["time"], group.attrs["step"] = 0.1 * step, step
            group["position"] = np.array([[0.05, 0.01, 0.01 * n] for n in range(step)]).reshape(-1, 3)
            group["diameter"] = np.full(step, 50e-6)
    with h5py.File(folder / "gas.h5", "w") as h5:
        for axis, cells, length in (("x", 10, 0.1), ("y", 2, 0.02), ("z", 8, 0.08)):
            h5[f"grid/{axis}"] = np.linspace(0, length, cells + 1)
        for step in range(3):
            group = h5.create_group(f"step{step:010}")
            group.attrs["time"], group.attrs["step"] = 0.1 * step, step
            group["velocity"] = np.ones((8, 2, 10, 3)) * [0, 0, 1.0]
            group["void_fraction"] = np.full((8, 2, 10), 0.5)


class Plots(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def test_deviations_by_hand(self):
        results = self.folder / "linear"
        write_line(results, "void", lambda x: 0.4 + x)
        write_line(results, "other", lambda x: 0.4)
        reference = self.folder / "measured.csv"
        # Two points off by +0.03 and -0.04 halfway between bins, one right, one beyond the outermost bin's centre.
        reference.write_text("# made up\nx_m,voidage\n0.02,0.39\n0.05,0.49\n0.07,0.47\n0.099,0.9\n")
        picture, table = self.folder / "p.png", self.folder / "t.csv"
        done = run("plot_profiles.py", results, "--line", "void", "--reference", f"void={reference}", "--table", table,
                   "-o", picture)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(picture.stat().st_size, 5000)
        header, row = (line.split(",") for line in table.read_text().splitlines())
        found = dict(zip(header, row))
        self.assertEqual((found["points"], found["left out"]), ("3", "1"))
        # Simulated 0.42, 0.45, 0.47: deviations +0.03, -0.04, 0; RMS sqrt((9 + 16) / 3) / 100; peak 0.9.
        self.assertAlmostEqual(float(found["RMS deviation"]), (25 / 3) ** 0.5 / 100, delta=1e-5)
        self.assertAlmostEqual(float(found["largest deviation"]), -0.04, delta=1e-5)
        self.assertAlmostEqual(float(found["at [m]"]), 0.05, delta=1e-9)
        self.assertAlmostEqual(float(found["largest / peak [%]"]), 100 * 0.04 / 0.9, delta=0.06)

    def test_reference_needs_its_line(self):
        results = self.folder / "two"
        write_line(results, "a", lambda x: x)
        write_line(results, "b", lambda x: x)
        reference = self.folder / "measured.csv"
        reference.write_text("x_m,voidage\n0.02,0.39\n")
        done = run("plot_profiles.py", results, "--reference", reference, "-o", self.folder / "p.png")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("LINE=FILE", done.stderr)

    def test_bed_images(self):
        results = self.folder / "bed"
        results.mkdir()
        write_snapshots(results)
        for options in (["--frames", "2"], ["--time", "0.1", "--gas", "void_fraction"], ["--gas", "none"]):
            picture = self.folder / "bed.png"
            done = run("bed_image.py", results, *options, "-o", picture)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertGreater(picture.stat().st_size, 5000)
            picture.unlink()
        done = run("bed_image.py", results, "--frames", "2", "-o", self.folder / "bed.png")
        self.assertIn("t = 0.1, 0.2 s", done.stdout)

    def test_droplets_in_the_picture(self):
        from matplotlib.image import imread

        results = self.folder / "sprayed"
        results.mkdir()
        write_snapshots(results)
        picture = self.folder / "bed.png"
        blue = []
        for time in ("0", "0.1", "0.2"):  # with none, one and two parcels
            done = run("bed_image.py", results, "--gas", "none", "--spray", "100", "--time", time, "-o", picture)
            self.assertEqual(done.returncode, 0, done.stderr)
            red, green, over = (imread(picture)[..., channel] for channel in range(3))
            blue.append(np.count_nonzero((red < 0.02) & (abs(green - 0.651) < 0.02) & (abs(over - 0.839) < 0.02)))
        self.assertEqual(blue[0], 0)
        self.assertGreater(blue[1], 30)
        self.assertAlmostEqual(blue[2], 2 * blue[1], delta=0.2 * blue[1])
        (results / "spray.h5").unlink()
        done = run("bed_image.py", results, "--spray", "100", "-o", picture)
        self.assertIn("holds no snapshots of a spray", done.stderr)

    def test_gas_image(self):
        results = self.folder / "gas"
        results.mkdir()
        write_snapshots(results)
        picture = self.folder / "gas.png"
        done = run("gas_image.py", results, "--field", "void_fraction", "--time", "0.1", "-o", picture)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("void_fraction from 0.5 to 0.5", done.stdout)
        self.assertGreater(picture.stat().st_size, 5000)
        done = run("gas_image.py", results, "--field", "speed", "--axis", "z", "--at", "0.035", "-o", picture)
        self.assertIn("speed from 1 to 1", done.stdout)
        done = run("gas_image.py", results, "--field", "heat", "-o", picture)
        self.assertIn("no field heat; velocity, void_fraction, speed", done.stderr)
        done = run("gas_image.py", results, "--field", "speed", "--at", "1", "-o", picture)
        self.assertIn("0 to 0.02 m", done.stderr)
        done = run("gas_image.py", results, "--field", "velocity_rms", "-o", picture)
        self.assertIn("there are no averages of gas", done.stderr)
        with h5py.File(results / "gas_average.h5", "w") as h5:
            for axis, cells, length in (("x", 10, 0.1), ("y", 2, 0.02), ("z", 8, 0.08)):
                h5[f"grid/{axis}"] = np.linspace(0, length, cells + 1)
            group = h5.create_group("average")
            group.attrs["from"], group.attrs["time"], group.attrs["step"] = 1.0, 4.0, 4000
            group["velocity_mean"] = np.ones((8, 2, 10, 3)) * [0, 3, 4.0]
            group["velocity_rms"] = np.ones((8, 2, 10, 3)) * [0.5, 0, 1.2]
            group["pressure_mean"] = np.full((8, 2, 10), 7.0)
        for field, value in (("velocity_mean", 5), ("velocity_mean_z", 4), ("velocity_rms_x", 0.5), ("velocity_rms", 1.3),
                             ("pressure_mean", 7)):
            done = run("gas_image.py", results, "--field", field, "-o", picture)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"{field} from {value:g} to {value:g}", done.stdout)
        done = run("gas_image.py", results, "--field", "heat_mean", "-o", picture)
        self.assertIn("no field heat_mean; pressure_mean, velocity_mean, velocity_rms", done.stderr)

    def test_series(self):
        results = self.folder / "series"
        (results / "probes").mkdir(parents=True)
        (results / "probes" / "bed.csv").write_text("time [s],bed_height [m]\n0,1\n1,2\n2,4\n3,6\n")
        done = run("plot_series.py", results, "--from", "1", "--to", "2.5", "-o", self.folder / "s.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("bed_height: mean 3, standard deviation 1\n", done.stdout)

    def test_messages(self):
        done = run("bed_image.py", self.folder / "none", "-o", "x.png")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("no such results folder", done.stderr)


if __name__ == "__main__":
    unittest.main()
