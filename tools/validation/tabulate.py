#!/usr/bin/python3
"""Tables from results folders, as Markdown (or CSV with --csv).

A run is named LABEL=FOLDER. The tables:
  summary     what summary.json says: state, times, largest overlap and impact, defects, lost particles
  parts       wall time by part of the program
  bed         mean and standard deviation over time of the columns of a bed probe
  spout       velocity in the centre of lines and beside it
  difference  lines of runs against the same lines of the first run, beside the scatter of the first run itself
  profiles    the lines themselves, side by side
"""

import argparse
import csv
import json
import math
import pathlib
import sys


class TableError(Exception):
    """What is missing or wrong, in words for the user."""


# ---- reading a results folder ----


def read_csv(path):
    """Columns of a CSV file by their header; lines that begin with # are skipped."""
    try:
        with open(path, encoding="utf-8", newline="") as file:
            rows = list(csv.reader(line for line in file if not line.startswith("#")))
    except OSError as error:
        raise TableError(f"{path}: cannot be read ({error.strerror})") from error
    if not rows:
        raise TableError(f"{path}: is empty")
    header = [name.strip() for name in rows[0]]
    columns = {name: [] for name in header}
    for number, row in enumerate(rows[1:], 2):
        if len(row) != len(header):
            raise TableError(f"{path}: row {number} has {len(row)} values; the header has {len(header)}")
        for name, value in zip(header, row):
            columns[name].append(value)
    return columns


def numbers(path, columns, name):
    """A column as numbers, by its name with or without the unit."""
    for header, values in columns.items():
        if name in (header, header.split(" [")[0]):
            return [float(value) for value in values]
    raise TableError(f"{path}: no column {name}; it has {', '.join(columns)}")


def unit_of(columns, name):
    for header in columns:
        if header.split(" [")[0] == name and header.endswith("]"):
            return header[header.index(" [") + 2 : -1]
    return ""


class Line:
    """A time-averaged profile of a results folder: positions [m], values, samples."""

    def __init__(self, folder, name):
        path = pathlib.Path(folder) / "lines" / f"{name}.csv"
        columns = read_csv(path)
        headers = list(columns)
        if len(headers) < 4:
            raise TableError(f"{path}: not a line; position, value, standard deviation and samples are needed")
        self.name = name
        self.quantity = headers[1].split(" [")[0]
        self.unit = unit_of(columns, self.quantity)
        positions = [float(v) for v in columns[headers[0]]]
        values = [float(v) for v in columns[headers[1]]]
        samples = [float(v) for v in columns[headers[3]]]
        # A bin that never held a particle has no value.
        kept = [i for i, value in enumerate(values) if not math.isnan(value)]
        if not kept:
            raise TableError(f"{path}: has no samples; did the run reach the averaging window?")
        self.positions = [positions[i] for i in kept]
        self.values = [values[i] for i in kept]
        self.samples = [samples[i] for i in kept]

    def at(self, position):
        """Value by linear interpolation between the centres of the bins; that of the last bin beyond them."""
        x, v = self.positions, self.values
        if position <= x[0]:
            return v[0]
        for left in range(len(x) - 1):
            if position <= x[left + 1]:
                share = (position - x[left]) / (x[left + 1] - x[left])
                return v[left] + share * (v[left + 1] - v[left])
        return v[-1]

    def mean(self, chosen):
        """Mean over all samples of the bins whose position fulfils a condition."""
        picked = [(v, n) for x, v, n in zip(self.positions, self.values, self.samples) if chosen(x)]
        total = sum(n for _, n in picked)
        if total == 0:
            raise TableError(f"line {self.name}: no bin with samples where the mean is to be taken")
        return sum(v * n for v, n in picked) / total


def read_summary(folder):
    path = pathlib.Path(folder) / "summary.json"
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise TableError(f"{path}: cannot be read ({error.strerror})") from error
    except json.JSONDecodeError as error:
        raise TableError(f"{path}: not a summary ({error})") from error


# ---- statistics ----


def mean_and_deviation(values):
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / len(values))


def compare(line, base):
    """How far a line is from another one at the bins of that: RMS, largest (with sign), RMS in % of the peak."""
    differences = [line.at(x) - value for x, value in zip(base.positions, base.values)]
    rms = math.sqrt(sum(d * d for d in differences) / len(differences))
    return [figure(rms), figure(max(differences, key=abs)), figure(100 * rms / max(abs(v) for v in base.values))]


# ---- tables: each returns (header, rows) ----


def figure(value, digits=3):
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "-"
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return str(value)
    return f"{value:.{digits}g}"


def table_summary(runs, _args):
    header = ["run", "state", "simulated [s]", "wall [s]", "wall per simulated second", "threads", "particles",
              "lost", "largest overlap [% of R]", "largest impact [m/s]", "contacts per particle",
              "defect of gas mass", "defect of momentum"]
    rows = []
    for label, folder in runs:
        s = read_summary(folder)
        defects = s.get("defects", {})
        rows.append([label, s["status"], figure(s["simulated_seconds"]), figure(s["wall_seconds"], 4),
                     figure(s["wall_seconds_per_simulated_second"], 4), figure(s["threads"]),
                     figure(s["particles"]),
                     figure(s["lost_particles"] + s.get("particles_left_through_open_sides", 0)),
                     figure(100 * s["largest_overlap_ratio"]), figure(s["largest_impact_speed"]),
                     figure(s["contacts_per_particle"]), figure(defects.get("gas_mass"), 2),
                     figure(defects.get("momentum"), 2)])
    return header, rows


