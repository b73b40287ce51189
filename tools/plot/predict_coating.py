#!/usr/bin/python3
"""Coating at the end of a batch from seconds of it: mean and coefficient of variation at given times, by renewal theory.

Particles pass a zone again and again; each cycle takes a time tau and brings a gain g, and cycles of one particle are taken
as independent. For a renewal reward process (Cox 1962, Renewal Theory, section 8; Smith 1955, Proc. R. Soc. Edinb. A 64, 9)
the coating M(t) has, for t well over a cycle,

    mean M = r t,  r = mean(g) / mean(tau)
    var M = t / mean(tau) (var g + r^2 var tau - 2 r cov(g, tau))

The spray may begin later than the run (`spray.from`, read from the results' case.yaml): t counts from there, cycles from
the run's start. What the particles were coated with at the start (`initial_solids`, the table's first rows) stays and is
added to what they gain. The particles have to be the same throughout.

What a short run measures of this is censored: long cycles do not end in it. Mean(tau) is therefore particles x time /
entries, which needs no cycle to end; var tau comes from the Kaplan-Meier estimate of the distribution (Kaplan & Meier 1958,
J. Am. Stat. Assoc. 53, 457) of ended and open cycles, with an exponential tail that gives the same mean. The rate r is the
mass of all coatings over the time. With size classes, the classes' different rates add to the variation.

Successive cycles are not independent where a particle hovers at the zone's edge or in the spray, and what open cycles
have brought is not among the gains. The second figure, "by growth", needs neither: var M grows linearly in the end, and
its slope is measured as the variance (within size classes) of the last half of the time less that of the first.

The error is a jackknife over the groups of particles that zones/NAME_groups.csv has.
"""

import argparse
import csv
import json
import math
import pathlib
import re
import sys


def read_times(path):
    """Rows of each time in a table, as dictionaries of numbers by the columns' bare names, in the order of time."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    names = [name.split(" [")[0] for name in rows[0]]
    times = {}
    for row in rows[1:]:
        numbers = dict(zip(names, map(float, row)))
        times.setdefault(numbers["time"], []).append(numbers)
    if not times:
        sys.exit(f"{path}: it has no rows yet; let the run go on to the zone's first `every`")
    return [times[t] for t in sorted(times)]


def nearest(tables, wanted):
    return min(tables, key=lambda rows: abs(rows[0]["time"] - wanted))


def read_spray_times(case):
    """Of the nozzles in a case as run, the earliest `from` and the earliest `to` [s]; 0 and infinity without such a file or
    without spray."""
    if not case.is_file():
        return 0.0, math.inf
    block = re.search(r"^spray:\n((?:[ -].*\n)*)", case.read_text(), re.MULTILINE)
    starts = re.findall(r"^[ -] from: ([-+.0-9e]+)", block[1], re.MULTILINE) if block else []
    ends = re.findall(r"^[ -] to: ([-+.0-9e]+)", block[1], re.MULTILINE) if block else []
    return min(map(float, starts), default=0.0), min(map(float, ends), default=math.inf)


def survival(times):
    """Kaplan-Meier on bins: upper ends of the bins and the share of cycles that are longer. An open cycle is at risk for
    half of the bin that it is in."""
    at_risk = sum(row["cycles"] + row["open_cycles"] for row in times)
    share, ends, shares = 1.0, [], []
    for row in times:
        if math.isinf(row["to"]):
            break
        exposed = at_risk - 0.5 * row["open_cycles"]
        if exposed > 0:
            share *= max(0.0, 1 - row["cycles"] / exposed)
        at_risk -= row["cycles"] + row["open_cycles"]
        ends.append(row["to"])
        shares.append(share)
        if at_risk <= 0:
            break
    return ends, shares


def cycle_variance(times, mean):
    """Variance of the cycle time, its mean being known, and the share of cycles beyond the distribution's end."""
    ends, shares = survival(times)
    first = second = 0.0  # integrals of S and of 2 tau S, S linear in a bin
    low, before = 0.0, 1.0
    for high, after in zip(ends, shares):
        width = high - low
        first += width * 0.5 * (before + after)
        second += width * (low * (before + after) + width * (before + 2 * after) / 3)
        low, before = high, after
    tail = shares[-1]
    if tail > 0:
        # S = tail exp(-(tau - low) / scale), with the scale that gives the mean. Mass that the mean does not leave room
        # for is cut off.
        scale = max(0.0, (mean - first) / tail)
        second += 2 * tail * scale * (low + scale)
        first += tail * scale
    return max(0.0, second - 2 * first * mean + mean * mean), tail


