"""Pages whose tables are written by the tests themselves (tests/verification/dem/verification_table.hpp)."""

import csv
import dataclasses
import os
import pathlib
import shutil
import subprocess
import sys
import time

from campaign import TOP

FIELDS = ["line", "expected", "got", "tolerance", "holds", "why", "test"]


@dataclasses.dataclass
class Page:
    """A page, and the groups of cases that fill it: name: (executable, filter of its cases)."""

    path: pathlib.Path
    groups: dict

    def perform(self, results, listed):
        """Runs the groups that left no folder yet, one after the other on one thread; or only prints how."""
        build = TOP / "build" / "release"
        programs = sorted({program for program, _ in self.groups.values()})
        if not listed:
            subprocess.run([TOP / "pellicle", "build", "--target", *programs], check=True)
        for name, (program, filters) in self.groups.items():
            folder = results / name
            command = [str(build / program), f"--gtest_filter={filters}"]
            if listed:
                print(f"OMP_NUM_THREADS=1 PELLICLE_VERIFICATION={folder} {' '.join(command)}")
                continue
            if (folder / "seconds.txt").exists():
                print(f"{name}: done before, in {folder}", file=sys.stderr)
                continue
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            print(f"{name}: {' '.join(command)}", file=sys.stderr)
            environment = dict(os.environ, OMP_NUM_THREADS="1", PELLICLE_VERIFICATION=str(folder))
            started = time.monotonic()
            with open(folder / "log.txt", "w", encoding="utf-8") as log:
                code = subprocess.run(command, stdout=log, stderr=log, env=environment, check=False).returncode
            if code not in (0, 1):  # 1: a line does not hold, which the table says
                sys.exit(f"{name}: ended with code {code}; see {folder}/log.txt")
            (folder / "seconds.txt").write_text(f"{time.monotonic() - started:.1f}\n", encoding="utf-8")

    def evaluate(self, results, out, after_table=lambda name, folder: ""):
        """Fills the page from what was run, and writes all lines to table.csv; after_table gives what comes below a
        group's table."""
        out.mkdir(parents=True, exist_ok=True)
        everything, seconds = [], []
        for name in self.groups:
            folder = results / name
            if not (folder / "seconds.txt").exists():
                print(f"{name}: not there", file=sys.stderr)
                continue
            lines = read_lines(folder / "table.csv")
            everything += lines
            self.fill(name, markdown(lines) + after_table(name, folder))
            seconds.append(f"{name} {float((folder / 'seconds.txt').read_text(encoding='utf-8')):.0f} s")
            for curve in sorted(folder.glob("*.csv")):
                if curve.name != "table.csv":
                    shutil.copy(curve, out / curve.name.replace(" ", "_"))
        with open(out / "table.csv", "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, FIELDS)
            writer.writeheader()
            writer.writerows(everything)
        held = sum(line["holds"] == "yes" and line["tolerance"] != "recorded" for line in everything)
        recorded = sum(line["tolerance"] == "recorded" for line in everything)
        self.fill("count", f"{len(everything)} lines: {held} hold, {len(everything) - held - recorded} do not, "
                           f"{recorded} are for the record. Seconds of each group on one thread of a busy machine: "
                           f"{', '.join(seconds)}.\n")

    def fill(self, name, text):
        """Replaces what stands between <!-- NAME --> and <!-- end --> in the page."""
        page = self.path.read_text(encoding="utf-8")
        begin = page.index(f"<!-- {name} -->\n") + len(f"<!-- {name} -->\n")
        end = page.index("<!-- end -->", begin)
        self.path.write_text(page[:begin] + text + page[end:], encoding="utf-8")


def read_lines(path):
    with open(path, encoding="utf-8", newline="") as file:
        return [dict(zip(FIELDS, row)) for row in csv.reader(file)]


def markdown(lines):
    text = "| line | expected | got | tolerance | holds | why |\n|---|---|---|---|---|---|\n"
    for line in lines:
        text += "| " + " | ".join(line[field] for field in FIELDS[:-1]) + " |\n"
    return text
