#!/usr/bin/python3
"""A case made from another run's snapshot starts with exactly that run's particles."""
import os
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy as np

PROGRAM = os.environ["PELLICLE_PROGRAM"]
TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))

CASE = """
title: grains that fall
seed: 3
domain: {min: [0, 0, 0], max: ["20 mm", "20 mm", "40 mm"]}
time: {end: "5 ms", gas_step: "1e-4 s", particle_step: "1e-5 s", settle: "10 ms"}
materials:
  glass: {density: 2505, youngs_modulus: 1e7, poisson_ratio: 0.22}
contacts:
  pairs:
    - {between: [glass, glass], restitution: 0.9, sliding_friction: 0.3}
    - {between: [glass, wall], restitution: 0.9, sliding_friction: 0.3}
particles:
  - {material: glass, count: 40, diameter: "3 mm", fill: {box: {min: [0, 0, 0], max: ["20 mm", "20 mm", "30 mm"]}}}
walls:
  - {name: sides, box: domain, material: wall}
output:
  snapshots: {every: "5 ms", particles: [id, velocity, spin, radius]}
"""


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False,
                          env=dict(os.environ, OMP_NUM_THREADS="1", OMP_PROC_BIND="false"))
    assert done.returncode == 0, done.stdout + done.stderr


def snapshot(folder, step):
    with h5py.File(folder / "particles.h5") as h5:
        names = sorted(name for name in h5 if name.startswith("step"))
        group = h5[names[step]]
        order = np.argsort(group["id"][...])
        return {name: group[name][...][order] for name in group}


def main():
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        (folder / "case.yaml").write_text(CASE, encoding="utf-8")
        run(PROGRAM, "run", folder / "case.yaml", "--output", folder / "first")
        run(sys.executable, TOP / "tools" / "validation" / "case_from_snapshot.py", folder / "first", "--time", "0.005",
            "-o", folder / "second.yaml")
        run(PROGRAM, "run", folder / "second.yaml", "--output", folder / "second")
        end, start = snapshot(folder / "first", -1), snapshot(folder / "second", 0)
        assert len(end["id"]) == 40
        assert np.abs(end["velocity"]).max() > 0.05  # they do fall
        for name in ("position", "velocity", "spin", "radius"):
            assert np.array_equal(end[name], start[name]), f"{name}:\n{end[name]}\n{start[name]}"


if __name__ == "__main__":
    main()
