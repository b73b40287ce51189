#!/usr/bin/python3
"""Plots time series (probes/NAME.csv) of one or several results folders, one panel a column.

    plot_series.py results/single_spout -o bed.png                          # all columns of the probe `bed`
    plot_series.py results/a results/b --column pressure_drop --column bed_height -o bed.png

Prints the mean and the standard deviation of each column over the time shown.
"""

import argparse

import numpy as np

from pellicle_results import Results, fail
from plot_style import COLOURS, pretty, use_style


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", nargs="+", help="results folders")
    parser.add_argument("--probe", default="bed", help="name of the probe; default: bed")
    parser.add_argument("--column", action="append", help="column to plot, again for more; default: all")
    parser.add_argument("--from", dest="begin", type=float, default=-np.inf, help="begin here [s]")
    parser.add_argument("--to", dest="end", type=float, default=np.inf, help="end here [s]")
    parser.add_argument("--label", action="append", help="name of a results folder in the legend, in their order")
    parser.add_argument("-o", "--output", required=True, help="picture: .png, .pdf or .svg")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    folders = [Results(path) for path in arguments.results]
    labels = arguments.label or [folder.name for folder in folders]
    if len(labels) != len(folders):
        fail(f"{len(labels)} labels for {len(folders)} results folders")
    tables = [folder.probe(arguments.probe) for folder in folders]
    columns = arguments.column or [name.split(" [")[0] for name in tables[0].header[1:]]
    plt = use_style()
    figure, axes = plt.subplots(len(columns), 1, sharex=True, squeeze=False, layout="constrained",
                                figsize=(6.6, 1.15 + 1.35 * len(columns)))
    for panel, column in zip(axes[:, 0], columns):
        for number, (label, table) in enumerate(zip(labels, tables)):
            time = table[0]
            shown = (time >= arguments.begin) & (time <= arguments.end)
            if not shown.any():
                fail(f"{label}: no rows between {arguments.begin} and {arguments.end} s")
            try:
                values = table[column][shown]
            except KeyError as error:
                fail(error.args[0])
            panel.plot(time[shown], values, color=COLOURS[number % len(COLOURS)], linewidth=1.1, label=label)
            print(f"{label}: {column}: mean {np.nanmean(values):.6g}, standard deviation {np.nanstd(values):.4g}")
        header = next(name for name in tables[0].header if column in (name, name.split(" [")[0]))
        panel.set_ylabel(pretty(header).replace(" [", "\n["))
    axes[-1, 0].set_xlabel("time [s]")
    figure.align_ylabels(axes[:, 0])
    if len(folders) > 1:
        axes[0, 0].legend(loc="best", ncols=min(3, len(folders)))
    figure.savefig(arguments.output)
    print(f"{arguments.output}: {', '.join(columns)}")


if __name__ == "__main__":
    main()