def add(rows):
    total = {}
    for row in rows:
        for name, value in row.items():
            total[name] = total.get(name, 0.0) + value
    return total


def moments(sums, before, time, sprayed, between):
    """Of cycles from sums over particles in `time`, of which they were `sprayed` for so long; `before` are those at the
    start of the spray, or `between` before the end. `steady` needs no cycle to have ended."""
    n = sums["cycles"]
    gained = sums["coating"] - before["coating"]
    if n < 2 or sums["entries"] < 1 or gained <= 0:
        return None
    # Cycles before the spray brought nothing; they are that share of all of them.
    gain, gain_squared, time_gain = (sums[name] * time / sprayed for name in ("gain", "gain_squared", "time_gain"))
    mean_time, mean_gain = sums["cycle_time"] / n, gain / n
    return {
        "steady": sums["particles"] * time / sums["entries"],
        "initial": before["coating"] / sums["particles"],
        "rate": gained / sums["particles"] / between,
        "time_variance": max(0.0, (sums["cycle_time_squared"] - n * mean_time**2) / (n - 1)),
        "gain_variance": max(0.0, (gain_squared - n * mean_gain**2) / (n - 1)),
        "covariance": (time_gain - n * mean_time * mean_gain) / (n - 1),
    }


def by_class(rows):
    classes = {}
    for row in rows:
        classes.setdefault(row["size_class"], []).append(row)
    return {name: add(members) for name, members in classes.items()}


def scatter_within(sums):
    """Sum over particles of the squared deviation from their mean coating [kg2]."""
    return max(0.0, sums["coating_squared"] - sums["coating"] ** 2 / sums["particles"]) if sums["particles"] else 0.0


def variance_of_classes(rows, before, scale):
    """Of the size classes' mean coatings [kg2] when each has gained `scale` times what it has so far, less what the scatter
    within the classes adds."""
    parts, starts = by_class(rows), by_class(before)
    if len(parts) < 2:
        return 0.0

    def expected(sums, start):
        return (start["coating"] + scale * (sums["coating"] - start["coating"])) / sums["particles"]

    mean = expected(add(rows), add(before))
    variance = 0.0
    for name, part in parts.items():
        if part["particles"] < 2:
            continue
        scatter = max(0.0, scatter_within(part) - scatter_within(starts[name])) / part["particles"] ** 2
        share = part["particles"] / add(rows)["particles"]
        variance += share * ((expected(part, starts[name]) - mean) ** 2 - scale**2 * scatter)
    return max(0.0, variance)


def variance_within_classes(rows):
    """Of the coating of a particle [kg2]."""
    sums = by_class(rows).values()
    return sum(map(scatter_within, sums)) / sum(part["particles"] for part in sums)


