#!/usr/bin/python3
"""Plots the averaged profiles (lines/NAME.csv) of one or several results folders, with published data beside them.

    plot_profiles.py results/beetstra results/koch_hill -o profiles.png
    plot_profiles.py results/mueller --line void16mm --reference void16mm=measured.csv --table deviations.md -o out.png

With reference data a table of deviations is printed: root mean square, largest, and both as a share of the largest
published magnitude. The simulated profile is interpolated linearly between the centres of its bins to the published
positions; published points outside the outermost centres are left out, and counted.

A reference file is a CSV file of two or more columns in SI units: position, value. Lines that begin with # are
comments.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from pellicle_results import Results, fail, read_csv
from plot_style import COLOURS, LINES, pretty, split_unit, use_style


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="results folders")
    parser.add_argument("--line", action="append", help="line to plot, again for more; default: all")
    parser.add_argument("--label", action="append", help="name of a results folder in the legend, in their order")
    parser.add_argument("--reference", action="append", default=[], metavar="[LINE=]FILE",
                        help="published data of a line; again for more")
    parser.add_argument("--reference-label", default="published", help="name of the published data in the legend")
    parser.add_argument("--spread", action="store_true", help="also shade one standard deviation of the samples")
    parser.add_argument("--title", help="over the figure")
    parser.add_argument("--columns", type=int, default=0, help="panels side by side; default: up to 3")
    parser.add_argument("--table", help="write the deviations here: .csv or .md")
    parser.add_argument("-o", "--output", required=True, help="picture: .png, .pdf or .svg")
    return parser.parse_args()


def choose_lines(folders, wanted):
    """Names of lines that at least one folder has, in the order of the first folder."""
    known = []
    for folder in folders:
        known += [name for name in folder.lines() if name not in known]
    if not known:
        fail(f"{folders[0].folder}: holds no lines/*.csv")
    for name in wanted or []:
        if name not in known:
            fail(f"no line {name}; there are {', '.join(known)}")
    return wanted or known


def read_references(arguments, lines):
    """Reference tables by line."""
    references = {}
    for text in arguments.reference:
        line, separator, path = text.partition("=")
        if not separator:
            if len(lines) != 1:
                fail(f"--reference {text}: say which line it belongs to, LINE=FILE; lines: {', '.join(lines)}")
            line, path = lines[0], text
        if line not in lines:
            fail(f"--reference {text}: no line {line}; lines: {', '.join(lines)}")
        references.setdefault(line, []).append((Path(path), read_csv(path)))
    return references


def deviations(simulated, published):
    """Deviations of a simulated profile from published points, as a dictionary."""
    position, value = simulated[0], simulated[1]
    filled = np.isfinite(value)
    position, value = position[filled], value[filled]
    where, measured = published[0], published[1]
    if len(position) == 0:
        return None
    order = np.argsort(position)
    position, value = position[order], value[order]
    inside = (where >= position[0]) & (where <= position[-1])
    if not inside.any():
        return None
    difference = np.interp(where[inside], position, value) - measured[inside]
    worst = np.argmax(np.abs(difference))
    scale = np.abs(measured).max()
    rms = np.sqrt(np.mean(difference**2))
    return {"points": int(inside.sum()), "left_out": int((~inside).sum()), "mean": difference.mean(), "rms": rms,
            "largest": difference[worst], "at": where[inside][worst], "rms_share": rms / scale,
            "largest_share": abs(difference[worst]) / scale}


def table_rows(rows):
    header = ["line", "run", "points", "left out", "mean deviation", "RMS deviation", "largest deviation",
              "at [m]", "RMS / peak [%]", "largest / peak [%]"]
    body = [[line, run, str(d["points"]), str(d["left_out"]), f"{d['mean']:+.4g}", f"{d['rms']:.4g}",
             f"{d['largest']:+.4g}", f"{d['at']:.5g}", f"{100 * d['rms_share']:.1f}", f"{100 * d['largest_share']:.1f}"]
            for line, run, d in rows]
    return header, body


def as_markdown(header, body):
    widths = [max(len(row[c]) for row in [header] + body) for c in range(len(header))]
    text = "| " + " | ".join(cell.ljust(width) for cell, width in zip(header, widths)) + " |\n"
    text += "|" + "|".join("-" * (width + 2) for width in widths) + "|\n"
    for row in body:
        text += "| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |\n"
    return text


def report(rows, path):
    header, body = table_rows(rows)
    markdown = as_markdown(header, body)
    print(markdown, end="")
    print("Simulated profiles are interpolated linearly between bin centres to the published positions.")
    if path is None:
        return
    if path.endswith(".csv"):
        Path(path).write_text("\n".join(",".join(row) for row in [header] + body) + "\n")
    else:
        Path(path).write_text(markdown)


def position_scale(tables):
    """Millimetres where the line is shorter than 1 m."""
    longest = max(np.ptp(table[0]) for table in tables)
    return (1e3, "mm") if longest < 1 else (1.0, "m")


def draw_line(axes, name, profiles, references, arguments):
    tables = [table for _, table in profiles] + [table for _, table in references]
    scale, unit = position_scale(tables)
    for number, (label, table) in enumerate(profiles):
        colour = COLOURS[number % len(COLOURS)]
        axes.plot(scale * table[0], table[1], color=colour, linestyle=LINES[number // len(COLOURS) % len(LINES)],
                  label=label, zorder=3)
        if arguments.spread:
            axes.fill_between(scale * table[0], table[1] - table[2], table[1] + table[2], color=colour, alpha=0.13,
                              linewidth=0, zorder=1)
    for number, (path, table) in enumerate(references):
        label = arguments.reference_label if len(references) == 1 else f"{arguments.reference_label}: {path.stem}"
        axes.plot(scale * table[0], table[1], "osD^v"[number % 5], color="#222222", markersize=4.2,
                  markerfacecolor="white", markeredgewidth=1.0, linestyle="none", label=label, zorder=4)
    lowest = min(np.nanmin(table[1]) for table in tables)
    highest = max(np.nanmax(table[1]) for table in tables)
    if lowest < 0 < highest:
        axes.axhline(0, color="#9a9a9a", linewidth=0.8, zorder=2)
    first = profiles[0][1]
    position, _ = split_unit(first.header[0])
    axes.set_xlabel(f"{position} [{unit}]")
    axes.set_ylabel(pretty(first.header[1]))
    axes.set_title(name, loc="left")
    axes.margins(x=0.02)


def main():
    arguments = parse_arguments()
    folders = [Results(path) for path in arguments.results]
    labels = arguments.label or [folder.name for folder in folders]
    if len(labels) != len(folders):
        fail(f"{len(labels)} labels for {len(folders)} results folders")
    lines = choose_lines(folders, arguments.line)
    references = read_references(arguments, lines)

    plt = use_style()
    columns = arguments.columns or min(3, len(lines))
    rows = -(-len(lines) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(max(4.6, 3.7 * columns), 3.1 * rows + 0.35), squeeze=False,
                                layout="constrained")
    compared = []
    for panel, name in zip(axes.flat, lines):
        profiles = [(label, folder.line(name)) for label, folder in zip(labels, folders) if name in folder.lines()]
        draw_line(panel, name, profiles, references.get(name, []), arguments)
        for _, published in references.get(name, []):
            for label, table in profiles:
                found = deviations(table, published)
                if found is None:
                    print(f"warning: {name}, {label}: no published point lies within the profile", file=sys.stderr)
                else:
                    compared.append((name, label, found))
    for panel in axes.flat[len(lines):]:
        panel.set_visible(False)
    handles = {}
    for panel in axes.flat:
        for handle, label in zip(*panel.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    # Below all panels, in a strip that the layout leaves free.
    columns_of_legend = min(4, len(handles))
    strip = 0.26 * -(-len(handles) // columns_of_legend) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, strip, 1, 1 - strip))
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=columns_of_legend)
    if arguments.title:
        figure.suptitle(arguments.title, fontsize=11)
    figure.savefig(arguments.output)
    print(f"{arguments.output}: {', '.join(lines)}")
    if compared:
        report(compared, arguments.table)


if __name__ == "__main__":
    main()
