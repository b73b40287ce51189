#!/usr/bin/python3
"""Runs the case at four temperatures of the water and at three outer steps, and compares with a 1-D model.

    cases/single_particle_heat/compare.py [--output DIR] [--image FILE.png] [--shortest]

The 1-D model is m c dT/dt = h A (T_water - T) with Nu = 7 - 10 eps + 5 eps^2 (Gunn at rest) in water of constant
temperature, integrated by RK4. `--shortest` adds an outer step of 1e-6 s, half a second long (minutes)."""

import argparse
import csv
import math
import pathlib
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tools" / "plot"))
from plot_style import COLOURS, use_style  # noqa: E402

DIAMETER, DENSITY, CAPACITY, CONDUCTIVITY, START = 1.749e-3, 2505, 840, 0.607, 273.0
CELL = 0.02**3


def model(times, water):
    """RK4 with steps of a millisecond or less."""
    eps = 1 - math.pi / 6 * DIAMETER**3 / CELL
    h = (7 - 10 * eps + 5 * eps**2) * CONDUCTIVITY / DIAMETER
    rate = h * math.pi * DIAMETER**2 / (math.pi / 6 * DIAMETER**3 * DENSITY * CAPACITY)
    values, now, t = [], 0.0, START
    for end in times:
        steps = max(1, math.ceil((end - now) / 1e-3))
        dt = (end - now) / steps
        for _ in range(steps):
            k1 = rate * (water - t)
            k2 = rate * (water - t - dt / 2 * k1)
            k3 = rate * (water - t - dt / 2 * k2)
            k4 = rate * (water - t - dt * k3)
            t += dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        now = end
        values.append(t)
    return values


def run(folder, water, gas_step, particle_step, end="5 s", every="0.05 s"):
    command = [str(TOP / "pellicle"), "run", str(TOP / "cases/single_particle_heat/case.yaml"), "--output", str(folder),
               "--overwrite", "--threads", "1", "--set", f"gas.heat.initial_temperature={water}",
               "--set", f"time.gas_step={gas_step}", "--set", f"time.particle_step={particle_step}",
               "--set", "time.allow_large_step=true", "--set", f"time.end={end}", "--set", f"output.probes.particle.every={every}",
               "--set", f"output.probes.water.every={every}"]
    subprocess.run(command, check=True, capture_output=True)
    with open(folder / "probes/particle.csv", encoding="utf-8") as file:
        rows = [[float(x) for x in row] for row in list(csv.reader(file))[1:]]
    return [r[0] for r in rows], [r[1] for r in rows]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", default=TOP / "results/single_particle_heat", type=pathlib.Path)
    parser.add_argument("--image", default=TOP / "results/single_particle_heat.png", type=pathlib.Path)
    parser.add_argument("--shortest", action="store_true")
    options = parser.parse_args()
    plt = use_style()
    figure, axes = plt.subplots(figsize=(5.2, 3.4))
    for colour, water in zip(COLOURS, (283, 293, 303, 313)):
        times, values = run(options.output / f"water_{water}", water, 1e-3, 1e-3)
        exact = model(times, water)
        largest = max(abs(a - b) for a, b in zip(values, exact))
        print(f"water {water} K, outer step 1e-3 s: largest difference from the 1-D model {largest:.2e} K, "
              f"{largest / (water - START):.1e} of the difference at the start")
        axes.plot(times, exact, color=colour, label=f"{water} K")
        axes.plot(times[::5], values[::5], "o", color=colour, markersize=4, markerfacecolor="white")
    steps = [(1e-2, 1e-2, "5 s", "0.05 s"), (1e-3, 1e-3, "5 s", "0.05 s"), (1e-4, 1e-4, "5 s", "0.05 s")]
    if options.shortest:
        steps += [(1e-6, 1e-6, "0.5 s", "0.05 s")]
    reference = None
    for gas_step, particle_step, end, every in steps:
        times, values = run(options.output / f"step_{gas_step:g}", 293, gas_step, particle_step, end, every)
        reference = reference or values
        largest = max(abs(a - b) for a, b in zip(values, reference))
        print(f"outer step {gas_step:g} s to {end}: differs from 1e-2 s by at most {largest:.2e} K")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("temperature of the particle [K]")
    axes.legend(title="water; lines: 1-D model, rings: pellicle", loc="lower center", bbox_to_anchor=(0.5, 1), ncols=4)
    figure.tight_layout()
    options.image.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(options.image, dpi=110)
    print("drawn:", options.image)


if __name__ == "__main__":
    main()