def table_parts(runs, _args):
    summaries = [(label, read_summary(folder)) for label, folder in runs]
    parts = [name for name in summaries[0][1]["wall_by_part"]
             if any(s["wall_by_part"].get(name, 0) > 0 for _, s in summaries)]
    header = ["run", "wall [s]"] + [f"{name} [%]" for name in parts]
    rows = []
    for label, s in summaries:
        wall = s["wall_seconds"]
        rows.append([label, figure(wall, 4)] +
                    [figure(100 * s["wall_by_part"].get(name, 0) / wall) if wall > 0 else "-" for name in parts])
    return header, rows


def table_bed(runs, args):
    header, rows = ["run"], []
    for label, folder in runs:
        path = pathlib.Path(folder) / "probes" / f"{args.probe}.csv"
        columns = read_csv(path)
        times = numbers(path, columns, "time")
        chosen = [i for i, t in enumerate(times) if args.begin < t <= args.end]
        if not chosen:
            raise TableError(f"{path}: no rows between {args.begin:g} and {args.end:g} s")
        row = [label]
        for quantity in args.quantities:
            values = numbers(path, columns, quantity)
            mean, deviation = mean_and_deviation([values[i] for i in chosen])
            row += [figure(mean, 4), figure(deviation)]
        if len(header) == 1:
            for quantity in args.quantities:
                unit = unit_of(columns, quantity)
                header += [f"{quantity} [{unit}]", "standard deviation"]
        rows.append(row)
    return header, rows


def table_spout(runs, args):
    header = ["run"]
    for name in args.lines:
        header += [f"{name}: centre", f"{name}: largest", f"{name}: annulus", f"{name}: lowest"]
    rows = []
    for label, folder in runs:
        row = [label]
        for name in args.lines:
            line = Line(folder, name)
            row += [figure(line.at(args.centre)), figure(max(line.values)),
                    figure(line.mean(lambda x: abs(x - args.centre) >= args.annulus)), figure(min(line.values))]
        rows.append(row)
    return header, rows


def table_difference(runs, args):
    base_label, base_folder = runs[0]
    header = ["run", "line", f"RMS difference from {base_label}", "largest difference", "RMS as % of the peak"]
    rows = []
    for label, folder in runs[1:]:
        for name in args.lines:
            rows.append([label, name, *compare(Line(folder, name), Line(base_folder, name))])
    for first, second in args.scatter:
        # What two windows of one run differ by is what averaging over such a time leaves to chance.
        rows.append([f"{base_label} itself", f"{second} from {first}",
                     *compare(Line(base_folder, second), Line(base_folder, first))])
    return header, rows


def table_profiles(runs, args):
    header, rows = ["run", "line", "x [m]", "value", "samples"], []
    for label, folder in runs:
        for name in args.lines:
            line = Line(folder, name)
            for x, value, samples in zip(line.positions, line.values, line.samples):
                rows.append([label, name, figure(x, 6), figure(value, 5), f"{samples:.0f}"])
    return header, rows


def markdown(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def comma_separated(header, rows):
    return "\n".join(",".join(f'"{v}"' if "," in v else v for v in row) for row in [header] + rows) + "\n"


# ---- command line ----


def named_run(text):
    label, sign, folder = text.partition("=")
    if not sign or not label or not folder:
        raise argparse.ArgumentTypeError(f"{text}: a run is LABEL=FOLDER")
    return label, folder


def window_pair(text):
    first, sign, second = text.partition(":")
    if not sign:
        raise argparse.ArgumentTypeError(f"{text}: two lines of the first run, FIRST:SECOND")
    return first, second


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    tables = parser.add_subparsers(dest="table", required=True)

    def add(name, function):
        table = tables.add_parser(name)
        table.add_argument("runs", nargs="+", type=named_run, metavar="LABEL=FOLDER")
        table.add_argument("--csv", action="store_true", help="comma-separated values in place of Markdown")
        table.set_defaults(function=function)
        return table

    add("summary", table_summary)
    add("parts", table_parts)
    bed = add("bed", table_bed)
    bed.add_argument("--probe", default="bed", help="name of the bed probe (default: bed)")
    bed.add_argument("--from", dest="begin", type=float, default=0, help="start of the mean [s]")
    bed.add_argument("--to", dest="end", type=float, default=math.inf, help="end of the mean [s]")
    bed.add_argument("--quantities", nargs="+",
                     default=["pressure_drop", "bed_height", "mean_height", "mean_speed", "kinetic_energy"])
    spout = add("spout", table_spout)
    spout.add_argument("--lines", nargs="+", required=True)
    spout.add_argument("--centre", type=float, required=True, help="position of the spout [m]")
    spout.add_argument("--annulus", type=float, required=True,
                       help="the annulus is what is at least so far from the spout [m]; mean over all samples")
    difference = add("difference", table_difference)
    difference.add_argument("--lines", nargs="+", required=True)
    difference.add_argument("--scatter", nargs="+", type=window_pair, default=[], metavar="FIRST:SECOND",
                            help="two windows of the first run, to be compared with each other")
    add("profiles", table_profiles).add_argument("--lines", nargs="+", required=True)
    return parser.parse_args(arguments)


def main(arguments=None):
    args = parse(arguments)
    try:
        header, rows = args.function(args.runs, args)
    except TableError as error:
        print(f"tabulate: {error}", file=sys.stderr)
        return 2
    sys.stdout.write((comma_separated if args.csv else markdown)(header, rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
