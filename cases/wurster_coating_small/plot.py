#!/usr/bin/python3
"""Coating of a run in one picture: thickness histogram, coating against diameter, mean and variation over time, the bed.

    cases/wurster_coating_small/plot.py results/wurster_coating_small -o coating.png
"""

import argparse
import csv
import pathlib

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    values = np.array(rows[1:], dtype=float)
    return {name.split(" [")[0]: values[:, n] for n, name in enumerate(rows[0])}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path, nargs="+", help="the first one gives all but the histogram")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    first = arguments.results[0]
    figure, axes = plt.subplots(2, 2, figsize=(11, 9))

    with h5py.File(first / "particles.h5") as h5:
        last = sorted(name for name in h5 if name.startswith("step"))[-1]
        time = h5[last].attrs["time"]
        position, radius = h5[last]["position"][...], h5[last]["radius"][...]
        thickness, solids = h5[last]["coating_thickness"][...], h5[last]["film_solids"][...]

    axis = axes[0, 0]
    for results in arguments.results:
        with h5py.File(results / "particles.h5") as h5:
            last = sorted(name for name in h5 if name.startswith("step"))[-1]
            values = h5[last]["coating_thickness"][...] * 1e6
        coated = values[values > 0]
        axis.hist(coated, bins=np.linspace(0, np.percentile(coated, 99), 40), histtype="step",
                  label=f"{results.name}: {len(coated)} of {len(values)} coated")
    axis.set_xlabel("thickness of the coated [µm]")
    axis.set_ylabel("particles")
    axis.set_yscale("log")
    axis.legend(fontsize=8)

    axis = axes[0, 1]
    coated = solids > 0
    axis.scatter(2e3 * radius[coated], solids[coated] * 1e9, s=6, alpha=0.5)
    bins = np.linspace(2e3 * radius.min(), 2e3 * radius.max(), 9)
    middle = 0.5 * (bins[1:] + bins[:-1])
    bin_of = np.clip(np.digitize(2e3 * radius, bins) - 1, 0, 7)
    share = [100 * np.mean(coated[bin_of == b]) if np.any(bin_of == b) else np.nan for b in range(8)]
    axis.set_xlabel("diameter [mm]")
    axis.set_ylabel("coating of a particle [µg]")
    twin = axis.twinx()
    twin.plot(middle, share, "C3o-", ms=4)
    twin.set_ylabel("share of the size that is coated [%]", color="C3")
    twin.set_ylim(bottom=0)

    axis = axes[1, 0]
    series = read(first / "probes" / "coating.csv")
    axis.plot(series["time"], series["coating_mass_mean"] * 1e9)
    axis.set_xlabel("time [s]")
    axis.set_ylabel("mean coating [µg]", color="C0")
    twin = axis.twinx()
    twin.plot(series["time"], series["coating_mass_cov"], "C1")
    twin.set_ylabel("coefficient of variation", color="C1")
    twin.set_yscale("log")

    axis = axes[1, 1]
    slab = np.abs(position[:, 1]) < 0.02
    order = np.argsort(thickness[slab])
    dots = axis.scatter(position[slab, 0][order] * 1e3, position[slab, 2][order] * 1e3, s=8,
                        c=thickness[slab][order] * 1e6, cmap="viridis_r", vmin=0)
    height = np.array([0, 220, 417])
    for side in (-1, 1):
        axis.plot(side * np.array([50, 125, 125]), height, "k", lw=1)
        axis.plot([side * 25, side * 25], [15, 75], "k", lw=2)
    axis.set_aspect("equal")
    axis.set_xlabel("x [mm]")
    axis.set_ylabel("z [mm]")
    figure.colorbar(dots, ax=axis, label="thickness [µm]")
    axis.set_title(f"|y| < 20 mm at t = {time:g} s", fontsize=10)

    figure.tight_layout()
    figure.savefig(arguments.output, dpi=90)
    print(f"{first.name}: {coated.sum()} of {len(coated)} coated, mean diameter of the coated "
          f"{2e3 * radius[coated].mean():.3f} mm, of all {2e3 * radius.mean():.3f} mm; thickness of the coated: median "
          f"{np.median(thickness[coated]) * 1e6:.3g} um, largest {thickness.max() * 1e6:.3g} um")


if __name__ == "__main__":
    main()