def predict(tables, times, at, start=0.0):
    """Mean [kg] and coefficients of variation of the coating at the times `at`, and what they are made of. `tables` are the
    rows of each time; sprayed from `start` on."""
    groups, first = tables[-1], tables[0]
    time = groups[0]["time"]
    if not (time > start and min(at) > start):
        sys.exit(f"the spray begins at {start:g} s: later times are needed")
    watched = groups[0].get("watched", time)
    sprayed = time - max(start, time - watched)  # of the time that was watched
    if first[0]["time"] > start:
        if watched < time:
            # A zone that a resumed run has begun to watch: what is there at its first row counts as the start.
            start = first[0]["time"]
        else:
            first = [dict(row, coating=0.0, coating_squared=0.0) for row in groups]
    there, then = add(groups)["particles"], add(first)["particles"]
    if abs(there - then) > 0.01 * then:
        sys.exit(f"the particles are not the same throughout: {then:g} at the start, {there:g} at the end; allowed: a "
                 "change of 1 %")
    every = moments(add(groups), add(first), watched, sprayed, time - start)
    if every is None:
        sys.exit("fewer than two cycles have ended, or nothing is coated yet: a longer run is needed")
    spread, open_share = cycle_variance(times, every["steady"])
    middle = nearest(tables, 0.5 * (start + time))
    interval = time - middle[0]["time"]
    # Correlation as of the ended cycles, with the variance that the long ones have too.
    widening = spread / every["time_variance"] if every["time_variance"] > 0 else 1.0

    def figures(rows, earlier, before):
        m = moments(add(rows), add(before), watched, sprayed, time - start)
        if m is None:
            return None
        r = m["rate"]
        one = (m["gain_variance"] + r * r * widening * m["time_variance"]
               - 2 * r * math.sqrt(widening) * m["covariance"])
        now, initially = variance_within_classes(rows), variance_within_classes(before)
        slope = max(0.0, now - variance_within_classes(earlier)) / interval if interval > 0 else math.nan
        result = []
        for t in (when - start for when in at):
            mean = m["initial"] + r * t
            own = initially + max(0.0, one) * t / m["steady"]
            grown = max(0.0, now + slope * (t - (time - start)))
            of_classes = variance_of_classes(rows, before, t / (time - start))
            result.append((mean, math.sqrt(own + of_classes) / mean, math.sqrt(grown + of_classes) / mean))
        return result

    whole = figures(groups, middle, first)
    names = sorted({row["group"] for row in groups})

    def others(rows, name):
        return [row for row in rows if row["group"] != name]

    without = [figures(others(groups, name), others(middle, name), others(first, name)) for name in names]
    without = [part for part in without if part is not None]
    predictions = []
    for n, t in enumerate(at):
        errors = []
        for k in (0, 1, 2):
            values = [part[n][k] for part in without]
            mean = sum(values) / len(values)
            errors.append(math.sqrt((len(values) - 1) / len(values) * sum((v - mean) ** 2 for v in values)))
        predictions.append({"time": t, "coating_mean": whole[n][0], "coating_mean_error": errors[0],
                            "coating_cov": whole[n][1], "coating_cov_error": errors[1],
                            "coating_cov_growth": whole[n][2], "coating_cov_growth_error": errors[2]})
    basis = {"measured_time": time, "spray_start": start, "mean_cycle_time": every["steady"], "sd_cycle_time": math.sqrt(spread),
             "cycles_beyond_distribution": open_share, "mean_gain": every["rate"] * every["steady"],
             "sd_gain": math.sqrt(every["gain_variance"]), "initial_coating": every["initial"],
             "variation_of_size_classes":
                 math.sqrt(variance_of_classes(groups, first, 1.0)) / (every["initial"] + every["rate"] * (time - start))}
    return basis, predictions


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path, help="results folder of a run with the zone")
    parser.add_argument("zone", help="name of the zone: output.zones")
    parser.add_argument("--time", type=float, nargs="+", required=True, help="batch times [s]")
    parser.add_argument("--json", type=pathlib.Path, help="write the figures to this file too")
    arguments = parser.parse_args()
    groups_file = arguments.results / "zones" / f"{arguments.zone}_groups.csv"
    times_file = arguments.results / "histograms" / f"{arguments.zone}_times.csv"
    for path in (groups_file, times_file):
        if not path.is_file():
            sys.exit(f"{path}: not there; allowed: the results of a run whose case has the zone {arguments.zone}")
    tables = read_times(groups_file)
    start, end = read_spray_times(arguments.results / "case.yaml")
    if end < tables[-1][0]["time"]:
        sys.exit(f"a nozzle closes at {end:g} s, before the end of what was measured: the rate would be too low; allowed: a "
                 "run of which the spray does not end")
    basis, predictions = predict(tables, read_times(times_file)[-1], arguments.time, start)
    print(f"measured over {basis['measured_time']:g} s, sprayed from {basis['spray_start']:g} s: "
          f"cycle time {basis['mean_cycle_time']:.4g} s (standard deviation {basis['sd_cycle_time']:.4g} s), gain {basis['mean_gain']:.4g} kg a cycle "
          f"(standard deviation {basis['sd_gain']:.4g} kg)")
    if basis["cycles_beyond_distribution"] > 0.2:
        print(f"{100 * basis['cycles_beyond_distribution']:.0f} % of the cycles are longer than what was seen: their "
              "spread is a guess; a longer run would tell")
    print("time [s]  coating of a particle [kg]  coefficient of variation: by cycles  by growth")
    for p in predictions:
        print(f"{p['time']:8g}  {p['coating_mean']:.4g} +- {p['coating_mean_error']:.2g}"
              f"{p['coating_cov']:25.4f} +- {p['coating_cov_error']:.2g}"
              f"{p['coating_cov_growth']:12.4f} +- {p['coating_cov_growth_error']:.2g}")
    if arguments.json:
        arguments.json.write_text(json.dumps({"basis": basis, "predictions": predictions}, indent=1) + "\n")


if __name__ == "__main__":
    main()
