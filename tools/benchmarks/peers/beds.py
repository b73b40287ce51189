"""The beds of tools/benchmarks/dem_vs_peers: made once, kept as text, one bead a line (x y z [vx vy vz [wx wy wz]])."""

import gzip
import json
import pathlib
import subprocess

import numpy as np

COUNT = 50000
SIZE = (0.145, 0.06, 0.3)  # of the box [m]
DIAMETER, DENSITY = 3e-3, 2505.0
AGITATION = 1.0  # root mean square speed of the agitated beads [m/s]
MIXING = 2000  # steps without loss that turn a lattice into a gas: about thirty collisions a bead

# Stages of settling: restitution, relaxation time of a drag [s] (0: none), step [s], steps.
STAGES = ((0.5, 0.05, 2e-5, 7000), (0.97, 0.01, 1e-5, 12000), (0.97, 0, 1e-5, 3000))
LAWS = {"packed": "viscous_coulomb", "packed_history": "mindlin"}


def lattice(pitch):
    """A cubic lattice from the bottom up, shaken by up to half the gaps; the pitch is stretched to fill the walls."""
    size = np.array(SIZE)
    across, along = int(size[0] / pitch), int(size[1] / pitch)
    layers = -(-COUNT // (across * along))
    cell = np.array([size[0] / across, size[1] / along, min(pitch, size[2] / layers)])
    k = np.arange(COUNT)
    places = np.stack([k % across, k // across % along, k // (across * along)], 1) + 0.5
    gap = cell.min() - DIAMETER
    if gap <= 0:
        raise ValueError("the beads do not fit")
    return places * cell + np.random.default_rng(12345).uniform(-0.49, 0.49, places.shape) * gap


def write(path, rows):
    """To a name of its own first: an interrupted run must not leave half a bed behind."""
    part = path.with_suffix(".writing")
    np.savetxt(part, rows, fmt="%.12g")
    part.replace(path)


def read(path):
    opener = gzip.open if str(path).endswith(".gz") else open
    rows = []
    with opener(path, "rt") as file:
        for line in file:
            try:
                rows.append([float(word) for word in line.replace(",", " ").split()])
            except ValueError:
                continue  # a header
    return np.array([row for row in rows if len(row) >= 3])


def run(program, bed, output, **options):
    """Runs dem_bed; what it prints."""
    command = [program, "--bed", bed, "--output", output, "--size", *SIZE]
    for name, value in options.items():
        command += ["--" + name.replace("_", "-"), value]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"could not make a bed: {(done.stdout + done.stderr).strip()}")
    return json.loads(done.stdout.strip().splitlines()[-1])


def agitate(path, program, say):
    """A granular gas: random velocities on a lattice, then collisions that lose nothing until it is mixed."""
    say(f"mixing a gas of {COUNT} beads, once")
    work = path.with_suffix(".part")
    positions = lattice((np.prod(SIZE) / COUNT) ** (1 / 3))
    velocities = np.random.default_rng(54321).normal(0, AGITATION / np.sqrt(3), positions.shape)
    write(work, np.hstack([positions, velocities]))
    found = run(program, work, work, restitution=1, friction=0, gravity=0, time_step=1e-5, warm_up=1, steps=MIXING)
    rows = read(work)[:, :6]
    rows[:, 3:] -= rows[:, 3:].mean(0)
    # What overlaps hold back of the energy is given again.
    rows[:, 3:] *= AGITATION / np.sqrt((rows[:, 3:] ** 2).sum(1).mean())
    write(path, rows)
    work.unlink()
    say(f"  {found['contacts_per_particle_end']:.3f} contacts a bead")


def settle(path, law, program, say):
    say(f"settling {COUNT} beads with {law}, once")
    work = path.with_suffix(".part")
    write(work, lattice(3.2e-3))
    for restitution, relaxation, step, steps in STAGES:
        found = run(program, work, work, tangential=law, restitution=restitution, relaxation_time=relaxation,
                    time_step=step, warm_up=1, steps=steps)
        say(f"  {steps} steps of {step} s: {found['contacts_per_particle_end']:.3f} contacts a bead, kinetic energy "
            f"{found['kinetic_energy']:.3g} J")
    write(path, read(work)[:, :3])  # at rest: what little speed is left is taken away
    work.unlink()


def make(kind, given, cache, program, say):
    """The file of a bed: the one given, or one made here before, or a new one."""
    cache.mkdir(parents=True, exist_ok=True)
    if given:
        path = cache / f"given_{kind}.txt"
        rows = read(given)
        if len(rows) == 0:
            raise SystemExit(f"{given}: no line with a position")
        if (rows[:, :3] < 0).any() or (rows[:, :3] > SIZE).any():
            raise SystemExit(f"{given}: positions outside the box of {SIZE} m")
        write(path, rows)
        return path
    path = cache / f"{kind}_{COUNT}.txt"
    if path.exists():
        return path
    if kind == "agitated":
        agitate(path, program, say)
    else:
        settle(path, LAWS[kind], program, say)
    return path


def write_data_file(bed, path):
    """The same bed as LIGGGHTS and LAMMPS read it."""
    rows = read(bed)
    with open(path, "w", encoding="ascii") as file:
        file.write(f"{pathlib.Path(bed).name}\n\n{len(rows)} atoms\n1 atom types\n\n")
        for axis, length in zip("xyz", SIZE):
            file.write(f"0 {length:.9g} {axis}lo {axis}hi\n")
        file.write("\nAtoms\n\n")
        for i, row in enumerate(rows, 1):
            file.write(f"{i} 1 {DIAMETER:.9g} {DENSITY:.9g} " + " ".join(f"{v:.12g}" for v in row[:3]) + "\n")
        if rows.shape[1] > 3:
            file.write("\nVelocities\n\n")
            for i, row in enumerate(rows, 1):
                motion = list(row[3:9]) + [0.0] * (9 - min(9, len(row)))
                file.write(f"{i} " + " ".join(f"{v:.12g}" for v in motion) + "\n")
