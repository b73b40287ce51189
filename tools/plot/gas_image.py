#!/usr/bin/python3
"""Shows a field of the gas in a plane, with arrows or streamlines of the velocity in it, from the snapshots of a results
folder or from its time averages.

    gas_image.py results/heated_cavity --field temperature -o cavity.png
    gas_image.py results/single_spout --field pressure --axis y --at 0.01 --time 2.5 -o spout.png
    gas_image.py results/wurster_empty --field speed --largest 12 --streamlines -o jet.png
    gas_image.py results/wurster_empty --field velocity_rms_z -o unsteady.png

A name that ends in _mean or _rms is a field of gas_average.h5, and arrows are then those of the mean velocity; _x, _y or _z
behind it is one component of a vector, which is shown by its magnitude without.

Prints the smallest and the largest value shown. Cells without gas, where nothing moves and the pressure is 0, stay white.
"""

import argparse
import re

import numpy as np

from pellicle_results import Results, fail
from plot_style import use_style

UNITS = {"temperature": "K", "pressure": "Pa", "density": "kg/m³", "speed": "m/s", "velocity": "m/s"}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="results folder")
    parser.add_argument("--field", default="pressure", help="a field of gas.h5 or gas_average.h5, one component of it such as velocity_z, or speed")
    parser.add_argument("--axis", choices="xyz", default="y", help="normal of the plane; default: y")
    parser.add_argument("--at", type=float, help="where the plane cuts that axis [m]; default: the middle")
    parser.add_argument("--time", type=float, default=np.inf, help="the snapshot nearest to it [s]; default: the last")
    parser.add_argument("--arrows", type=int, default=20, help="along the longer side; 0: none")
    parser.add_argument("--streamlines", action="store_true", help="in place of arrows")
    parser.add_argument("--largest", type=float, help="upper end of the colours; default: the largest value")
    parser.add_argument("-o", "--output", required=True, help="picture: .png, .pdf or .svg")
    return parser.parse_args()


def cut(values, normal, layer):
    """The layer of cells of an array nz x ny x nx, slower index first."""
    return np.take(values, layer, axis=2 - normal)


def read_fields(results, arguments):
    """Fields by name, face coordinates of the grid along x, y and z, and what the picture is of. Of averages the mean
    velocity and the mean pressure are there by their own names too."""
    if re.search("_(mean|rms)(_[xyz])?$", arguments.field):
        average = results.gas_average()
        if average is None:
            fail(f"{arguments.results}: there are no averages of gas")
        for name in ("velocity", "pressure"):
            if f"{name}_mean" in average:
                average[name] = average[f"{name}_mean"]
        title = f"average over t = {average['from']:.4g} to {average['time']:.4g} s"
        return average, list(results.gas_grid("gas_average.h5").values()), title
    times = results.gas_times()
    if not times:
        fail(f"{arguments.results}: there are no snapshots of gas")
    snapshot = results.gas(min(arguments.time, times[-1]))
    return snapshot, list(results.gas_grid().values()), f"t = {snapshot['time']:.4g} s"


def choose_field(fields, wanted):
    """One number a cell of the field of this name."""
    if wanted == "speed" and "velocity" in fields:
        return np.linalg.norm(fields["velocity"], axis=-1)
    if wanted in fields:
        return fields[wanted] if np.ndim(fields[wanted]) == 3 else np.linalg.norm(fields[wanted], axis=-1)
    vector = fields.get(wanted[:-2])
    if wanted[-2:] in ("_x", "_y", "_z") and np.ndim(vector) == 4:
        return vector[..., "xyz".index(wanted[-1])]
    known = [name for name in fields if np.ndim(fields[name]) >= 3]
    return fail(f"no field {wanted}; {', '.join(known)}" + (", speed" if "velocity" in fields else ""))


def draw_streamlines(panel, faces, velocity, empty):
    """Matplotlib wants them on points at equal distances: each takes the value of its cell."""
    points = [np.linspace(f[0], f[-1], 301)[1:-1] for f in faces]
    cells = [np.clip(np.searchsorted(f, p) - 1, 0, len(f) - 2) for f, p in zip(faces, points)]
    pick = np.ix_(cells[1], cells[0])
    u, v = (np.ma.masked_where(empty[pick], component[pick]) for component in velocity)
    panel.streamplot(*points, u, v, density=1.6, color="white", linewidth=0.5, arrowsize=0.6)
    panel.set_xlim(faces[0][0], faces[0][-1])
    panel.set_ylim(faces[1][0], faces[1][-1])


def main():
    arguments = parse_arguments()
    results = Results(arguments.results)
    snapshot, faces, title = read_fields(results, arguments)
    normal = "xyz".index(arguments.axis)
    across, up = [axis for axis in range(3) if axis != normal]
    middle = 0.5 * (faces[normal][0] + faces[normal][-1])
    at = middle if arguments.at is None else arguments.at
    if not faces[normal][0] <= at <= faces[normal][-1]:
        fail(f"--at {at} is outside the domain; {faces[normal][0]:g} to {faces[normal][-1]:g} m")
    layer = min(np.searchsorted(faces[normal], at, side="right") - 1, len(faces[normal]) - 2)
    values = choose_field(snapshot, arguments.field)
    shown = cut(values, normal, layer)
    if "velocity" in snapshot and "pressure" in snapshot:
        moving = np.any(cut(snapshot["velocity"], normal, layer) != 0, axis=-1)
        shown = np.ma.masked_where(~moving & (cut(snapshot["pressure"], normal, layer) == 0), shown)
        if shown.count() == 0:
            shown = np.ma.array(shown.data)
    plt = use_style()
    width, height = (faces[axis][-1] - faces[axis][0] for axis in (across, up))
    figure, panel = plt.subplots(layout="constrained", figsize=(1.2 + 4.2 * min(1, width / height),
                                                                0.6 + 4.2 * min(1, height / width)))
    panel.grid(False)
    colours = panel.pcolormesh(faces[across], faces[up], shown, cmap="viridis", shading="flat",
                               vmax=arguments.largest)
    unit = UNITS.get(re.sub("_(mean|rms)$", "", re.sub("_[xyz]$", "", arguments.field)))
    beyond = arguments.largest is not None and shown.max() > arguments.largest
    figure.colorbar(colours, extend="max" if beyond else "neither", label=arguments.field.replace("_", " ") + (f" [{unit}]" if unit else ""),
                    shrink=0.9)
    if arguments.streamlines and "velocity" in snapshot:
        draw_streamlines(panel, [faces[axis] for axis in (across, up)],
                         [cut(snapshot["velocity"], normal, layer)[..., axis] for axis in (across, up)],
                         np.ma.getmaskarray(shown))
    elif arguments.arrows > 0 and "velocity" in snapshot:
        velocity = cut(snapshot["velocity"], normal, layer)
        stride = max(1, int(np.ceil(max(shown.shape) / arguments.arrows)))
        centres = [0.5 * (faces[axis][1:] + faces[axis][:-1])[stride // 2::stride] for axis in (across, up)]
        sampled = velocity[stride // 2::stride, stride // 2::stride]
        panel.quiver(*centres, sampled[..., across], sampled[..., up], color="white", width=0.003)
    panel.set_aspect("equal")
    panel.set_xlabel(f"{'xyz'[across]} [m]")
    panel.set_ylabel(f"{'xyz'[up]} [m]")
    panel.set_title(f"{title}, {arguments.axis} = {at:.4g} m")
    figure.savefig(arguments.output, bbox_inches="tight")
    print(f"{arguments.output}: {arguments.field} from {shown.min():.6g} to {shown.max():.6g}")


if __name__ == "__main__":
    main()
