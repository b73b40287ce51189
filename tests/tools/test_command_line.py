#!/usr/bin/python3
"""The program as a user meets it: messages and exit codes, what happens to results folders, signals."""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
PROGRAM = os.environ.get("PELLICLE_PROGRAM", str(TOP / "build/release/pellicle"))

CASE = """title: two particles fall
domain: {min: [0, 0, 0], max: ["50 mm", "50 mm", "50 mm"]}
time: {end: "10 ms", particle_step: "1e-5 s"}
materials:
  glass: {density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.22}
walls:
  - {name: sides, box: domain, material: wall}
contacts:
  pairs:
    - {between: [glass, glass], restitution: 0.9, sliding_friction: 0.3}
    - {between: [glass, wall], restitution: 0.9, sliding_friction: 0.3}
particles:
  - material: glass
    diameter: "5 mm"
    fill: {box: {min: [0, 0, 0], max: ["50 mm", "50 mm", "50 mm"]}}
    count: 2
output:
  checkpoint: {every: "2 ms"}
  probes: [{name: bed, bed: {}}]
"""

# What may be wrong, the text that is to stand at its place in the case, and the message.
BAD_INPUT = [
    ("unknown key", ("title:", "titel:"),
     "1: titel: unknown key, the nearest is title; known here: title, seed, domain, gravity, time, materials, walls, "
     "contacts, particles, gas, coupling, heat, coating, spray, droplets, output"),
    ("wrong unit", ('end: "10 ms"', 'end: "10 mm"'),
     '3: time.end: "10 mm" is not a time; a number in s or a string such as "0.1 ms"'),
    ("wrong type", ('diameter: "5 mm"', "diameter: [5, 6]"),
     '14: particles.0.diameter: a list is given where a single value is expected; a number in m or a string such as '
     '"5 mm"'),
    ("negative diameter", ('diameter: "5 mm"', 'diameter: "-5 mm"'),
     '14: particles.0.diameter: "-5 mm" is out of range; a length greater than 0'),
    ("more volume than room", ("count: 2", "count: 2000"),
     "15: particles.0.fill: 2000 particles do not fit: they would take 1.05 times the region's volume; at most 60 % with "
     "pattern random"),
    ("more particles than random placing can fit", ("count: 2", "count: 1140"), r"15: particles.0.fill: .* do not fit"),
    ("step over the bound", ('particle_step: "1e-5 s"', 'particle_step: "1e-3 s"'),
     "3: time.particle_step: 0.001 s is over the bound of "),
    ("key given twice", ("    count: 2", "    count: 2\n    count: 3"),
     "17: particles.0.count: given twice, first at CASE:16; each key may be given once"),
    ("not YAML", ("materials:", "materials: ]"), "4: not valid YAML: "),
]


def run(*arguments, cwd=None, environment=None):
    base = dict(os.environ, OMP_PROC_BIND="false", OMP_NUM_THREADS="1")
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, cwd=cwd,
                          env=base if environment is None else environment, timeout=300)


def contents(folder):
    return {path.relative_to(folder): (path.stat().st_mtime_ns, path.read_bytes() if path.is_file() else None)
            for path in sorted(folder.rglob("*"))}


