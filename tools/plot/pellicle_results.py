"""Reads the results folder of a pellicle run: snapshots, lines, probes, summary. docs/results.md describes the files.

    results = Results("results/quickstart")
    results.lines()                       # names
    results.line("z50mm")                 # Table: position, value, standard deviation, samples
    results.particle_times()              # [0.0, 0.05, ...]
    results.particles(0.5)                # the snapshot nearest to 0.5 s: dict of numpy arrays, and "time"
    results.parcels(0.5)                  # likewise the spray
    results.gas(0.5), results.gas_grid()  # arrays nz x ny x nx (x 3); face coordinates x, y, z
"""

import csv
import json
import sys
from pathlib import Path

import h5py
import numpy as np


class Table:
    """Columns of a CSV file by name, with or without the unit."""

    def __init__(self, header, columns, comments=()):
        self.header = header
        self.columns = columns
        self.comments = list(comments)

    def __getitem__(self, name):
        if isinstance(name, int):
            return self.columns[name]
        for header, column in zip(self.header, self.columns):
            if name in (header, header.split(" [")[0]):
                return column
        raise KeyError(f"no column {name} among {', '.join(self.header)}")

    def __len__(self):
        return len(self.columns[0])


def fail(message):
    sys.exit(f"error: {message}")


def read_csv(path):
    """A CSV file of numbers with one header row; lines that begin with # are kept as comments."""
    path = Path(path)
    try:
        lines = path.read_text().splitlines()
    except OSError as error:
        fail(f"{path}: {error.strerror}")
    comments = [line[1:].strip() for line in lines if line.startswith("#")]
    rows = list(csv.reader(line for line in lines if line.strip() and not line.startswith("#")))
    if not rows:
        fail(f"{path}: is empty")
    header, body = [name.strip() for name in rows[0]], rows[1:]
    try:
        values = np.array([[float(cell) for cell in row] for row in body]).reshape(len(body), len(header))
    except ValueError as error:
        fail(f"{path}: {error}")
    return Table(header, list(values.T), comments)


class Results:
    def __init__(self, folder):
        self.folder = Path(folder)
        if not self.folder.is_dir():
            fail(f"{folder}: no such results folder")

    @property
    def name(self):
        return self.folder.resolve().name

    def summary(self):
        try:
            return json.loads((self.folder / "summary.json").read_text())
        except (OSError, ValueError):
            return {}

    def _names(self, kind):
        return sorted(path.stem for path in (self.folder / kind).glob("*.csv"))

    def lines(self):
        return self._names("lines")

    def probes(self):
        return self._names("probes")

    def line(self, name):
        return read_csv(self.folder / "lines" / f"{name}.csv")

    def probe(self, name):
        return read_csv(self.folder / "probes" / f"{name}.csv")

    def _snapshots(self, name):
        """(time, group name) of each snapshot, in the order of time."""
        path = self.folder / f"{name}.h5"
        if not path.exists():
            return []
        with h5py.File(path, "r") as h5:
            groups = [(float(h5[g].attrs["time"]), g) for g in h5 if g.startswith("step") and "time" in h5[g].attrs]
        return sorted(groups)

    def _snapshot(self, name, time):
        snapshots = self._snapshots(name)
        if not snapshots:
            fail(f"{self.folder}: there are no snapshots of {name}")
        nearest_time, group = min(snapshots, key=lambda pair: abs(pair[0] - time))
        with h5py.File(self.folder / f"{name}.h5", "r") as h5:
            snapshot = {field: h5[group][field][...] for field in h5[group]}
        snapshot["time"] = nearest_time
        return snapshot

    def particle_times(self):
        return [time for time, _ in self._snapshots("particles")]

    def spray_times(self):
        return [time for time, _ in self._snapshots("spray")]

    def gas_times(self):
        return [time for time, _ in self._snapshots("gas")]

    def particles(self, time):
        return self._snapshot("particles", time)

    def parcels(self, time):
        return self._snapshot("spray", time)

    def gas(self, time):
        return self._snapshot("gas", time)

    def gas_average(self):
        """Fields NAME_mean and NAME_rms of gas_average.h5 by name, "from" and "time" [s]; None without it."""
        path = self.folder / "gas_average.h5"
        if not path.exists():
            return None
        with h5py.File(path, "r") as h5:
            group = h5["average"]
            return {name: group[name][...] for name in group} | {
                "from": float(group.attrs["from"]), "time": float(group.attrs["time"])}

    def gas_grid(self, file="gas.h5"):
        """Face coordinates [m] by axis, or None without gas snapshots; of the averages with `file` gas_average.h5."""
        path = self.folder / file
        if not path.exists():
            return None
        with h5py.File(path, "r") as h5:
            return {axis: h5["grid"][axis][...] for axis in "xyz"}
