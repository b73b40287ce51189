#!/usr/bin/pvpython
"""Opens the particles, the gas and its averages of a results folder in ParaView and compares every time step with the HDF5 files.

    pvpython tools/validation/check_paraview.py RESULTS

Ends with 0 if all counts and values agree, and says what differs otherwise.
"""

import sys
from pathlib import Path

import h5py
import numpy as np
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy


def snapshots(h5):
    """(time, group) of every snapshot, in the order of time; of averages the one that there is."""
    groups = [h5[name] for name in h5 if name.startswith("step") or name == "average"]
    return sorted(((g.attrs["time"], g) for g in groups), key=lambda pair: pair[0])


def leaf(data):
    """The one grid inside what a reader returns."""
    while data.IsA("vtkMultiBlockDataSet"):
        assert data.GetNumberOfBlocks() == 1, f"{data.GetNumberOfBlocks()} blocks instead of one"
        data = data.GetBlock(0)
    return data


class Series:
    """One XDMF file, read step by step by one of ParaView's readers."""

    def __init__(self, path, reader):
        simple.ResetSession()
        self.source = getattr(simple, reader)(FileName=str(path)) if reader.startswith("Xdmf3") else \
            getattr(simple, reader)(FileNames=[str(path)])
        self.source.UpdatePipelineInformation()

    def times(self):
        times = self.source.TimestepValues
        return [times] if isinstance(times, float) else list(times)

    def at(self, time):
        self.source.UpdatePipeline(time)
        # Not servermanager.Fetch: it copies rectilinear grids with coordinate arrays as long as the grid has points.
        return leaf(self.source.GetClientSideObject().GetOutputDataObject(0))


def check_values(where, name, read, expected):
    expected = np.asarray(expected)
    assert read is not None, f"{where}: {name} is missing"
    values = vtk_to_numpy(read)
    assert values.shape == expected.shape, f"{where}: {name} has shape {values.shape}, not {expected.shape}"
    assert np.array_equal(values, expected), f"{where}: {name} differs by up to {abs(values - expected).max()}"


def check_times(series, expected, where):
    times = series.times()
    assert len(times) == len(expected), f"{where}: {len(times)} time steps, not {len(expected)}"
    assert np.allclose(times, expected, rtol=1e-11, atol=0), f"{where}: times {times}, not {expected}"


def check_particles(folder, reader):
    series = Series(folder / "particles.xdmf", reader)
    with h5py.File(folder / "particles.h5") as h5:
        steps = snapshots(h5)
        check_times(series, [time for time, _ in steps], f"particles, {reader}")
        for time, group in steps:
            where = f"particles at t = {time} s, {reader}"
            data = series.at(time)
            count = len(group["position"])
            if count == 0:
                assert data.GetNumberOfPoints() <= 1, f"{where}: {data.GetNumberOfPoints()} points instead of none"
                continue
            assert data.GetNumberOfPoints() == count, f"{where}: {data.GetNumberOfPoints()} points, not {count}"
            assert data.GetNumberOfCells() >= 1, f"{where}: no cells, so that nothing would be drawn"
            check_values(where, "position", data.GetPoints().GetData(), group["position"])
            for name in group:
                if name != "position":
                    check_values(where, name, data.GetPointData().GetArray(name), group[name])
    return len(steps)


def check_gas(folder, reader, file="gas"):
    series = Series(folder / f"{file}.xdmf", reader)
    with h5py.File(folder / f"{file}.h5") as h5:
        steps = snapshots(h5)
        check_times(series, [time for time, _ in steps], f"{file}, {reader}")
        for time, group in steps:
            where = f"{file} at t = {time} s, {reader}"
            data = series.at(time)
            assert data.IsA("vtkRectilinearGrid"), f"{where}: a {data.GetClassName()}, not a rectilinear grid"
            for axis in "XYZ":
                coordinates = getattr(data, f"Get{axis}Coordinates")()
                check_values(where, f"{axis} coordinates", coordinates, h5["grid"][axis.lower()])
            for name in group:
                expected = np.asarray(group[name])
                flat = expected.reshape(-1, 3) if expected.ndim == 4 else expected.ravel()
                check_values(where, name, data.GetCellData().GetArray(name), flat)
    return len(steps)


def check_gas_average(folder, reader):
    return check_gas(folder, reader, "gas_average")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1]).resolve()
    checked = 0
    for name, check in (("particles", check_particles), ("gas", check_gas), ("gas_average", check_gas_average)):
        if not (folder / f"{name}.xdmf").exists():
            continue
        for reader in ("XDMFReader", "Xdmf3ReaderS"):
            steps = check(folder, reader)
            print(f"{name}.xdmf with {reader}: {steps} time steps agree with {name}.h5")
            checked += 1
    if checked == 0:
        sys.exit(f"{folder}: holds neither particles.xdmf nor gas.xdmf")


if __name__ == "__main__":
    try:
        main()
    except AssertionError as error:
        sys.exit(f"differs: {error}")
