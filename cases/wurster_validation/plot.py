#!/usr/bin/python3
"""The bed from the side, its circulation and the profile at 90 mm, of one run or several beside each other.

    cases/wurster_validation/plot.py results/wurster_validation [MORE] -o validation.png [--from 0.3]

Circulation: velocities of the snapshots from `--from` on, averaged over time and around the axis. More runs add their
profiles."""

import argparse
import csv
import json
import pathlib
import sys

import h5py
import numpy as np

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tools" / "plot"))
from plot_style import COLOURS, use_style  # noqa: E402


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    values = np.array(rows[1:], dtype=float)
    return {name.split(" [")[0]: values[:, n] for n, name in enumerate(rows[0])}


def snapshots(folder, begin):
    with h5py.File(folder / "particles.h5") as h5:
        for name in sorted(n for n in h5 if n.startswith("step")):
            if h5[name].attrs["time"] >= begin:
                yield h5[name].attrs["time"], h5[name]["position"][...], h5[name]["velocity"][...]


def draw_vessel(axis, sides):
    for side in sides:
        axis.plot(side * np.array([50, 125, 125]), [0, 220, 417], "k", lw=1)
        axis.plot([side * 25, side * 25], [15, 75], "k", lw=1.6)
    axis.set_aspect("equal")
    axis.grid(False)
    axis.set_ylabel("z [mm]")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path, nargs="+", help="the first one is drawn whole")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--from", dest="begin", type=float, default=0.3, help="averages from this time on [s]")
    parser.add_argument("--height", type=float, default=250, help="upper end of the pictures [mm]")
    arguments = parser.parse_args()
    plt = use_style()
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.6))

    series = list(snapshots(arguments.results[0], arguments.begin))
    if not series:
        sys.exit(f"{arguments.results[0]}: no snapshot from {arguments.begin:g} s on; allowed: an earlier --from")
    time, position, velocity = series[-1]
    axis = axes[0]
    slab = np.abs(position[:, 1]) < 0.01
    dots = axis.scatter(1e3 * position[slab, 0], 1e3 * position[slab, 2], s=1.5, c=velocity[slab, 2], cmap="coolwarm",
                        vmin=-2, vmax=2)
    figure.colorbar(dots, ax=axis, label="vertical velocity [m/s]", shrink=0.8)
    draw_vessel(axis, (-1, 1))
    axis.set_ylim(0, arguments.height)
    axis.set_xlabel("x [mm]")
    axis.set_title(f"|y| < 10 mm at {time:g} s")

    # Sums over particles of all snapshots in rings of 5 mm.
    edges_r, edges_z = np.arange(0, 0.126, 0.005), np.arange(0, 1e-3 * arguments.height + 1e-9, 0.0075)
    places = np.concatenate([p for _, p, _ in series])
    speeds = np.concatenate([v for _, _, v in series])
    r = np.hypot(places[:, 0], places[:, 1])
    outward = (places[:, 0] * speeds[:, 0] + places[:, 1] * speeds[:, 1]) / np.maximum(r, 1e-12)
    bins = (edges_r, edges_z)
    count = np.histogram2d(r, places[:, 2], bins)[0]
    mean = [np.histogram2d(r, places[:, 2], bins, weights=w)[0] / np.maximum(count, 1) for w in (outward, speeds[:, 2])]
    ring = np.pi * np.diff(edges_r**2)[:, None] * np.diff(edges_z)[None, :]
    density = count / len(series) / ring * np.pi / 6 * 1.749e-3**3
    axis = axes[1]
    axis.pcolormesh(1e3 * edges_r, 1e3 * edges_z, np.where(count > 0, density, np.nan).T, cmap="Greys", vmin=0,
                    vmax=0.6)
    middle_r, middle_z = 0.5e3 * (edges_r[1:] + edges_r[:-1]), 0.5e3 * (edges_z[1:] + edges_z[:-1])
    grid_r, grid_z = np.meshgrid(middle_r, middle_z, indexing="ij")
    seen = count >= 3 * len(series) / 2
    speed = np.hypot(*mean)
    arrows = axis.quiver(grid_r[seen], grid_z[seen], *(m[seen] / np.sqrt(speed[seen] + 1e-12) for m in mean), speed[seen],
                         cmap="plasma", angles="xy", scale=22, width=0.004)
    figure.colorbar(arrows, ax=axis, label="speed [m/s]; grey: solids, black 0.6", shrink=0.8)
    draw_vessel(axis, (1,))
    axis.set_xlim(0, 126)
    axis.set_ylim(0, arguments.height)
    axis.set_xlabel("r [mm]")
    axis.set_title(f"mean of {len(series)} snapshots from {arguments.begin:g} s on")

    axis = axes[2]
    for n, results in enumerate(arguments.results):
        line = read(results / "lines" / "z90mm.csv")
        enough = line["samples"] > 50
        axis.plot(1e3 * line["x"][enough], line["particle_velocity_z"][enough], "o-", ms=3, color=COLOURS[n],
                  label=results.name)
        zone = read(results / "zones" / "tube.csv")
        summary = json.loads((results / "summary.json").read_text())
        each = {part: seconds / summary["simulated_seconds"] for part, seconds in summary["wall_by_part"].items() if seconds}
        top = np.nanargmax(np.where(enough, line["particle_velocity_z"], np.nan))
        print(f"{results.name}: {summary['simulated_seconds']:g} s; largest mean velocity at 90 mm "
              f"{line['particle_velocity_z'][top]:.3f} m/s at x = {1e3 * line['x'][top]:g} mm; entries into the tube "
              f"{zone['entries'][-1]:.0f}, particles x time / entries {zone['steady_cycle_time'][-1]:.3g} s, mean of the "
              f"{zone['cycles'][-1]:.0f} ended cycles {zone['mean_cycle_time'][-1]:.3g} s")
        print("  wall seconds a simulated second: " + ", ".join(f"{part} {s:.0f}" for part, s in each.items()))
    axis.axhline(0, color="k", lw=0.6)
    axis.set_xlabel("x [mm]")
    axis.set_ylabel("mean vertical velocity at z = 90 mm [m/s]")
    axis.legend()

    figure.tight_layout()
    figure.savefig(arguments.output, dpi=90)


if __name__ == "__main__":
    main()
