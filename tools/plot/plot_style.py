"""One look for all figures of the project."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# Okabe & Ito (2008): told apart by colour-blind readers too.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#6b6b6b"]
LINES = ["-", "--", "-.", (0, (1, 1)), (0, (5, 1, 1, 1, 1, 1))]


def use_style():
    plt.rcParams.update({
        "figure.dpi": 150,
        "savefig.dpi": 200,
        "font.family": "sans-serif",
        "font.sans-serif": ["DejaVu Sans"],
        "font.size": 9,
        "axes.titlesize": 10,
        "axes.labelsize": 9,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.linewidth": 0.8,
        "axes.grid": True,
        "grid.color": "#e4e4e4",
        "grid.linewidth": 0.6,
        "axes.axisbelow": True,
        "legend.frameon": False,
        "legend.fontsize": 8.5,
        "lines.linewidth": 1.7,
        "lines.solid_capstyle": "round",
        "xtick.direction": "out",
        "ytick.direction": "out",
    })
    return plt


def split_unit(header):
    """("x", "m") from "x [m]"; also from "x_m", "vz_m_s" and "voidage" as published tables write them."""
    if " [" in header:
        name, unit = header.split(" [", 1)
        return name, unit.rstrip("]")
    for ending, unit in (("_m_s", "m/s"), ("_m", "m"), ("_Pa", "Pa"), ("_s", "s"), ("_mm", "mm")):
        if header.endswith(ending):
            return header[: -len(ending)], unit
    return header, "-"


def pretty(header):
    """Axis label: "particle velocity z [m/s]"; without unit where there is none."""
    name, unit = split_unit(header)
    words = name.replace("_", " ")
    return words if unit == "-" else f"{words} [{unit}]"
