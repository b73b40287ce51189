"""How this project's engine fares with the size of a packed bed: rates and memory, with tools/benchmarks/dem_packed."""

import re

NUMBERS = {
    "particles": r"^(\d+) particles",
    "rate": r"([\d.]+) million particle-steps/s/core",
    "rate_min": r"\(min ([\d.]+)",
    "rate_max": r"max ([\d.]+)\)",
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


def time_sizes(sizes, run, say):
    """Times beds of about these numbers of beads; `run(size, steps)` gives dem_packed's output. One record a size."""
    records = []
    for size in sizes:
        output = run(size, steps_for(size))
        record = {"steps": steps_for(size)}
        for name, pattern in NUMBERS.items():
            found = re.search(pattern, output, re.MULTILINE)
            if not found:
                raise SystemExit(f"dem_vs_peers: no {name} in what dem_packed printed:\n{output}")
            record[name] = float(found[1])
        records.append(record)
    nearest = min(records, key=lambda r: abs(r["particles"] - REFERENCE))
    say(f"Million particle-steps per second and core, relative to {nearest['particles']:.0f} beads.")
    say("| beads | steps a timing | median | least | most | relative | contacts, start | end | lists built "
        "| bytes a bead |")
    say("|" + "---|" * 10)
    for r in records:
        r["relative"] = r["rate"] / nearest["rate"]
        say(f"| {r['particles']:.0f} | {r['steps']} | {r['rate']:.2f} | {r['rate_min']:.2f} | {r['rate_max']:.2f} "
            f"| {r['relative']:.3f} | {r['contacts_start']:.2f} | {r['contacts_end']:.2f} | {r['list_builds']:.0f} "
            f"| {r['bytes_per_particle']:.0f} |")
    return records
