#!/usr/bin/python3
"""Walls through the program: a bad mesh, a wall with wrong keys or a particle inside a wall is named and ends with 2.

Each is found in bounded time and memory, and leaves an existing results folder as it was.
"""
import os
import resource
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = os.environ.get("PELLICLE_PROGRAM")

CASE = """title: an insert in a box
domain: {min: [0, 0, 0], max: ["40 mm", "40 mm", "40 mm"]}
time: {end: "1 ms", particle_step: "1e-5 s"}
materials:
  glass: {density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.22}
contacts:
  pairs:
    - {between: [glass, glass], restitution: 0.9, sliding_friction: 0.3}
    - {between: [glass, wall], restitution: 0.9, sliding_friction: 0.3}
particles:
  - {material: glass, count: 40, diameter: "4 mm", fill: {box: {min: [0, 0, 0], max: ["40 mm", "40 mm", "40 mm"]}}}
  - {material: glass, diameter: "4 mm", list: [{position: ["5 mm", "5 mm", "35 mm"]}]}
walls:
  - {name: sides, box: domain, material: wall}
  - {name: insert, stl: insert.stl, unit: mm, material: wall}
output:
  probes: [{name: bed, bed: {}}]
"""
WALL = "  - {name: insert, stl: insert.stl, unit: mm, material: wall}\n"
LISTED = '{position: ["5 mm", "5 mm", "35 mm"]}'


def box(low, high):
    """The twelve triangles of a box, normals outwards."""
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for upper in (False, True):
            def corner(far_u, far_v):
                x = [0.0] * 3
                x[axis] = (high if upper else low)[axis]
                x[u] = (high if far_u else low)[u]
                x[v] = (high if far_v else low)[v]
                return tuple(x)
            a, b, c, d = corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)
            yield from [(a, b, c), (a, c, d)] if upper else [(a, c, b), (a, d, c)]


def binary(triangles, header=b"made up", count=None):
    triangles = list(triangles)
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles)
    return header.ljust(80) + struct.pack("<I", len(triangles) if count is None else count) + body


def ascii_text(triangles):
    text = "solid insert\n"
    for triangle in triangles:
        text += " facet normal 0 0 0\n  outer loop\n"
        text += "".join("   vertex {} {} {}\n".format(*corner) for corner in triangle)
        text += "  endloop\n endfacet\n"
    return text + "endsolid insert\n"


INSERT = list(box((15, 15, 10), (25, 25, 30)))
METRES = [tuple(tuple(0.001 * x for x in corner) for corner in t) for t in INSERT]
NAN = float("nan")


def contents(folder):
    return {path.relative_to(folder): (path.stat().st_mtime_ns, path.read_bytes() if path.is_file() else None)
            for path in sorted(folder.rglob("*"))}


