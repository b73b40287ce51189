#!/usr/bin/python3
"""The end-of-batch prediction against made-up particles whose later coating is known because it was drawn as well."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
SCRIPT = TOP / "tools" / "plot" / "predict_coating.py"
GROUPS = 16


def draw(rng, particles, until, gamma_shape, factor):
    """Entries and gains of stationary renewal processes: gamma cycle times of mean 1 s, exponential gains of mean 1 ug
    times a factor of each particle. Returns for each particle the times of its entries in (0, until) and its gains there;
    what an entry brings is there at once."""
    entries, gains = [], []
    for p in range(particles):
        t = -50 * rng.random()  # long before, so that time 0 is like any other
        times = []
        while t < until:
            t += rng.gamma(gamma_shape, 1 / gamma_shape)
            if 0 < t < until:
                times.append(t)
        entries.append(np.array(times))
        gains.append(1e-9 * factor[p] * rng.exponential(size=len(times)))
    return entries, gains


def write_results(folder, entries, gains, times, classes, longest=4.0, bins=40, initial=None):
    (folder / "zones").mkdir()
    (folder / "histograms").mkdir()
    groups, histogram = [], []
    for time in times:
        rows = tables_at(entries, gains, time, classes, longest, bins, initial or [0.0] * len(entries))
        groups += rows[0] if not groups else rows[0][1:]
        histogram += rows[1] if not histogram else rows[1][1:]
    (folder / "zones" / "pass_groups.csv").write_text("\n".join(groups) + "\n")
    (folder / "histograms" / "pass_times.csv").write_text("\n".join(histogram) + "\n")


def tables_at(entries, gains, time, classes, longest, bins, initial):
    header = ("time [s],size_class [-],diameter_from [m],diameter_to [m],group [-],particles [-],entered [-],entries [-],"
              "cycles [-],cycle_time [s],cycle_time_squared [s2],gain [kg],gain_squared [kg2],time_gain [s kg],"
              "coating [kg],coating_squared [kg2]")
    sums = np.zeros((max(classes) + 1, GROUPS, 11))
    ended, still_open = np.zeros(bins + 1), np.zeros(bins + 1)
    for p, (when, gain) in enumerate(zip(entries, gains)):
        seen = when < time
        t, g = when[seen], gain[seen]
        cycles = np.diff(t)
        # From entry to entry: what the first of the two brought.
        between = g[:-1]
        coating = initial[p] + g.sum()
        row = sums[classes[p], p % GROUPS]
        row += [1, len(t) > 0, len(t), len(cycles), cycles.sum(), (cycles**2).sum(), between.sum(), (between**2).sum(),
                (cycles * between).sum(), coating, coating**2]
        for c in cycles:
            ended[min(bins, int(c / longest * bins))] += 1
        if len(t):
            still_open[min(bins, int((time - t[-1]) / longest * bins))] += 1
    group_rows = [header]
    for c in range(sums.shape[0]):
        for g in range(GROUPS):
            group_rows.append(",".join(map(repr, [float(time), c, 0.0, 0.0, g, *map(float, sums[c, g])])))
    rows = ["time [s],from [s],to [s],cycles [-],open_cycles [-],visits [-]"]
    for b in range(bins + 1):
        to = "inf" if b == bins else repr(longest * (b + 1) / bins)
        rows.append(f"{time!r},{longest * b / bins!r},{to},{ended[b]},{still_open[b]},0")
    return group_rows, rows


def run(folder, *more):
    return subprocess.run([sys.executable, str(SCRIPT), str(folder), "pass", *map(str, more)], capture_output=True,
                          text=True)


class Predict(unittest.TestCase):
    def check(self, gamma_shape, sizes, seed, spray_start=0.0, initial=None):
        rng = np.random.default_rng(seed)
        particles, measured, batch = 3000, 4.0, 40.0
        classes = [p % sizes for p in range(particles)]
        factor = [1 + 0.5 * (c - (sizes - 1) / 2) for c in classes]
        entries, gains = draw(rng, particles, batch, gamma_shape, factor)
        gains = [np.where(when < spray_start, 0, gain) for when, gain in zip(entries, gains)]
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            start = [0.0] if initial else []  # without a first table nothing was coated before
            write_results(folder, entries, gains, [*start, 0.5 * (spray_start + measured), measured], classes,
                          initial=initial)
            (folder / "case.yaml").write_text(f"spray:\n- name: a\n  from: {spray_start}  # [s]\n  to: 40  # [s]\n- name: b\n"
                                              "  from: 30.5  # [s]\noutput:\n- from: -7\n")
            done = run(folder, "--time", batch, "--json", folder / "p.json")
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            found = json.loads((folder / "p.json").read_text())
        coating = np.array([g.sum() for g in gains]) + np.array(initial or 0.0)
        direct = coating.std() / coating.mean()
        prediction = found["predictions"][0]
        # The error of the directly drawn coefficient is about itself / sqrt(2 particles), 1.3 %.
        error = np.hypot(prediction["coating_cov_error"], direct / np.sqrt(2 * particles))
        self.assertLess(abs(prediction["coating_cov"] - direct), 3 * error, (prediction, direct))
        grown = np.hypot(prediction["coating_cov_growth_error"], direct / np.sqrt(2 * particles))
        self.assertLess(abs(prediction["coating_cov_growth"] - direct), 3 * grown, (prediction, direct))
        self.assertLess(prediction["coating_cov_growth_error"], 0.15 * direct)
        self.assertLess(prediction["coating_cov_error"], 0.1 * direct)  # an error bar that says something
        error = np.hypot(prediction["coating_mean_error"], coating.std() / np.sqrt(particles))
        self.assertLess(abs(prediction["coating_mean"] - coating.mean()), 3 * error)
        return found["basis"], prediction

    def test_regular_cycles(self):
        # Gamma with shape 4: var tau = 0.25; exponential gain: var g / mean^2 = 1. By hand sqrt((1 + 0.25) / 40) = 0.177.
        basis, prediction = self.check(4, 1, 1)
        self.assertAlmostEqual(basis["mean_cycle_time"], 1, delta=0.03)
        self.assertAlmostEqual(basis["sd_cycle_time"], 0.5, delta=0.05)
        self.assertAlmostEqual(prediction["coating_cov"], 0.177, delta=0.01)

    def test_long_cycles_are_censored(self):
        # Shape 0.5: var tau = 2, and 4 s see only the shorter part of the long cycles.
        basis, prediction = self.check(0.5, 1, 2)
        self.assertAlmostEqual(basis["sd_cycle_time"], np.sqrt(2), delta=0.25)
        self.assertAlmostEqual(prediction["coating_cov"], np.sqrt(3 / 40), delta=0.03)

    def test_size_classes_add_their_own(self):
        # Two classes with rates 0.75 and 1.25: a quarter, whatever the time.
        basis, prediction = self.check(4, 2, 3)
        self.assertAlmostEqual(basis["variation_of_size_classes"], 0.25, delta=0.03)
        self.assertGreater(prediction["coating_cov"], 0.29)

    def test_what_was_there_at_the_start_stays(self):
        # 20 ug on each at the start, 1 ug/s for 40 s: 60 ug; sqrt(1.25 * 40) / 60 = 0.118 if all started alike. 10 % scatter
        # of the 20 ug adds 2 ug to 7.07: 0.122.
        start = 20e-9 * (1 + 0.1 * np.random.default_rng(9).standard_normal(3000))
        basis, prediction = self.check(4, 1, 5, initial=list(start))
        self.assertAlmostEqual(basis["initial_coating"], 20e-9, delta=0.1e-9)
        self.assertAlmostEqual(prediction["coating_mean"], 60e-9, delta=1.5e-9)
        self.assertAlmostEqual(prediction["coating_cov"], 0.122, delta=0.008)

    def test_classes_that_began_apart(self):
        # 10 and 30 ug at the start, rates 0.75 and 1.25 ug/s: 40 and 80 ug after 40 s, 20 ug about 60.
        start = [10e-9 + 20e-9 * (p % 2) for p in range(3000)]
        _, prediction = self.check(4, 2, 6, initial=start)
        self.assertAlmostEqual(prediction["coating_mean"], 60e-9, delta=1.5e-9)
        self.assertGreater(prediction["coating_cov"], 20 / 60)

    def refused(self, case, particles):
        """What is said of a run whose first table has all particles and whose last has some."""
        rng = np.random.default_rng(3)
        entries, gains = draw(rng, 400, 4.0, 4, np.ones(400))
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_results(folder, entries, gains, [0.0], [0] * 400)
            first = [(folder / f).read_text() for f in ("zones/pass_groups.csv", "histograms/pass_times.csv")]
            for f in ("zones/pass_groups.csv", "histograms/pass_times.csv"):
                (folder / f).unlink()
            (folder / "zones").rmdir()
            (folder / "histograms").rmdir()
            write_results(folder, entries[:particles], gains[:particles], [4.0], [0] * particles)
            for f, begun in zip(("zones/pass_groups.csv", "histograms/pass_times.csv"), first):
                (folder / f).write_text(begun + (folder / f).read_text().split("\n", 1)[1])
            (folder / "case.yaml").write_text(case)
            done = run(folder, "--time", 40)
        self.assertNotEqual(done.returncode, 0)
        return done.stderr

    def test_particles_that_come_and_go_are_refused(self):
        self.assertIn("not the same throughout: 400 at the start, 390 at the end", self.refused("", 390))

    def test_nozzle_that_closes_is_refused(self):
        case = "spray:\n- name: a\n  from: 0  # [s]\n  to: 3  # [s]\noutput:\n- to: -7\n"
        self.assertIn("closes at 3 s", self.refused(case, 400))

    def test_spray_that_begins_later(self):
        # Of 40 s the last 38.5: sqrt((1 + 0.25) / 38.5) = 0.180. Of the 4 s measured 1.5 are without spray.
        basis, prediction = self.check(4, 1, 4, spray_start=1.5)
        self.assertEqual(basis["spray_start"], 1.5)
        self.assertAlmostEqual(basis["sd_gain"], 1e-9, delta=0.06e-9)
        self.assertAlmostEqual(prediction["coating_mean"], 38.5e-9, delta=1.5e-9)
        self.assertAlmostEqual(prediction["coating_cov"], 0.180, delta=0.01)

    def test_cycles_that_come_in_pairs(self):
        # Every second gain repeats the one before: sqrt((2 + 0.25) / 40) = 0.237, of which cycles alone see 0.177.
        rng = np.random.default_rng(5)
        entries, gains = draw(rng, 6000, 40.0, 4, np.ones(6000))
        for gain in gains:
            gain[1::2] = gain[0::2][: len(gain[1::2])]
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_results(folder, entries, gains, [4.0, 8.0], [0] * 6000, longest=8.0)
            self.assertEqual(run(folder, "--time", 40, "--json", folder / "p.json").returncode, 0)
            prediction = json.loads((folder / "p.json").read_text())["predictions"][0]
        self.assertAlmostEqual(prediction["coating_cov"], 0.177, delta=0.01)
        self.assertAlmostEqual(prediction["coating_cov_growth"], 0.237, delta=0.02)

    def test_messages(self):
        with tempfile.TemporaryDirectory() as name:
            done = run(pathlib.Path(name), "--time", 10)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("not there; allowed", done.stderr)


if __name__ == "__main__":
    unittest.main()
