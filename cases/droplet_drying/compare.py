#!/usr/bin/python3
"""Runs the case and compares temperature and liquid of the particle with a 1-D model.

    cases/droplet_drying/compare.py [--output DIR] [--image FILE.png]

The 1-D model: (m c + m_l c_l) dT/dt = h A (T_air - T) - L(T) e and dm_l/dt = -e with
e = density k_m A ln(1 + B), B = (w* - w) / (1 - w*), Ranz and Marshall for both coefficients, Buck's saturation pressure;
the air does not change. RK4 with steps of 2 ms."""

import argparse
import csv
import math
import pathlib
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tools" / "plot"))
from plot_style import COLOURS, use_style  # noqa: E402

AIR, HUMIDITY, SPEED, PRESSURE = 298.15, 0.5, 1.0, 101325.0
DENSITY, VISCOSITY, CONDUCTIVITY, DIFFUSIVITY = 1.1839, 1.849e-5, 0.0262, 2.6e-5
GAS_CAPACITY, VAPOUR_CAPACITY, LIQUID_CAPACITY = 1007.0, 1872.0, 4181.0
DIAMETER, BEAD_DENSITY, BEAD_CAPACITY, LIQUID = 1e-3, 1500.0, 900.0, 0.05
# Void fraction of the cell of 1 cm3 that the particle is in: the Reynolds number counts with it.
VOID = 1 - math.pi / 6 * DIAMETER**3 / 1e-6


def saturated_fraction(temperature, humidity=1.0):
    t = temperature - 273.15
    share = humidity * 611.21 * math.exp((18.678 - t / 234.5) * t / (257.14 + t)) / PRESSURE
    return 18.01528 * share / (18.01528 * share + 28.9647 * (1 - share))


def rates(temperature, liquid):
    """dT/dt, dm_l/dt."""
    w = saturated_fraction(AIR, HUMIDITY)
    reynolds = DENSITY * VOID * SPEED * DIAMETER / VISCOSITY
    prandtl = VISCOSITY * (GAS_CAPACITY * (1 - w) + VAPOUR_CAPACITY * w) / CONDUCTIVITY
    schmidt = VISCOSITY / (DENSITY * DIFFUSIVITY)
    heat = (2 + 0.6 * math.sqrt(reynolds) * prandtl ** (1 / 3)) * CONDUCTIVITY * math.pi * DIAMETER
    vapour = (2 + 0.6 * math.sqrt(reynolds) * schmidt ** (1 / 3)) * DENSITY * DIFFUSIVITY * math.pi * DIAMETER
    evaporation = 0.0
    if liquid > 0:
        surface = saturated_fraction(temperature)
        evaporation = vapour * math.log(1 + (surface - w) / (1 - surface))
    latent = 2.4417e6 + (VAPOUR_CAPACITY - LIQUID_CAPACITY) * (temperature - 298.15)
    bead = math.pi / 6 * DIAMETER**3 * BEAD_DENSITY
    capacity = bead * BEAD_CAPACITY + max(liquid, 0) * LIQUID_CAPACITY
    return (heat * (AIR - temperature) - latent * evaporation) / capacity, -evaporation


def model(times):
    temperature, liquid, now = AIR, LIQUID * math.pi / 6 * DIAMETER**3 * BEAD_DENSITY, 0.0
    found = []
    for end in times:
        steps = max(1, math.ceil((end - now) / 2e-3))
        dt = (end - now) / steps
        for _ in range(steps):
            k1 = rates(temperature, liquid)
            k2 = rates(temperature + dt / 2 * k1[0], liquid + dt / 2 * k1[1])
            k3 = rates(temperature + dt / 2 * k2[0], liquid + dt / 2 * k2[1])
            k4 = rates(temperature + dt * k3[0], liquid + dt * k3[1])
            temperature += dt / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
            liquid = max(liquid + dt / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1]), 0.0)
        now = end
        found.append((temperature, liquid))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", default=TOP / "results/droplet_drying", type=pathlib.Path)
    parser.add_argument("--image", default=TOP / "results/droplet_drying.png", type=pathlib.Path)
    options = parser.parse_args()
    subprocess.run([str(TOP / "pellicle"), "run", str(TOP / "cases/droplet_drying/case.yaml"), "--output", str(options.output),
                    "--overwrite", "--threads", "1"], check=True, capture_output=True)
    with open(options.output / "probes/particle.csv", encoding="utf-8") as file:
        rows = [[float(x) for x in row] for row in list(csv.reader(file))[1:]]
    times = [r[0] for r in rows]
    found = model(times)
    wet = [i for i, r in enumerate(rows) if r[2] > 0 and r[0] > 5]
    print(f"wet-bulb temperature: {rows[wet[0]][1] - 273.15:.3f} degC, 1-D model {found[wet[0]][0] - 273.15:.3f}")
    slope = [(values[wet[-1]] - values[wet[0]]) / (times[wet[-1]] - times[wet[0]])
             for values in ([r[2] for r in rows], [f[1] for f in found])]
    print(f"drying rate: {-slope[0]:.4e} kg/s, 1-D model {-slope[1]:.4e}")
    dry = [next(t for t, m in zip(times, masses) if m == 0) for masses in ([r[2] for r in rows], [f[1] for f in found])]
    print(f"dry at {dry[0]:.1f} s, 1-D model {dry[1]:.1f}")
    print(f"largest difference: {max(abs(r[1] - f[0]) for r, f in zip(rows, found)):.3f} K, "
          f"{max(abs(r[2] - f[1]) for r, f in zip(rows, found)) / rows[0][2]:.1e} of the liquid")
    plt = use_style()
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(5.2, 4.4), sharex=True)
    for axes, column, factor, offset, text in ((upper, 1, 1, -273.15, "temperature [\N{DEGREE SIGN}C]"),
                                               (lower, 2, 1e9, 0, "liquid [\N{GREEK SMALL LETTER MU}g]")):
        axes.plot(times, [factor * f[column - 1] + offset for f in found], color=COLOURS[0], label="1-D model")
        axes.plot(times[::10], [factor * r[column] + offset for r in rows[::10]], "o", color=COLOURS[1], markersize=4,
                  markerfacecolor="white", label="pellicle")
        axes.set_ylabel(text)
    lower.set_xlabel("time [s]")
    upper.legend()
    figure.tight_layout()
    options.image.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(options.image, dpi=110)
    print("drawn:", options.image)


if __name__ == "__main__":
    main()
