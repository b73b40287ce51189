#!/usr/bin/python3
"""Writes a case that starts with the particles of another run: its case as run, with a snapshot's particles, one by one, in
place of the fill, and without settling. Only for cases of one population. Spin is taken over if the snapshot has it.

  case_from_snapshot.py results/mueller_bed --time 6 -o results/from_beetstra.yaml
  ./pellicle run results/from_beetstra.yaml --set coupling.drag=koch_hill
"""

import argparse
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "plot"))
from pellicle_results import Results, fail  # noqa: E402


def numbers(values):
    return "[" + ", ".join(f"{value:.17g}" for value in values) + "]"


def entry(snapshot, p):
    words = [f"position: {numbers(snapshot['position'][p])}", f"velocity: {numbers(snapshot['velocity'][p])}",
             f"diameter: {2 * snapshot['radius'][p]:.17g}"]
    if "spin" in snapshot:
        words.append(f"spin: {numbers(snapshot['spin'][p])}")
    return "    - {" + ", ".join(words) + "}"


def replace_section(text, key, made):
    """The text with one section of the top level replaced."""
    changed, count = re.subn(rf"^{key}:\n(?:[ -].*\n)+", lambda _: made, text, flags=re.MULTILINE)
    if count != 1:
        fail(f"no section {key} in the case as run")
    return changed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="results folder")
    parser.add_argument("--time", type=float, required=True, help="simulated time; the nearest snapshot is taken [s]")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="the case")
    args = parser.parse_args()
    results = Results(args.results)
    snapshot = results.particles(args.time)
    for field in ("id", "position", "velocity", "radius"):
        if field not in snapshot:
            fail(f"{args.results}: its snapshots have no {field}; add it to output.snapshots.particles")
    text = (results.folder / "case.yaml").read_text(encoding="utf-8")
    materials = re.findall(r"^- material: (\S+)$", text, flags=re.MULTILINE)
    if len(materials) != 1:
        fail(f"{args.results}: its case has {len(materials)} populations, not one")
    order = snapshot["id"].argsort()
    listed = "\n".join(entry(snapshot, p) for p in order)
    text = replace_section(text, "particles", f"particles:\n- material: {materials[0]}\n  list:\n{listed}\n")
    text = re.sub(r"^  settle: .*$", "  settle: 0", text, flags=re.MULTILINE)
    args.output.write_text(f"# {len(order)} particles of {results.name} at {snapshot['time']:g} s.\n{text}",
                           encoding="utf-8")


if __name__ == "__main__":
    main()
