"""How this project's engine fares with the size of a packed bed: rates and memory, with tools/benchmarks/dem_packed."""

import re
import statistics

NUMBERS = {
    "particles": r"^(\d+) particles",
    "rate": r"([\d.]+) million particle-steps/s/core",
    "contacts_start": r"contacts per particle ([\d.]+)",
    "contacts_end": r"then ([\d.]+)",
    "list_builds": r"(\d+) list builds",
    "bytes_per_particle": r"memory ([\d.]+) bytes",
}
SIZES = (10000, 50000, 200000, 1000000, 5000000)
REFERENCE = 50000


def steps_for(size):
    """Fewer for beds that take long."""
    return 200 if size <= 200000 else max(20, int(200 * 200000 / size))


def read_output(output):
    record = {}
    for name, pattern in NUMBERS.items():
        found = re.search(pattern, output, re.MULTILINE)
        if not found:
            raise SystemExit(f"dem_vs_peers: no {name} in what dem_packed printed:\n{output}")
        record[name] = float(found[1])
    return record


def time_sizes(sizes, repeats, run, say):
    """Times beds of about so many beads, each repetition anew from the settled state. One record a size; `run(size,
    steps)` gives what dem_packed prints."""
    rounds = [{size: read_output(run(size, steps_for(size))) for size in sizes} for _ in range(repeats)]
    records = []
    for size in sizes:
        rates = [done[size]["rate"] for done in rounds]
        records.append(dict(rounds[0][size], steps=steps_for(size), rate=statistics.median(rates),
                            rate_min=min(rates), rate_max=max(rates)))
    reference = min(sizes, key=lambda size: abs(size - REFERENCE))
    say(f"Million particle-steps per second and core, relative to {reference} beads (median of the repetitions' own).")
    say("| beads | steps | median | least | most | relative | contacts, start | end | lists built | bytes a bead |")
    say("|" + "---|" * 10)
    for size, r in zip(sizes, records):
        r["relative"] = statistics.median(done[size]["rate"] / done[reference]["rate"] for done in rounds)
        say(f"| {r['particles']:.0f} | {r['steps']} | {r['rate']:.2f} | {r['rate_min']:.2f} | {r['rate_max']:.2f} "
            f"| {r['relative']:.3f} | {r['contacts_start']:.2f} | {r['contacts_end']:.2f} | {r['list_builds']:.0f} "
            f"| {r['bytes_per_particle']:.0f} |")
    return records
