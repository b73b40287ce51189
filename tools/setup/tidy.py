#!/usr/bin/python3
"""Runs clang-format and clang-tidy over the sources.

  tidy.py format [--fix]   every tracked source file against .clang-format
  tidy.py tidy             the files that changed, against .clang-tidy, with the compile commands of build/release

A file that includes Kokkos takes clang-tidy ten seconds or more, so only changed files are read: changed since
PELLICLE_TIDY_BASE, or else since the branch left origin/main, or else since the previous commit; plus what is not
committed. A changed header is read through one source file that includes it. At most --files of them are read, and
none is started after --seconds; what was left out is printed. Exit 1: something was found.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import time

TOP = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)


def git(*arguments):
    """Standard output of a git command, or None if it failed."""
    run = subprocess.run(["git", "-C", str(TOP), *arguments], capture_output=True, text=True)
    return run.stdout.strip() if run.returncode == 0 else None


def check_format(fix):
    files = [TOP / name for name in (git("ls-files", "*.cpp", "*.hpp") or "").split("\n") if name]
    files = [str(path) for path in files if path.is_file()]
    if not files:
        return 0
    how = ["-i"] if fix else ["--dry-run", "--Werror"]
    run = subprocess.run(["clang-format", *how, *files], capture_output=True, text=True, cwd=TOP)
    wrong = sorted(set(re.findall(r"^(\S+?):\d+:\d+: error", run.stderr, re.MULTILINE)))
    for path in wrong:
        print(f"format: {os.path.relpath(path, TOP)} is not formatted (tools/setup/tidy.py format --fix)")
    print(f"format: {len(files)} files, {len(wrong)} not formatted")
    return 1 if wrong or run.returncode else 0


def base_commit():
    asked = os.environ.get("PELLICLE_TIDY_BASE")
    if asked:
        if git("rev-parse", "--verify", f"{asked}^{{commit}}") is None:
            sys.exit(f"tidy: PELLICLE_TIDY_BASE is '{asked}', which is no commit here")
        return asked
    head = git("rev-parse", "HEAD")
    left = git("merge-base", "HEAD", "origin/main")
    return left if left and left != head else git("rev-parse", "--verify", "HEAD~1")


def changed_files():
    base = base_commit()
    if base is None:
        print("tidy: no earlier commit to compare with: all files count as changed")
        names = git("ls-files")
    else:
        print(f"tidy: files changed since {git('rev-parse', '--short', base)}")
        names = git("diff", "--name-only", "--diff-filter=d", base)
    untracked = git("ls-files", "--others", "--exclude-standard")
    return [TOP / n for n in f"{names}\n{untracked}".split("\n") if n.endswith((".cpp", ".hpp")) and (TOP / n).is_file()]


def reached(path, seen):
    if path not in seen and path.is_file():
        seen.add(path)
        for name in INCLUDE.findall(path.read_text()):
            reached(TOP / name, seen)
    return seen


def compile_commands(folder):
    """Source file -> compiler arguments, without the ccache launcher, which clang-tidy would take for a compiler."""
    entries = {}
    for entry in json.loads((folder / "compile_commands.json").read_text()):
        arguments = shlex.split(entry["command"])
        start = next((i for i, a in enumerate(arguments) if re.search(r"(^|/)(c\+\+|g\+\+|clang\+\+)[-\d.]*$", a)), 0)
        entries[pathlib.Path(entry["file"])] = {**entry, "command": shlex.join(arguments[start:])}
    return entries


def run_tidy(limit_files, limit_seconds, jobs):
    commands = compile_commands(TOP / "build/release")
    changed = changed_files()
    sources = [path for path in changed if path in commands]
    covered = set()
    for path in sources:
        reached(path, covered)
    for header in (path for path in changed if path.suffix == ".hpp" and path not in covered):
        user = next((s for s in sorted(commands) if s.is_file() and header in reached(s, set())), None)
        if user is not None:
            sources.append(user)
            reached(user, covered)
    if not sources:
        print("tidy: nothing to read")
        return 0
    left_out = sources[limit_files:]
    sources = sources[:limit_files]

    database = TOP / "build/tidy"
    database.mkdir(parents=True, exist_ok=True)
    (database / "compile_commands.json").write_text(json.dumps(list(commands.values())))
    end = time.monotonic() + limit_seconds

    def read(path):
        if time.monotonic() > end:
            return None
        # gcc's flags that clang does not know, and its own warnings, are none of clang-tidy's business.
        return subprocess.run(
            ["clang-tidy", "--quiet", "-p", str(database), "--extra-arg=-Wno-everything", str(path)],
            capture_output=True, text=True, cwd=TOP)

    found = 0
    unread = []
    seen = set()
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for path, run in zip(sources, pool.map(read, sources)):
            if run is None:
                left_out.append(path)
                continue
            # What clang's own front end cannot read is for the compilers to judge: clang 14 knows only part of C++20.
            if "[clang-diagnostic-error]" in run.stdout or (run.returncode != 0 and not run.stdout):
                unread.append(path)
            findings = re.findall(r"^\S+:\d+:\d+: error: .*-warnings-as-errors\]\n(?:[^/\n].*\n)*", run.stdout,
                                  re.MULTILINE)
            found += 1 if findings else 0
            for finding in findings:
                if finding not in seen:  # a header is read through several files
                    print(finding, end="")
                    seen.add(finding)
    print(f"tidy: {found} of {len(sources)} files with findings")
    if unread:
        print(f"tidy: {len(unread)} files only in part, clang does not understand them: "
              + ", ".join(str(p.relative_to(TOP)) for p in unread))
    if left_out:
        print(f"tidy: {len(left_out)} files left out (--files {limit_files}, --seconds {limit_seconds}): "
              + ", ".join(str(p.relative_to(TOP)) for p in left_out))
    return 1 if found else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("format", "tidy"))
    parser.add_argument("--fix", action="store_true", help="format: rewrite the files")
    parser.add_argument("--files", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=420)
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("PELLICLE_JOBS", os.cpu_count() or 1)))
    arguments = parser.parse_args()
    program = "clang-format" if arguments.what == "format" else "clang-tidy"
    if shutil.which(program) is None:
        sys.exit(f"{arguments.what}: there is no {program} here")
    if arguments.what == "format":
        return check_format(arguments.fix)
    return run_tidy(arguments.files, arguments.seconds, max(1, arguments.jobs))


if __name__ == "__main__":
    sys.exit(main())
