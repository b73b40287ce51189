#!/usr/bin/python3
"""Draws the gas on one layer of cells: speed or another field in colours, with streamlines in the plane.

    gas_plane.py results/wurster_empty -o jet.png                         # the middle plane across y, last snapshot
    gas_plane.py results/wurster_empty --across z --at 0.05 -o tube.png
    gas_plane.py results/wurster_empty --field pressure --time 0.1 -o pressure.png

Cells where nothing moves and the pressure is 0, outside of the vessel, stay white.
"""

import argparse

import numpy as np

from pellicle_results import Results, fail
from plot_style import use_style

AXES = "xyz"


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="results folder")
    parser.add_argument("--across", choices=list(AXES), default="y", help="axis that the plane is across")
    parser.add_argument("--at", type=float, help="where along that axis [m]; default: the middle")
    parser.add_argument("--time", type=float, help="simulated time [s]; default: the last snapshot")
    parser.add_argument("--field", default="speed", help="speed, or the name of a field of one number a cell")
    parser.add_argument("--largest", type=float, help="upper end of the colours; default: 99.5 %% quantile")
    parser.add_argument("--height", type=float, help="draw up to here [m]")
    parser.add_argument("-o", "--output", required=True, help="picture: .png, .pdf or .svg")
    return parser.parse_args()


def layer(field, axis, index):
    """The cells of one layer as [vertical, horizontal]; fields are nz x ny x nx (x 3)."""
    return np.take(field, index, axis=2 - axis)


def main():
    arguments = parse_arguments()
    results = Results(arguments.results)
    times = results.gas_times()
    if not times:
        fail(f"{arguments.results}: there are no snapshots of the gas")
    snapshot = results.gas(arguments.time if arguments.time is not None else times[-1])
    grid = results.gas_grid()
    axis = AXES.index(arguments.across)
    faces = grid[arguments.across]
    at = arguments.at if arguments.at is not None else 0.5 * (faces[0] + faces[-1])
    index = int(np.clip(np.searchsorted(faces, at, side="right") - 1, 0, len(faces) - 2))
    horizontal, vertical = [a for a in range(3) if a != axis]
    velocity = layer(snapshot["velocity"], axis, index)
    speed = np.linalg.norm(velocity, axis=-1)
    if arguments.field == "speed":
        values, label = speed, "speed of the gas [m/s]"
    elif arguments.field in snapshot and snapshot[arguments.field].ndim == 3:
        values, label = layer(snapshot[arguments.field], axis, index), arguments.field.replace("_", " ")
    else:
        fail(f"no field {arguments.field} of one number a cell; there are {', '.join(sorted(snapshot))}")
    empty = speed == 0
    if "pressure" in snapshot:
        empty &= layer(snapshot["pressure"], axis, index) == 0
    shown = np.ma.masked_where(empty, values)
    plt = use_style()
    x, z = grid[AXES[horizontal]] * 1000, grid[AXES[vertical]] * 1000
    top = min(z[-1], arguments.height * 1000) if arguments.height else z[-1]
    size = 6.5
    figure, axes = plt.subplots(figsize=(max(2.6, size * (x[-1] - x[0]) / (top - z[0])) + 1.2, size))
    largest = arguments.largest or float(np.quantile(shown.compressed(), 0.995))
    picture = axes.pcolormesh(x, z, shown, cmap="viridis", vmin=min(0.0, float(shown.min())), vmax=largest)
    # Streamlines need even spacing.
    across, up = 0.5 * (x[1:] + x[:-1]), 0.5 * (z[1:] + z[:-1])
    even_x = np.linspace(across[0], across[-1], 200)
    even_z = np.linspace(up[0], up[-1], 300)
    columns = np.clip(np.searchsorted(x, even_x) - 1, 0, len(across) - 1)
    rows = np.clip(np.searchsorted(z, even_z) - 1, 0, len(up) - 1)
    pick = np.ix_(rows, columns)
    u, w = velocity[..., horizontal][pick], velocity[..., vertical][pick]
    still = empty[pick]
    axes.streamplot(even_x, even_z, np.ma.masked_where(still, u), np.ma.masked_where(still, w), density=1.6,
                    color="white", linewidth=0.5, arrowsize=0.6)
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(z[0], top)
    axes.set_aspect("equal")
    axes.grid(False)
    axes.set_xlabel(f"{AXES[horizontal]} [mm]")
    axes.set_ylabel(f"{AXES[vertical]} [mm]")
    axes.set_title(f"t = {snapshot['time']:.3g} s")
    figure.colorbar(picture, ax=axes, label=label, shrink=0.8, extend="max")
    figure.savefig(arguments.output, bbox_inches="tight")


if __name__ == "__main__":
    main()
