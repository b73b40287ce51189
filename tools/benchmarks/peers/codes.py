"""How each code is run on a bed, and what is read from what it prints."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import beds
import check

PEERS = pathlib.Path(__file__).resolve().parent


def stop(text):
    print(f"dem_vs_peers: {text}", file=sys.stderr)
    sys.exit(1)


def processors(count):
    """The first processors this process may use."""
    allowed = sorted(os.sched_getaffinity(0))
    if len(allowed) < count:
        stop(f"--cores {count}: only {len(allowed)} here")
    return ",".join(str(c) for c in allowed[:count])


def pinned(cores):
    """What goes before a command of this project, and its environment, to run on some cores."""
    environment = {**os.environ, "OMP_NUM_THREADS": str(cores)}
    if cores == 1:
        environment["OMP_PROC_BIND"] = "false"
    else:
        environment.update(OMP_PROC_BIND="spread", OMP_PLACES="threads")
    return ["taskset", "-c", processors(cores)], environment


def run_checked(command, environment, folder):
    run = subprocess.run([str(c) for c in command], env=environment, cwd=folder, capture_output=True, text=True,
                         check=False)
    if run.returncode != 0:
        output = run.stdout[-2000:] + run.stderr[-2000:]
        stop(f"failed: {' '.join(str(c) for c in command)}\n{output}")
    return run.stdout


def run_pellicle(job, folder, args):
    prefix, environment = pinned(job["cores"])
    command = [*prefix, args.dem_bed, "--bed", job["bed"], "--size", *beds.SIZE,
               "--tangential", "mindlin" if job["history"] else "viscous_coulomb", "--gravity", job["gravity"],
               "--time-step", args.time_step, "--warm-up", job["warm"], "--steps", job["steps"]]
    if job.get("dump"):
        # Compared with the others, the law of the damping must be theirs: theirs may pull as a contact ends.
        command += ["--output", folder / "end.txt", "--attraction"]
    return json.loads(run_checked(command, environment, folder).strip().splitlines()[-1])


def run_peer(job, folder, args):
    data = folder / "bed.data"
    beds.write_data_file(job["bed"], data)
    if job["code"] == "liggghts":
        command = ["liggghts", "-in", PEERS / "liggghts.in"]
    else:
        command = ["lmp", "-in", PEERS / "lammps.in"]
    law = "lean" if job["code"] == "lammps_lean" else ("history" if job["history"] else "no_history")
    values = {"data": data, "law": law, "skin": job["skin"], "gravity": job["gravity"],
              "time_step": args.time_step, "warm": job["warm"], "steps": job["steps"], "clock": PEERS / "cpu_clock",
              "out": folder, "dump": int(bool(job.get("dump"))), "size_x": beds.SIZE[0], "size_y": beds.SIZE[1],
              "size_z": beds.SIZE[2]}
    command += ["-log", folder / "log", "-screen", "none"]
    for name, value in values.items():
        command += ["-var", name, value]
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    if job["cores"] > 1:
        environment.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        command = ["mpirun", "-np", job["cores"], "--bind-to", args.mpi_binding, *command]
    run_checked(["taskset", "-c", processors(job["cores"]), *command], environment, folder)
    return read_peer_log(folder, job["steps"])


def read_peer_log(folder, steps):
    """What the logs of LIGGGHTS and LAMMPS say; of their four loops the third is the timed one."""
    loops, contacts, found = [], [], {}
    header = []
    for line in (folder / "log").read_text().splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "Step":
            header = words
        elif words[0].isdigit() and len(words) == len(header) and header[-1].endswith("contacts"):
            contacts.append(float(words[-1]))
        elif line.startswith("Loop time"):
            header = []
            loops.append((float(words[3]), int(words[8])))
            particles = int(words[11])
        elif line.startswith("Neighbor list builds"):
            found[len(loops), "builds"] = int(words[-1])
        elif line.startswith("Ave neighs/atom"):
            found[len(loops), "neighbours"] = float(words[-1])
        elif line.startswith("ERROR"):
            stop(line)
    wall, done = loops[2]
    if done != steps or len(contacts) != 2:
        stop(f"cannot make sense of {folder / 'log'}")
    clock = dict(line.split() for line in (folder / "cpu").read_text().splitlines())
    return {"particles": particles, "steps": steps, "wall_seconds": wall,
            "cpu_seconds": float(clock["b"]) - float(clock["a"]), "contacts_per_particle_start": contacts[0],
            "contacts_per_particle_end": contacts[1], "list_builds": found[3, "builds"],
            # Their lists hold each pair once.
            "neighbours_per_particle": 2 * found[3, "neighbours"]}


def run_job(job, args):
    with tempfile.TemporaryDirectory(prefix="dem_vs_peers_") as name:
        folder = pathlib.Path(name)
        result = (run_pellicle if job["code"] == "pellicle" else run_peer)(job, folder, args)
        if job.get("dump"):
            result["start"], result["end"] = check.read_states(job["code"], folder)
    work = result["particles"] * result["steps"] / 1e6
    # Of a peer on several ranks, the CPU seconds are the first rank's; of this project's threads, all of them.
    cpu = result["cpu_seconds"] / (job["cores"] if job["code"] == "pellicle" else 1)
    result["rate"] = work / result["wall_seconds"] / job["cores"] if result["wall_seconds"] else 0
    result["cpu_rate"] = work / cpu / job["cores"] if cpu else 0
    result["load"] = cpu / result["wall_seconds"] if result["wall_seconds"] else 1
    return result
