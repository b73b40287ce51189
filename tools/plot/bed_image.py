#!/usr/bin/python3
"""Draws the bed seen from the front (x-z plane): particles to scale, coloured by speed, and the gas.

    bed_image.py results/single_spout -o bed.png                 # the last snapshot
    bed_image.py results/single_spout --time 0.5 1 1.5 -o bed.png
    bed_image.py results/single_spout --frames 4 -o bed.png      # 4 moments over the run, side by side
    bed_image.py results/single_spout --animate bed.gif          # all snapshots
    bed_image.py results/wurster --spray 200 -o bed.png          # with the spray, its droplets 200 times as large

The gas is shown by arrows (mean over the depth, their length growing with the root of the speed) over the particles,
or, with --gas void_fraction, by its void fraction and arrows in a panel of its own beside each frame.
"""

import argparse

import numpy as np

from pellicle_results import Results, fail
from plot_style import use_style


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="results folder")
    parser.add_argument("--time", type=float, nargs="+", help="simulated times [s]; the nearest snapshots are drawn")
    parser.add_argument("--frames", type=int, default=1, help="without --time: so many snapshots, evenly spaced")
    parser.add_argument("--gas", choices=["arrows", "void_fraction", "none"], default="arrows")
    parser.add_argument("--largest-speed", type=float, help="upper end of the colours [m/s]; default: 99.5 %% quantile")
    parser.add_argument("--height", type=float, help="draw up to this height above the floor [m]")
    parser.add_argument("--slab", type=float, nargs=2, metavar=("FROM", "TO"),
                        help="only particles with y between these [m]")
    parser.add_argument("--spray", type=float, metavar="SCALE",
                        help="draw the parcels of spray.h5 over all, one dot each, SCALE times a droplet's diameter wide")
    parser.add_argument("--arrows", type=int, default=22, help="arrows across the bed, at most one a cell")
    parser.add_argument("--title", help="over the figure")
    parser.add_argument("--animate", metavar="FILE", help="write all snapshots as an animated GIF")
    parser.add_argument("-o", "--output", help="picture: .png, .pdf or .svg")
    arguments = parser.parse_args()
    if not arguments.output and not arguments.animate:
        parser.error("give -o or --animate")
    return arguments


def choose_times(results, arguments):
    times = results.particle_times() or results.gas_times()
    if not times:
        fail(f"{results.folder}: holds no snapshots; ask for them with output.snapshots.every")
    if arguments.animate:
        return times
    if arguments.time:
        return arguments.time
    if arguments.frames <= 1:
        return times[-1:]
    # The beginning is at rest: the frames divide the run, the last one being its end.
    return [times[round(n * (len(times) - 1) / arguments.frames)] for n in range(1, arguments.frames + 1)]


class Frame:
    """Particles and gas of one moment, in the order in which they are drawn."""

    def __init__(self, results, time, arguments):
        self.time = time
        self.gas = results.gas(time) if results.gas_times() and arguments.gas != "none" else None
        self.parcels = None
        if arguments.spray and results.spray_times():
            self.parcels = results.parcels(time)
            if "diameter" not in self.parcels:
                fail(f"{results.folder}: the snapshots lack the diameter; add it to output.snapshots.spray")
            if arguments.slab:
                y = self.parcels["position"][:, 1]
                keep = (y >= arguments.slab[0]) & (y <= arguments.slab[1])
                self.parcels = {name: self.parcels[name][keep] for name in ("position", "diameter")}
        self.position = np.zeros((0, 3))
        self.radius = self.speed = np.zeros(0)
        if results.particle_times():
            particles = results.particles(time)
            self.time = particles["time"]
            self.position = particles["position"]
            if not {"velocity", "speed"} & particles.keys() or not {"radius", "diameter"} & particles.keys():
                fail(f"{results.folder}: the snapshots lack velocity or radius; add them to output.snapshots.particles")
            self.radius = particles["radius"] if "radius" in particles else 0.5 * particles["diameter"]
            self.speed = particles["speed"] if "speed" in particles else np.linalg.norm(particles["velocity"], axis=1)
            keep = np.ones(len(self.radius), dtype=bool)
            if arguments.slab:
                keep = (self.position[:, 1] >= arguments.slab[0]) & (self.position[:, 1] <= arguments.slab[1])
            # Seen from the front: the far ones first, the near ones over them.
            order = np.flatnonzero(keep)[np.argsort(-self.position[keep, 1], kind="stable")]
            self.position, self.radius, self.speed = self.position[order], self.radius[order], self.speed[order]


