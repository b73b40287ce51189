#!/usr/bin/python3
"""Shows a field of the gas in a plane, with arrows for the velocity in it, from the snapshots of a results folder.

    gas_image.py results/heated_cavity --field temperature -o cavity.png
    gas_image.py results/single_spout --field pressure --axis y --at 0.01 --time 2.5 -o spout.png

Prints the smallest and the largest value shown.
"""

import argparse

import numpy as np

from pellicle_results import Results, fail
from plot_style import use_style

UNITS = {"temperature": "K", "pressure": "Pa", "density": "kg/m³", "speed": "m/s"}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="results folder")
    parser.add_argument("--field", default="pressure", help="a field of gas.h5 with one number a cell, or speed")
    parser.add_argument("--axis", choices="xyz", default="y", help="normal of the plane; default: y")
    parser.add_argument("--at", type=float, help="where the plane cuts that axis [m]; default: the middle")
    parser.add_argument("--time", type=float, default=np.inf, help="the snapshot nearest to it [s]; default: the last")
    parser.add_argument("--arrows", type=int, default=20, help="along the longer side; 0: none")
    parser.add_argument("-o", "--output", required=True, help="picture: .png, .pdf or .svg")
    return parser.parse_args()


def cut(values, normal, layer):
    """The layer of cells of an array nz x ny x nx, slower index first."""
    return np.take(values, layer, axis=2 - normal)


def main():
    arguments = parse_arguments()
    results = Results(arguments.results)
    times = results.gas_times()
    if not times:
        fail(f"{arguments.results}: there are no snapshots of gas")
    snapshot = results.gas(min(arguments.time, times[-1]))
    faces = list(results.gas_grid().values())
    normal = "xyz".index(arguments.axis)
    across, up = [axis for axis in range(3) if axis != normal]
    middle = 0.5 * (faces[normal][0] + faces[normal][-1])
    at = middle if arguments.at is None else arguments.at
    if not faces[normal][0] <= at <= faces[normal][-1]:
        fail(f"--at {at} is outside the domain; {faces[normal][0]:g} to {faces[normal][-1]:g} m")
    layer = min(np.searchsorted(faces[normal], at, side="right") - 1, len(faces[normal]) - 2)
    if arguments.field == "speed" and "velocity" in snapshot:
        values = np.linalg.norm(snapshot["velocity"], axis=-1)
    elif arguments.field in snapshot and np.ndim(snapshot[arguments.field]) == 3:
        values = snapshot[arguments.field]
    else:
        known = [name for name in snapshot if name != "time" and np.ndim(snapshot[name]) == 3]
        fail(f"no field {arguments.field}; {', '.join(known)}" + (", speed" if "velocity" in snapshot else ""))
    shown = cut(values, normal, layer)
    plt = use_style()
    width, height = (faces[axis][-1] - faces[axis][0] for axis in (across, up))
    figure, panel = plt.subplots(layout="constrained", figsize=(1.2 + 4.2 * min(1, width / height),
                                                                0.6 + 4.2 * min(1, height / width)))
    panel.grid(False)
    colours = panel.pcolormesh(faces[across], faces[up], shown, cmap="viridis", shading="flat")
    unit = UNITS.get(arguments.field)
    figure.colorbar(colours, label=arguments.field.replace("_", " ") + (f" [{unit}]" if unit else ""), shrink=0.9)
    if arguments.arrows > 0 and "velocity" in snapshot:
        velocity = cut(snapshot["velocity"], normal, layer)
        stride = max(1, int(np.ceil(max(shown.shape) / arguments.arrows)))
        centres = [0.5 * (faces[axis][1:] + faces[axis][:-1])[stride // 2::stride] for axis in (across, up)]
        sampled = velocity[stride // 2::stride, stride // 2::stride]
        panel.quiver(*centres, sampled[..., across], sampled[..., up], color="white", width=0.003)
    panel.set_aspect("equal")
    panel.set_xlabel(f"{'xyz'[across]} [m]")
    panel.set_ylabel(f"{'xyz'[up]} [m]")
    panel.set_title(f"t = {snapshot['time']:.4g} s, {arguments.axis} = {at:.4g} m")
    figure.savefig(arguments.output)
    print(f"{arguments.output}: {arguments.field} from {shown.min():.6g} to {shown.max():.6g}")


if __name__ == "__main__":
    main()
