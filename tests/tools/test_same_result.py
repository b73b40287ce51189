#!/usr/bin/python3
"""A run gives the same result bit for bit on one and on two threads, and after kill -9 and --resume.

A small coupled bed, and a block of spheres that slides over a floor with contacts that remember, are run three times: on
one thread, on two, and killed at a moment that nothing chose and resumed. The final checkpoints must hold the same bytes in every state array. (A checkpoint that the case does not schedule, as
--until and a signal to stop write one, drops the neighbour lists at a time when the undisturbed run keeps them; sums
over contacts may then differ in the last bit.)
"""
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

PROGRAM = os.environ["PELLICLE_PROGRAM"]

CASE = """
title: small bed for bitwise comparison
seed: 3
domain: {min: [0, 0, 0], max: ["30 mm", "12 mm", "60 mm"]}
time: {end: "30 ms", gas_step: "1e-4 s", particle_step: "1e-5 s", impact_speed: "2 m/s", settle: "20 ms", courant: 0.12}
materials:
  glass: {density: 2505, youngs_modulus: 1e7, poisson_ratio: 0.22}
contacts:
  pairs:
    - {between: [glass, glass], restitution: 0.9, sliding_friction: 0.3, rolling_friction: 0.01}
    - {between: [glass, wall], restitution: 0.9, sliding_friction: 0.3, rolling_friction: 0.01}
particles:
  - {material: glass, count: 300, diameter: "3 mm", fill: {box: {min: [0, 0, 0], max: ["30 mm", "12 mm", "50 mm"]}}}
walls:
  - {name: sides, box: domain, material: wall}
gas:
  density: 1.149
  viscosity: 1.87e-5
  grid: {cells: [6, 2, 12]}
  boundaries:
    - {name: jet, on: bottom, region: {box: {min: ["10 mm", 0, 0], max: ["20 mm", "12 mm", 0]}}, inlet: {velocity: "8 m/s"}}
    - {name: rest, on: bottom, inlet: {velocity: "1 m/s"}}
    - {name: top, on: top, outlet: {pressure: 0}}
coupling: {drag: beetstra, deposition: divided}
output:
  checkpoint: {every: "1 ms"}
  snapshots: {every: "10 ms", particles: [velocity], gas: [velocity]}
  average: {from: "2 ms", gas: [velocity, pressure, void_fraction]}
  lines:
    - {name: rise, from: ["2 mm", "6 mm", "10 mm"], to: ["28 mm", "6 mm", "10 mm"], points: 5, depth_average: y, quantity: particle_velocity_z}
    - {name: wind, from: ["15 mm", "6 mm", 0], to: ["15 mm", "6 mm", "60 mm"], points: 6, quantity: gas_speed}
  probes:
    - {name: tap, point: ["15 mm", "6 mm", "5 mm"], every: "5 ms", average: {from: "2 ms"}}
    - {name: load, wall: sides, quantities: [wall_force_z, gas_force_z], every: "5 ms", average: {}}
    - {name: bed, bed: {}, every: "5 ms", average: {from: "4 ms"}}
"""

# The block falls apart while it slides and comes to rest as a heap in a corner: contacts slide, stick, roll, open and
# close, with each other and with walls.
BLOCK = """
title: sliding block of spheres
domain: {min: [0, 0, 0], max: ["60 mm", "30 mm", "30 mm"]}
gravity: [4, 0, -8.5]
time: {end: "0.25 s", gas_step: "1e-4 s", particle_step: "1e-5 s", impact_speed: "2 m/s"}
materials:
  glass: {density: 2505, youngs_modulus: 1e7, poisson_ratio: 0.22}
contacts:
  model: {tangential: mindlin, rolling: epsd2}
  pairs:
    - {between: [glass, glass], restitution: 0.7, sliding_friction: 0.5, rolling_friction: 0.1}
    - {between: [glass, wall], restitution: 0.7, sliding_friction: 0.4, rolling_friction: 0.1}
particles:
  - {material: glass, count: 300, diameter: "3 mm", velocity: [0.4, 0.05, 0],
     fill: {box: {min: [0, "5 mm", 0], max: ["25 mm", "25 mm", "22 mm"]}, pattern: lattice}}
walls:
  - {name: sides, box: domain, material: wall}
output:
  checkpoint: {every: "5 ms"}
  snapshots: {every: "50 ms", particles: [velocity]}
"""

