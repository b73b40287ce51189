"""Do the codes compute the same? Compares, bead by bead, accelerations at the start and paths over a few steps."""

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


# Key of a record, heading, format.
COLUMNS = (
    ("code", "code", "{}"),
    ("contacts_start", "contacts at start", "{:.4f}"),
    ("contacts_end", "at end", "{:.4f}"),
    ("mean_overlap_start", "mean overlap at start [um]", "{:.4f}"),
    ("mean_overlap_end", "at end [um]", "{:.4f}"),
    ("largest_overlap_end", "largest at end [um]", "{:.3f}"),
    ("rms_speed_end", "rms speed at end [m/s]", "{:.6g}"),
    ("rms_spin_end", "rms spin at end [rad/s]", "{:.6g}"),
    ("acceleration_difference", "acceleration at start differs by", "{:.2e}"),
    ("turn_difference", "angular acceleration", "{:.2e}"),
    ("moved", "displacement, rms [um]", "{:.5g}"),
    ("moved_difference", "differs by", "{:.2e}"),
    ("spin_difference", "spin at end", "{:.2e}"),
    ("inner_moved_difference", "far from walls: displacement", "{:.2e}"),
    ("inner_spin_difference", "spin at end", "{:.2e}"),
)
FAR = 3 * beds.DIAMETER  # from the nearest wall


def compare_codes(cases, steps, make_job, codes_of, run, say):
    """Runs every code on every case for a few steps. Returns one record a code and case."""
    records = []
    for case in cases:
        say(f"\nSame physics? {case}, {steps} steps from the given state. Differences are rms over the beads, relative "
            f"to LIGGGHTS's rms; far from walls: by {FAR / beds.DIAMETER:.0f} diameters at least. Overlaps and "
            "contacts are counted here.")
        say("| " + " | ".join(heading for _, heading, _ in COLUMNS) + " |")
        say("|" + "---|" * len(COLUMNS))
        reference = None
        for code in sorted(codes_of(case), key=lambda c: c != "liggghts"):
            job = dict(make_job(code, case), dump=True, warm=1, steps=steps - 1)
            record, state = describe(job, run)
            reference = reference or state
            record.update(compare(state, reference))
            records.append(record)
            say("| " + " | ".join(form.format(record[key]) for key, _, form in COLUMNS) + " |")
    return records


def describe(job, run):
    """What is told of a run by itself, and what is compared."""
    result = run(job)
    start, end = result["start"], result["end"]
    if start is None:
        # This project's program keeps accelerations of the last step: those of the start take a run of one step.
        start = run(dict(job, steps=0))["end"]
        start[:, :3] = beds.read(job["bed"])[:, :3]
    before, after = overlaps(start[:, :3]), overlaps(end[:, :3])
    record = {"code": job["code"], "case": job["case"], "steps": job["warm"] + job["steps"],
              "contacts_start": 2 * len(before) / len(start), "contacts_end": 2 * len(after) / len(end),
              "mean_overlap_start": 1e6 * float(before.mean()), "mean_overlap_end": 1e6 * float(after.mean()),
              "largest_overlap_end": 1e6 * float(after.max()), "rms_speed_end": rms(end[:, 3:6]),
              "rms_spin_end": rms(end[:, 6:9])}
    moved = end[:, :3] - start[:, :3]
    inner = np.minimum(start[:, :3], beds.SIZE - start[:, :3]).min(1) > FAR
    state = {"acceleration": start[:, 9:12], "turn": start[:, 12:15], "moved": moved, "spin": end[:, 6:9],
             "inner_moved": moved[inner], "inner_spin": end[inner, 6:9]}
    return record, state


def compare(state, reference):
    differences = {f"{name}_difference": rms(state[name] - reference[name]) / (rms(reference[name]) or 1.0)
                   for name in state}
    return {**differences, "moved": 1e6 * rms(state["moved"])}
