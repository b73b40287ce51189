#!/usr/bin/python3
"""What may not be in the repository: paths of one machine, large files, things that are built or fetched."""

import os
import pathlib
import re
import subprocess
import sys
import unittest

TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
# Spelled with a class, so that this file does not find itself.
MACHINE_PATH = re.compile(rb"[/](work|farm|root)/|[/]home/\w|[/]tmp/[a-z]")


def tracked_files():
    run = subprocess.run(["git", "-C", str(TOP), "ls-files", "-z"], capture_output=True, check=False)
    if run.returncode != 0:
        raise unittest.SkipTest("not a git checkout")
    return [TOP / name for name in run.stdout.decode().split("\0") if name and (TOP / name).is_file()]


class TrackedFiles(unittest.TestCase):
    def test_no_path_of_a_machine(self):
        found = []
        for path in tracked_files():
            if path.suffix in (".png", ".stl", ".jpg"):
                continue
            for number, line in enumerate(path.read_bytes().split(b"\n"), 1):
                if MACHINE_PATH.search(line):
                    found.append(f"{path.relative_to(TOP)}:{number}: {line[:120]!r}")
        self.assertEqual(found, [], "\n" + "\n".join(found))

    def test_no_large_file(self):
        large = [f"{p.relative_to(TOP)}: {p.stat().st_size} bytes" for p in tracked_files() if p.stat().st_size > 2e6]
        self.assertEqual(large, [])

    def test_nothing_built_or_fetched(self):
        names = [str(p.relative_to(TOP)) for p in tracked_files()]
        self.assertEqual([n for n in names if n.startswith((".deps", "build/", "results/"))], [])


if __name__ == "__main__":
    sys.exit(unittest.main())
