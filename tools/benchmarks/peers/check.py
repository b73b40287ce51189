"""Do the codes compute the same? Compares, bead by bead, accelerations at the start and paths over a few hundred steps."""

import numpy as np

import beds

MASS = beds.DENSITY * np.pi / 6 * beds.DIAMETER**3
INERTIA = 0.1 * MASS * beds.DIAMETER**2


def read_dump(path):
    """A LAMMPS dump in the order of the ids: position, velocity, spin, acceleration, angular acceleration."""
    rows = np.loadtxt(path, skiprows=9)
    rows = rows[np.argsort(rows[:, 0])][:, 1:]
    rows[:, 9:12] /= MASS
    rows[:, 12:15] /= INERTIA
    return rows


def read_states(code, folder):
    if code == "pellicle":
        return None, np.loadtxt(folder / "end.txt")
    return read_dump(folder / "start.dump"), read_dump(folder / "end.dump")


def touching(positions):
    """Pairs closer than a diameter, by sorting into cells of one diameter; independent of all the codes."""
    cell = np.floor(positions / beds.DIAMETER).astype(int) + 1
    shape = cell.max(0) + 2
    key = np.ravel_multi_index(cell.T, shape)
    order = np.argsort(key, kind="stable")
    sorted_key = key[order]
    first, second = [], []
    for step in np.ndindex(3, 3, 3):
        other = np.ravel_multi_index((cell + np.array(step) - 1).T, shape, mode="clip")
        begin, end = np.searchsorted(sorted_key, other), np.searchsorted(sorted_key, other, side="right")
        for k in range((end - begin).max()):
            i = np.nonzero(begin + k < end)[0]
            j = order[begin[i] + k]
            near = (i < j) & (((positions[i] - positions[j]) ** 2).sum(1) < beds.DIAMETER**2)
            first.append(i[near])
            second.append(j[near])
    return np.concatenate(first), np.concatenate(second)


def overlaps(positions):
    i, j = touching(positions)
    return beds.DIAMETER - np.sqrt(((positions[i] - positions[j]) ** 2).sum(1))


def rms(vectors):
    return float(np.sqrt((vectors**2).sum(1).mean()))


def compare_codes(cases, make_job, codes_of, run, say):
    """Runs every code on every case for as many steps as are timed. Returns one record a code and case."""
    records = []
    for case in cases:
        say(f"\nSame physics? {case}, from the given state over the steps that are timed. Acceleration at the start "
            "and displacement at the end against LIGGGHTS, rms; overlaps by a program of its own.")
        say("| code | contacts at start | at end | mean overlap at start [um] | at end [um] | largest at end [um] "
            "| kinetic energy at end [J] | acceleration differs by | spin's | displacement | differs by |")
        say("|" + "---|" * 11)
        reference = None
        codes = codes_of(case)
        for code in sorted(codes, key=lambda c: c != "liggghts"):
            record, reference = compare_one(code, case, make_job, run, reference)
            records.append(record)
            say("| " + " | ".join(f"{v:.5g}" if isinstance(v, float) else str(v)
                                  for k, v in record.items() if k != "case") + " |")
    return records


def compare_one(code, case, make_job, run, reference):
    job = dict(make_job(code, case), dump=True)
    result = run(job)
    start, end = result["start"], result["end"]
    if code == "pellicle":
        # Accelerations are kept of the last step: those of the start take a run of one step.
        start = run(dict(job, warm=1, steps=0))["end"]
        start[:, :3] = beds.read(job["bed"])[:, :3]
    before, after = overlaps(start[:, :3]), overlaps(end[:, :3])
    energy = 0.5 * MASS * (end[:, 3:6] ** 2).sum() + 0.5 * INERTIA * (end[:, 6:9] ** 2).sum()
    moved = end[:, :3] - start[:, :3]
    record = {"code": code, "case": case, "contacts_start": 2 * len(before) / len(start),
              "contacts_end": 2 * len(after) / len(end), "mean_overlap_start_um": 1e6 * float(before.mean()) if len(before) else 0.0,
              "mean_overlap_end_um": 1e6 * float(after.mean()) if len(after) else 0.0, "largest_overlap_end_um": 1e6 * float(after.max()) if len(after) else 0.0,
              "kinetic_energy_end": float(energy)}
    if reference is None:
        reference = {"acceleration": start[:, 9:12], "turn": start[:, 12:15], "moved": moved}
    scale = rms(reference["acceleration"]) or 1.0
    turn_scale = rms(reference["turn"]) or 1.0
    record.update(acceleration_difference=rms(start[:, 9:12] - reference["acceleration"]) / scale,
                  turn_difference=rms(start[:, 12:15] - reference["turn"]) / turn_scale,
                  displacement_um=1e6 * rms(moved),
                  displacement_difference_um=1e6 * rms(moved - reference["moved"]))
    return record, reference