def extent(frames, grid, arguments):
    """x from, x to, z from, z to [m]: the grid's width, and as high as the bed gets."""
    places = np.concatenate([frame.position for frame in frames])
    radii = np.concatenate([frame.radius for frame in frames])
    if grid is not None:
        left, right, floor, ceiling = grid["x"][0], grid["x"][-1], grid["z"][0], grid["z"][-1]
    else:
        left, right = (places[:, 0] - radii).min(), (places[:, 0] + radii).max()
        floor, ceiling = (places[:, 2] - radii).min(), (places[:, 2] + radii).max()
    if arguments.height:
        top = floor + arguments.height
    elif len(radii):
        top = min(ceiling, floor + 1.12 * ((places[:, 2] + radii).max() - floor))
    else:
        top = ceiling
    return left, right, floor, top


def mean_over_depth(field, grid):
    """Mean over y of an array nz x ny x nx (x 3), weighted by the cells' depth."""
    return np.average(field, axis=1, weights=np.diff(grid["y"]))


def draw_arrows(axes, frame, grid, box, arguments):
    if "velocity" not in frame.gas:
        return
    velocity = mean_over_depth(frame.gas["velocity"], grid)
    x = 0.5 * (grid["x"][1:] + grid["x"][:-1])
    z = 0.5 * (grid["z"][1:] + grid["z"][:-1])
    # As many arrows upwards as fit at the same distance.
    across = min(len(x), arguments.arrows)
    distance = (box[1] - box[0]) / across
    at_x = box[0] + distance * (np.arange(across) + 0.5)
    at_z = np.arange(box[2] + 0.5 * distance, box[3], distance)
    columns = np.clip(np.searchsorted(grid["x"], at_x) - 1, 0, len(x) - 1)
    rows = np.clip(np.searchsorted(grid["z"], at_z) - 1, 0, len(z) - 1)
    chosen = velocity[np.ix_(rows, columns)]
    u, w = chosen[..., 0], chosen[..., 2]
    speed = np.hypot(u, w)
    fastest = np.quantile(speed, 0.995) or 1.0
    # Jets are many times faster than the rest: lengths grow with the square root of the speed, so that both are seen.
    length = 1.15 * distance * np.sqrt(np.minimum(speed / fastest, 1))
    with np.errstate(invalid="ignore", divide="ignore"):
        u, w = np.where(speed > 0, u / speed * length, 0), np.where(speed > 0, w / speed * length, 0)
    xs, zs = np.meshgrid(1e3 * at_x, 1e3 * at_z)
    axes.quiver(xs, zs, 1e3 * u, 1e3 * w, angles="xy", scale_units="xy", scale=1, pivot="middle", color="#12263a",
                edgecolor="white", linewidth=0.35, units="xy", width=0.095e3 * distance, headwidth=4.2, headlength=4.8,
                headaxislength=4.2, zorder=4)


def prepare_axes(axes, box, title):
    left, right, floor, top = (1e3 * value for value in box)
    axes.set_xlim(left, right)
    axes.set_ylim(floor, top)
    axes.set_aspect("equal")
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(True)
        spine.set_color("#555555")
    axes.set_title(title)
    axes.set_xlabel("x [mm]")


def draw_particles(axes, frame, largest_speed):
    from matplotlib.collections import EllipseCollection

    width = 2e3 * frame.radius
    circles = EllipseCollection(width, width, np.zeros(len(width)), units="xy", cmap="plasma", zorder=3,
                                offsets=1e3 * frame.position[:, [0, 2]].reshape(-1, 2),
                                offset_transform=axes.transData, linewidths=0.15, edgecolors="#00000066")
    circles.set_array(frame.speed)
    circles.set_clim(0, largest_speed)
    axes.add_collection(circles)
    return circles


