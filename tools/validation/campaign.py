"""What the validation scripts share: runs that are made once, and tables and plots made from them."""

import argparse
import contextlib
import dataclasses
import io
import json
import pathlib
import subprocess
import sys

import tabulate

TOP = pathlib.Path(__file__).resolve().parents[2]


@dataclasses.dataclass
class Run:
    """One run of a campaign: its label in tables, its folder under the results, and how it differs from the case."""

    label: str
    folder: str
    case: str
    end: float  # simulated time [s]
    settings: tuple = ()
    early: bool = False  # ends before the case does

    def command(self, results, threads):
        words = [str(TOP / "pellicle"), "run", str(TOP / self.case), "--output", str(results / self.folder)]
        for setting in self.settings:
            words += ["--set", setting]
        if self.early:
            words += ["--until", f"{self.end:g}"]
        if threads:
            words += ["--threads", str(threads)]
        return words


def options(description):
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=pathlib.Path, default=TOP / "results", help="where the runs are kept")
    parser.add_argument("--output", type=pathlib.Path, default=TOP / "docs" / "validation",
                        help="where tables and plots go (default: docs/validation)")
    parser.add_argument("--threads", type=int, help="of each run (default: all processors)")
    parser.add_argument("--list", action="store_true", help="print the commands and do nothing")
    parser.add_argument("--evaluate", action="store_true", help="run nothing; tables and plots of what is there")
    return parser.parse_args()


def finished(folder, end):
    """Whether a run got as far as it was to go [s]; one that ends before its case does counts as stopped."""
    summary = folder / "summary.json"
    if not summary.exists():
        return False
    state = json.loads(summary.read_text(encoding="utf-8"))
    return state["status"] in ("done", "stopped") and state["simulated_seconds"] > end * (1 - 1e-9)


def perform(runs, args):
    """Makes the runs that are missing, one after the other; one that was cut off goes on from its checkpoint."""
    for run in runs:
        folder = args.results / run.folder
        command = run.command(args.results, args.threads)
        if args.list:
            print(" ".join(command))
            continue
        if finished(folder, run.end):
            print(f"{run.label}: done before, in {folder}", file=sys.stderr)
            continue
        if (folder / "checkpoint.h5").exists():
            command.append("--resume")
        elif folder.exists():
            command.append("--overwrite")
        print(f"{run.label}: {' '.join(command)}", file=sys.stderr)
        code = subprocess.run(command, check=False).returncode
        if code != 0:
            sys.exit(f"{run.label}: ended with code {code}; see {folder / 'run.log'}")


def named(runs, args):
    return [f"{run.label}={args.results / run.folder}" for run in runs]


def write_table(path, words):
    """One table as PATH.md and PATH.csv."""
    path.parent.mkdir(parents=True, exist_ok=True)
    for ending, extra in ((".md", []), (".csv", ["--csv"])):
        text = io.StringIO()
        with contextlib.redirect_stdout(text):
            code = tabulate.main([*words, *extra])
        if code != 0:
            sys.exit(code)
        path.with_suffix(ending).write_text(text.getvalue(), encoding="utf-8")
    print(f"wrote {path}.md and .csv", file=sys.stderr)


def plot(script, runs, args, *words, output, label=True):
    """Runs a script of tools/plot on the results of the runs."""
    output.parent.mkdir(parents=True, exist_ok=True)
    command = [str(TOP / "tools" / "plot" / script)]
    for run in runs:
        command.append(str(args.results / run.folder))
    if label:
        for run in runs:
            command += ["--label", run.label]
    subprocess.run([*command, *map(str, words), "-o", str(output)], check=True)


def as_options(option, values):
    """--option VALUE for each value."""
    return [word for value in values for word in (option, str(value))]