# Parcels, films and hits, with drying, a tube that cuts the grid and droplets that bounce.
SPRAYED = CASE.replace("small bed", "small sprayed bed").replace("poisson_ratio: 0.22", "poisson_ratio: 0.22, heat_capacity: 840").replace(
    "  viscosity: 1.87e-5", """  viscosity: 1.87e-5
  heat: {initial_temperature: "60 degC"}
  moisture: {initial_vapour_mass_fraction: 0.005}""").replace(
    'm/s"}}', 'm/s", temperature: "60 degC", vapour_mass_fraction: 0.005}}').replace(
    "material: wall}\n", """material: wall}
  - {name: tube, cylinder: {from: ["15 mm", "6 mm", "20 mm"], to: ["15 mm", "6 mm", "40 mm"], radius: "5 mm"}, material: wall}
""").replace("output:\n", """output:
  wetness: [{name: all, box: {min: [0, 0, 0], max: ["30 mm", "12 mm", "60 mm"]}}]
""") + """
heat: {}
spray:
  - {name: gun, position: ["15 mm", "6 mm", "12 mm"], cone_angle: "60 deg", nozzle_radius: "0.5 mm", speed: "10 m/s",
     mass_rate: "5 g/min", solids_fraction: 0.2, droplets_per_parcel: 20,
     droplet_diameter: {log_normal: {median: "30 um", geometric_sd: 1.3, min: "10 um", max: "80 um"}},
     capture: {weber: [10, 500], efficiency: [1, 0.5]}}
  - {name: other, position: ["5 mm", "6 mm", "50 mm"], axis: [0, 0, -1], cone_angle: "40 deg", speed: "20 m/s",
     mass_rate: "5 g/min", droplet_diameter: "40 um", droplets_per_parcel: 5}
droplets: {momentum: two_way}
"""

# The same with droplets that evaporate on their way and particles that their coating makes larger.
EVAPORATING = SPRAYED.replace("momentum: two_way", "momentum: two_way, evaporation: true").replace("heat: {}\n", "heat: {}\ncoating: {growth: mass_and_radius}\n").replace("small sprayed", "small evaporating")

# Counts of work done are no state of the bed.
IGNORED = {"case"}


def run(folder, case, threads, *more, check=True):
    command = [PROGRAM, "run", str(case), "--output", str(folder), "--threads", str(threads), *more]
    environment = dict(os.environ, OMP_PROC_BIND="false", OMP_NUM_THREADS=str(threads))
    result = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if check and result.returncode != 0:
        sys.exit(f"{' '.join(command)} ended with {result.returncode}:\n{result.stdout}")
    return result


def state_of(folder):
    arrays = {}
    with h5py.File(folder / "checkpoint.h5") as file:
        def visit(name, item):
            if isinstance(item, h5py.Dataset) and name not in IGNORED:
                arrays[name] = np.asarray(item[()])
        file.visititems(visit)
    return arrays


def compare(name, expected, got):
    problems = []
    if expected.keys() != got.keys():
        problems.append(f"other arrays: {sorted(expected.keys() ^ got.keys())}")
    for key in expected.keys() & got.keys():
        if expected[key].tobytes() != got[key].tobytes():
            problems.append(f"{key} differs")
    print(f"{name}: {len(expected)} arrays, {'the same bit for bit' if not problems else problems}")
    return not problems


def kill_and_resume(folder, case, how, delay):
    command = [PROGRAM, "run", str(case), "--output", str(folder), "--threads", "2"]
    environment = dict(os.environ, OMP_PROC_BIND="false", OMP_NUM_THREADS="2")
    process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.time() + 60
    while not (folder / "checkpoint.h5").exists() and process.poll() is None and time.time() < deadline:
        time.sleep(0.005)
    time.sleep(delay)
    finished = process.poll() is not None
    if finished:
        sys.exit("the run ended before it could be killed: nothing was tested")
    process.send_signal(how)
    process.wait()
    print(f"signal {how} after {delay:.3f} s")
    run(folder, case, 2, "--resume")


def is_reproducible(name, text, needed):
    """Runs a case the three ways; `needed`: what must be remembered at the end, in how many numbers that are not 0, for the case to be of use."""
    with tempfile.TemporaryDirectory() as place:
        place = Path(place)
        case = place / "case.yaml"
        case.write_text(text)
        begin = time.time()
        run(place / "one", case, 1)
        duration = time.time() - begin
        run(place / "two", case, 2)
        expected = state_of(place / "one")
        for place_in_file, least in needed.items():
            kept = [np.count_nonzero(value) for key, value in expected.items() if key.startswith(place_in_file)]
            assert sum(kept) > least, f"nothing in {place_in_file} of {sorted(expected)}"
        good = compare(f"{name}, two threads", expected, state_of(place / "two"))
        kill_and_resume(place / "killed", case, signal.SIGKILL, random.uniform(0.1, 0.6) * duration)
        return compare(f"{name}, killed and resumed", expected, state_of(place / "killed")) and good


def main():
    good = is_reproducible("bed", CASE, {"dem/position_radius": 100, "output/average/velocity/squares": 200, "output/lines/rise/moments": 10, "probes/load/average/columns": 10})
    good &= is_reproducible("sprayed bed", SPRAYED, {"spray/state": 100, "spray/hit_record": 100, "heat/film": 100, "wetness/all": 5})
    good &= is_reproducible("evaporating spray", EVAPORATING, {"spray/water": 100, "heat/film": 100, "heat/bare_radius": 100})
    good &= is_reproducible("block", BLOCK, {"dem/history/spring": 100, "dem/wall_history/spring": 100})
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