def draw_parcels(axes, frame, scale):
    """Dots over the particles and the arrows; parcels that a particle in front hides are seen too."""
    from matplotlib.collections import EllipseCollection

    width = 1e3 * scale * frame.parcels["diameter"]
    axes.add_collection(EllipseCollection(
        width, width, np.zeros(len(width)), units="xy", zorder=5, facecolors="#00a6d6", edgecolors="none",
        offsets=1e3 * frame.parcels["position"][:, [0, 2]].reshape(-1, 2), offset_transform=axes.transData))


def draw_void_fraction(axes, frame, grid):
    return axes.pcolormesh(1e3 * grid["x"], 1e3 * grid["z"], mean_over_depth(frame.gas["void_fraction"], grid),
                           cmap="Blues_r", vmin=0.35, vmax=1, zorder=1, rasterized=True)


def add_bar(figure, drawn, axes, label, extend):
    bar = figure.colorbar(drawn, ax=axes, shrink=0.75, aspect=28, pad=0.02, extend=extend)
    bar.set_label(label)
    bar.outline.set_linewidth(0.5)


def draw(plt, frames, grid, box, largest_speed, arguments):
    """A figure with the frames side by side."""
    has_gas = grid is not None and frames[0].gas is not None
    pairs = has_gas and arguments.gas == "void_fraction" and "void_fraction" in frames[0].gas
    panels = len(frames) * (2 if pairs else 1)
    ratio = (box[3] - box[2]) / (box[1] - box[0])
    panel_height = min(6.4, max(2.6, 2.5 * ratio))
    panel_width = max(1.2, panel_height / ratio)
    figure, axes = plt.subplots(1, panels, sharey=True, squeeze=False, layout="constrained",
                                figsize=(panels * (panel_width + 0.12) + (2.5 if pairs else 1.6), panel_height + 0.85))
    every = axes[0].tolist()
    for number, frame in enumerate(frames):
        panel = every[2 * number if pairs else number]
        prepare_axes(panel, box, f"t = {frame.time:.4g} s")
        circles = draw_particles(panel, frame, largest_speed)
        if frame.parcels is not None:
            draw_parcels(panel, frame, arguments.spray)
        if pairs:
            beside = every[2 * number + 1]
            prepare_axes(beside, box, "")
            background = draw_void_fraction(beside, frame, grid)
            draw_arrows(beside, frame, grid, box, arguments)
        elif has_gas and arguments.gas == "arrows":
            draw_arrows(panel, frame, grid, box, arguments)
    every[0].set_ylabel("z [mm]")
    add_bar(figure, circles, every, "particle speed [m/s]", "max")
    if pairs:
        add_bar(figure, background, every, "void fraction", "min")
    if arguments.title:
        figure.suptitle(arguments.title, fontsize=11)
    return figure


def animate(plt, frames, grid, box, largest_speed, arguments):
    import io

    from PIL import Image

    pictures = []
    for frame in frames:
        figure = draw(plt, [frame], grid, box, largest_speed, arguments)
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png", dpi=110)
        plt.close(figure)
        pictures.append(Image.open(buffer).convert("P", palette=Image.ADAPTIVE))
    pictures[0].save(arguments.animate, save_all=True, append_images=pictures[1:], duration=80, loop=0)
    print(f"{arguments.animate}: {len(frames)} snapshots")


def main():
    arguments = parse_arguments()
    results = Results(arguments.results)
    if arguments.spray and not results.spray_times():
        fail(f"{results.folder}: holds no snapshots of a spray; ask for them with output.snapshots.spray")
    frames = [Frame(results, time, arguments) for time in choose_times(results, arguments)]
    grid = results.gas_grid()
    box = extent(frames, grid, arguments)
    speeds = np.concatenate([frame.speed for frame in frames])
    largest_speed = arguments.largest_speed or (float(np.quantile(speeds, 0.995)) if len(speeds) else 1.0) or 1.0
    plt = use_style()
    if arguments.animate:
        animate(plt, frames, grid, box, largest_speed, arguments)
        return
    figure = draw(plt, frames, grid, box, largest_speed, arguments)
    figure.savefig(arguments.output)
    print(f"{arguments.output}: t = {', '.join(f'{frame.time:.6g}' for frame in frames)} s")


if __name__ == "__main__":
    main()