class CommandLine(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = pathlib.Path(self.temporary.name)
        self.case = self.folder / "two.yaml"
        self.case.write_text(CASE)
        self.results = self.folder / "out"

    def run_case(self, *more, code=0):
        result = run("run", self.case, "--output", self.results, *more)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def summary(self):
        return json.loads((self.results / "summary.json").read_text())

    def test_bad_input(self):
        """Each kind is named with its place, ends with 2, and leaves the results of an earlier run as they were."""
        self.run_case("--until", "1 ms")
        before = contents(self.results)
        for what, (old, new), expected in BAD_INPUT:
            with self.subTest(what):
                self.assertEqual(CASE.count(old), 1)
                bad = self.folder / "bad.yaml"
                bad.write_text(CASE.replace(old, new))
                for command in (["check", bad], ["run", bad, "--output", self.results, "--overwrite"],
                                ["run", bad, "--output", self.folder / "new"]):
                    result = run(*command)
                    self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                    first = result.stderr.splitlines()[0]
                    place = f"{bad}:"
                    self.assertTrue(first.startswith(place), first)
                    rest = first[len(place):]
                    wanted = expected.replace("CASE", str(bad))
                    if wanted not in rest:
                        self.assertRegex(rest, wanted)
                    self.assertIn("; ", rest)
                self.assertEqual(contents(self.results), before)
                self.assertFalse((self.folder / "new").exists())

    def test_unreadable_files(self):
        missing = self.folder / "none.yaml"
        result = run("run", missing)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr, f"{missing}: cannot be read: No such file or directory; a readable YAML file\n")
        result = run("check", self.folder)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr, f"{self.folder}: cannot be read: it is a folder; a readable YAML file\n")

    def test_overrides_are_named(self):
        result = run("check", self.case, "--set", "particles.0.diameter=-1 mm", "--set", "time.end=1 kg")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr.splitlines(), [
            '--set: time.end: "1 kg" is not a time; a number in s or a string such as "0.1 ms"',
            '--set: particles.0.diameter: "-1 mm" is out of range; a length greater than 0'])

    def test_existing_results_are_kept(self):
        self.run_case("--until", "1 ms")
        before = contents(self.results)
        result = self.run_case(code=2)
        self.assertEqual(result.stderr, f"--output: {self.results} is there already; --overwrite replaces its results, "
                                        "--resume goes on with that run, --output names another folder\n")
        self.assertEqual(contents(self.results), before)
        self.run_case("--overwrite", "--resume", code=2)
        self.assertEqual(contents(self.results), before)
        self.run_case("--overwrite")
        self.assertEqual(self.summary()["status"], "done")
        self.assertAlmostEqual(self.summary()["simulated_seconds"], 0.01)
        file = self.folder / "file"
        file.write_text("text")
        self.results = file
        self.run_case(code=2)
        self.assertEqual(file.read_text(), "text")
        self.results = self.folder / "nowhere"
        self.run_case("--resume", code=2)
        self.assertFalse(self.results.exists())

    def test_until_and_resume(self):
        self.run_case("--until", "4 ms")
        self.assertAlmostEqual(self.summary()["simulated_seconds"], 0.004)
        self.assertTrue((self.results / "checkpoint.h5").is_file())
        self.run_case("--resume")
        self.assertAlmostEqual(self.summary()["simulated_seconds"], 0.01)
        for bad in ("5 kg", "-1", "soon"):
            result = self.run_case("--until", bad, "--overwrite", code=2)
            self.assertTrue(result.stderr.startswith("--until: "), result.stderr)

    def test_resolved_case_is_the_same_case(self):
        self.run_case()
        first = (self.results / "case.yaml").read_text()
        result = run("run", self.results / "case.yaml", "--output", self.folder / "again")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((self.folder / "again/case.yaml").read_text(), first)
        self.assertEqual((self.folder / "again/probes/bed.csv").read_bytes(), (self.results / "probes/bed.csv").read_bytes())

    def test_default_output_is_named_after_the_case(self):
        folder = self.folder / "cases/bounce"
        folder.mkdir(parents=True)
        (folder / "case.yaml").write_text(CASE)
        self.assertEqual(run("run", "cases/bounce/case.yaml", "--until", "1 ms", cwd=self.folder).returncode, 0)
        self.assertTrue((self.folder / "results/bounce/summary.json").is_file())
        self.assertEqual(run("run", "two.yaml", "--until", "1 ms", cwd=self.folder).returncode, 0)
        self.assertTrue((self.folder / "results/two/summary.json").is_file())

    def test_interrupted(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                process = subprocess.Popen(
                    [PROGRAM, "run", str(self.case), "--output", str(self.results), "--overwrite", "--set", "time.end=1e6"],
                    env=dict(os.environ, OMP_PROC_BIND="false", OMP_NUM_THREADS="1"), stdout=subprocess.DEVNULL)
                deadline = time.monotonic() + 60
                checkpoint = self.results / "checkpoint.h5"
                while not checkpoint.is_file() and time.monotonic() < deadline:
                    time.sleep(0.02)
                process.send_signal(number)
                self.assertEqual(process.wait(60), 130)
                self.assertEqual(self.summary()["status"], "stopped")
                checkpoint.unlink()

    def test_failure_while_running(self):
        """Two particles far into each other: the run stops with 3 and says which."""
        self.case.write_text(re.sub(r"  - material.*?count: 2\n", """  - {material: glass, diameter: "5 mm", list: [
      {position: [0.02, 0.02, 0.02]}, {position: [0.02, 0.02, 0.021]}]}
""", CASE, flags=re.DOTALL))
        result = self.run_case(code=3)
        self.assertIn("overlap", result.stderr)
        self.assertEqual(self.summary()["status"], "failed")

    def test_threads(self):
        self.run_case("--until", "1 ms", "--threads", "1")
        self.assertEqual(self.summary()["threads"], 1)
        # Unless told, the program binds its threads by starting itself anew, once.
        bare = {name: value for name, value in os.environ.items() if not name.startswith("OMP_")}
        result = run("run", self.case, "--output", self.results, "--overwrite", "--until", "1 ms", environment=bare)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("OMP_PROC_BIND", result.stdout + result.stderr)
        self.assertEqual(run("run", self.case, "--threads", "0").returncode, 2)

    @unittest.skipIf(len(os.sched_getaffinity(0)) < 2, "needs two processors")
    def test_few_threads_are_not_bound(self):
        """Several runs of one thread each share the processors: none of them is bound to the first one."""
        bare = {name: value for name, value in os.environ.items() if not name.startswith("OMP_")}
        process = subprocess.Popen(
            [PROGRAM, "run", str(self.case), "--output", str(self.results), "--threads", "1", "--set", "time.end=1e6"],
            env=bare, stdout=subprocess.DEVNULL)
        try:
            deadline = time.monotonic() + 60
            while not (self.results / "checkpoint.h5").is_file() and time.monotonic() < deadline:
                time.sleep(0.02)
            self.assertEqual(os.sched_getaffinity(process.pid), os.sched_getaffinity(0))
        finally:
            process.kill()
            process.wait(60)

    def test_warnings_reach_the_log(self):
        self.run_case("--until", "1 ms", "--set", "coupling.drag=rong")
        self.assertIn("--set: coupling: of no use: the case has no gas", (self.results / "run.log").read_text())

    def test_accounts_of_a_run(self):
        self.run_case("--until", "1 ms")
        report = run("report", self.results)
        self.assertEqual(report.returncode, 0)
        self.assertIn("two particles fall", report.stdout)
        info = run("info", self.results)
        self.assertEqual(info.returncode, 0)
        self.assertRegex(info.stdout, r"(?m)^  checkpoint.h5 +\d")
        info = run("info", self.results / "checkpoint.h5")
        self.assertEqual(info.returncode, 0)
        self.assertIn("t = 0.001 s", info.stdout)
        self.assertRegex(info.stdout, r"(?m)^  dem/mass +2$")
        for command in ("report", "info"):
            self.assertEqual(run(command, self.folder / "nowhere").returncode, 2)
        self.assertEqual(run("info", self.case).returncode, 2)

    def test_help_and_version(self):
        for arguments in (["--help"], ["run", "--help"], ["--version"]):
            result = run(*arguments)
            self.assertEqual(result.returncode, 0)
            self.assertEqual(result.stderr, "")
        self.assertRegex(run("--version").stdout, r"^pellicle \d+\.\d+\.\d+")
        self.assertIn("Examples:", run("--help").stdout)
        for arguments in ([], ["fly"], ["run"], ["run", self.case, "--fast"], ["models", "nothing"]):
            self.assertEqual(run(*arguments).returncode, 2, arguments)


if __name__ == "__main__":
    sys.exit(unittest.main())