@unittest.skipUnless(PROGRAM, "PELLICLE_PROGRAM is not set")
class WallInput(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name)
        self.case = self.folder / "case.yaml"
        self.mesh = self.folder / "insert.stl"
        self.results = self.folder / "out"

    def run_program(self, *arguments):
        environment = dict(os.environ, OMP_PROC_BIND="false", OMP_NUM_THREADS="1")
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False,
                              env=environment, timeout=300)

    def run_well(self, text=CASE, mesh=None):
        self.case.write_text(text, encoding="utf-8")
        self.mesh.write_bytes(binary(INSERT) if mesh is None else mesh)
        result = self.run_program("run", self.case, "--output", self.results, "--overwrite")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout + result.stderr

    def refuse(self, what, *messages, text=CASE, mesh=None, size=None):
        """Both check and run refuse the case, each message in a line of its own, in order."""
        self.run_well()
        before = contents(self.results)
        self.case.write_text(text, encoding="utf-8")
        if mesh is not None:
            self.mesh.write_bytes(mesh)
        if size is not None:
            os.truncate(self.mesh, size)
        for command in (["check", self.case], ["run", self.case, "--output", self.results, "--overwrite"],
                        ["run", self.case, "--output", self.folder / "new"]):
            with self.subTest(what, command=command[0]):
                result = self.run_program(*command)
                self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                lines = [line for line in result.stderr.splitlines() if line.startswith(f"{self.case}:")]
                self.assertEqual(len(lines), len(messages), result.stderr)
                for line, message in zip(lines, messages):
                    self.assertIn(message, line)
                    self.assertIn("; ", line)
                self.assertEqual(contents(self.results), before)
                self.assertFalse((self.folder / "new").exists())

    def test_meshes_that_run(self):
        for mesh in (binary(INSERT), binary(INSERT, b"solid, it says"), ascii_text(INSERT).encode()):
            self.assertIn("wall insert: 12 triangles, 8 corners, 0.01 x 0.01 x 0.02 m, watertight", self.run_well(mesh=mesh))
        self.run_well(CASE.replace("unit: mm, ", ""), binary(METRES))

    def test_results_can_be_moved_with_the_case(self):
        """The resolved case finds the mesh from the results folder; a run goes on in another place."""
        self.run_well()
        resolved = (self.results / "case.yaml").read_text(encoding="utf-8")
        self.assertIn('stl: "../insert.stl"', resolved)
        self.assertNotIn(str(self.folder), resolved)
        moved = self.folder / "moved" / "deep"
        moved.mkdir(parents=True)
        for name in ("case.yaml", "insert.stl", "out"):
            (self.folder / name).rename(moved / name)
        self.run_program("check", moved / "out" / "case.yaml")
        resumed = self.run_program("run", moved / "case.yaml", "--output", moved / "out", "--resume", "--set", "time.end=2 ms")
        self.assertEqual(resumed.returncode, 0, resumed.stdout + resumed.stderr)
        again = self.run_program("run", moved / "out" / "case.yaml", "--output", moved / "again")
        self.assertEqual(again.returncode, 0, again.stdout + again.stderr)

    def test_what_is_doubtful_is_said(self):
        log = self.run_well(mesh=binary(INSERT[:-1] + [((15, 15, 10), (20, 20, 20), (25, 25, 30))]))
        self.assertIn("not watertight (3 open edges)", log)
        self.assertIn("1 triangles without area (dropped)", log)

    def test_bad_meshes(self):
        place = f":15: walls.insert.stl: {self.mesh}: "
        good = binary(INSERT)
        nan = [INSERT[0], ((NAN, 0, 0), *INSERT[1][1:]), *INSERT[2:]]
        self.refuse("not an STL", place + 'it is no STL file: it neither begins with "solid" nor has the size of a '
                    "binary one; an STL file", mesh=b"ply\nformat ascii 1.0\n")
        self.refuse("empty", place + "the file is empty", mesh=b"")
        self.refuse("truncated", place + "it is no STL file, or not all of one: its header announces 12 triangles, which "
                    "take 684 bytes, but it has 600", mesh=good[:600])
        self.refuse("truncated text", place + "line 52: the file ends within a facet, it is truncated", mesh=ascii_text(INSERT).encode()[:810])
        self.refuse("NaN", place + "triangle 2 has a corner at (nan, 0, 0); finite coordinates", mesh=binary(nan))
        self.refuse("NaN in text", place + "line 11 has a corner at (nan, 0, 0); finite", mesh=ascii_text(nan).encode())
        self.refuse("no area", place + "none of its triangles has an area", mesh=binary([((1, 1, 1), (2, 2, 2), (3, 3, 3))] * 4))
        self.refuse("nothing there", ":15: walls.insert.stl: " + str(self.folder / "no.stl") + ": it cannot be read; a file "
                    "that is there", text=CASE.replace("insert.stl", "no.stl"))
        self.refuse("a folder", ":15: walls.insert.stl: " + str(self.folder) + "/: it cannot be read; a file that is there",
                    text=CASE.replace("insert.stl", "."))

    def test_ten_million_triangles(self):
        """Refused by the header alone, be the triangles there or not: no time, no memory."""
        place = f":15: walls.insert.stl: {self.mesh}: it has 10000000 triangles; at most 5000000"
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
        start = time.monotonic()
        self.refuse("header", place, mesh=binary(INSERT, count=10_000_000))
        # A file with a hole where the triangles would be: it takes no space on the disk.
        self.refuse("all of them", place, mesh=binary(INSERT, count=10_000_000), size=84 + 50 * 10_000_000)
        self.assertLess(time.monotonic() - start, 60)
        # kB; all triangles would take 500 MB.
        self.assertLess(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, max(before, 200_000) + 100_000)

    def test_wrong_unit(self):
        domain = "the domain from [0, 0, 0] to [0.04, 0.04, 0.04] m, or another unit"
        self.refuse("mm read as m", "with unit m it reaches from [15, 15, 10] to [25, 25, 30] m, which is apart from the "
                    "domain; coordinates that fit " + domain, text=CASE.replace("unit: mm, ", ""))
        around = list(box((-500, -500, -500), (500, 500, 500)))
        self.refuse("mm read as m, around the domain", "which is far larger than the domain; coordinates that fit " + domain,
                    text=CASE.replace("unit: mm, ", ""), mesh=binary(around))
        self.refuse("m read as mm", "which is smaller than a particle of 0.004 m; coordinates that fit " + domain,
                    mesh=binary(METRES))

    def test_wrong_keys_of_walls(self):
        tube = '  - {name: tube, cylinder: {from: [0, 0, 0], to: [0, 0, 1], radius: "19 mm"}, material: wall%s}\n'
        for keys, message in (
                (', spin: {rate: "60 rpm", axis: [0, 0, 1]}', "walls.tube.spin.through: missing"),
                (', spin: {rate: "60 mm", axis: [0, 0, 1], through: [0, 0, 0]}',
                 'walls.tube.spin.rate: "60 mm" is not an angular velocity'),
                (", spin: {rate: 1, axis: [0, 0, 0], through: [0, 0, 0]}", "walls.tube.spin.axis: it has no length"),
                (", vibration: {amplitude: [0, 0, 1e-3], frequency: 0}", "walls.tube.vibration.frequency: "),
                (', vibration: {amplitude: [0, 0, 1e-3], frequency: "50 Hz", fase: 1}',
                 "walls.tube.vibration.fase: unknown key, the nearest is phase"),
                (', velocity: "1 m/s"', "walls.tube.velocity: "),
                (", rotation: {rate: 1}", "walls.tube.rotation: unknown key"),
                (", unit: mm", "walls.tube.unit: there is no file that it says something of; only with stl")):
            self.refuse(keys, ":15: " + message, text=CASE.replace(WALL, tube % keys))

    def test_particle_inside_a_wall_is_named(self):
        for shape, position, radius, depth in (
                ('cylinder: {from: [0.02, 0.02, 0], to: [0.02, 0.02, 0.04], radius: "19 mm"}', "[0.038, 0.02, 0.02]", 2, 1),
                ('cylinder: {from: [0.02, 0.02, 0], to: [0.02, 0.02, 0.04], radius: "9 mm"}', "[0.03, 0.02, 0.02]", 2, 1),
                ('cone: {from: [0.02, 0.02, 0], to: [0.02, 0.02, 0.02], from_radius: 0, to_radius: 0.02}',
                 "[0.03, 0.02, 0.01]", 2, 2),
                ('block: {min: [0, 0, 0], max: [0.04, 0.04, 0.01]}', "[0.02, 0.02, 0.007]", 2, 5),
                ('disc: {centre: [0.02, 0.02, 0.01], normal: [0, 0, 1], radius: 0.01}', "[0.02, 0.02, 0.0115]", 2, 0.5),
                ('stl: insert.stl, unit: mm', "[0.02, 0.02, 0.0315]", 2, 0.5)):
            text = CASE.replace(WALL, "  - {name: thing, %s, material: wall}\n" % shape)
            text = text.replace(LISTED, LISTED + ", {position: %s}" % position)
            self.refuse(shape, f":12: particles.1.list.1.position: particle 1 of radius {radius / 1000:g} m at {position} m starts "
                        f"{depth / 1000:g} m inside the wall thing; a place at least its radius away from every wall",
                        text=text)
        # Fixed ones may stand where they like.
        self.run_well(CASE.replace(LISTED, '{position: ["20 mm", "20 mm", "12 mm"], fixed: true}'))

    def test_fills_keep_clear_of_walls_or_are_refused(self):
        self.run_well(CASE.replace("count: 40", "count: 400"))
        self.refuse("no room", ":11: particles.0.fill: 900 particles do not fit",
                    text=CASE.replace("count: 40", "count: 900").replace(WALL, WALL + '  - {name: step, block: {min: [0, 0, '
                                                                         '0], max: [0.04, 0.04, "8 mm"]}, material: wall}\n'))


if __name__ == "__main__":
    sys.exit(unittest.main())
