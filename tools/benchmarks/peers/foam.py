"""The duct with a jet as a case of OpenFOAM's pimpleFoam: files, runs, what the log and the fields say."""

import os
import re
import shutil
import struct
import subprocess
import time

# Where Debian keeps what the tools look for through the environment.
ENVIRONMENT = {"WM_PROJECT_DIR": "/usr/share/openfoam", "FOAM_ETC": "/usr/share/openfoam/etc",
               "WM_PROJECT": "OpenFOAM", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def header(kind, name):
    return f"FoamFile\n{{ version 2.0; format ascii; class {kind}; object {name}; }}\n"


def block_mesh(duct):
    """Nine columns of blocks, so that the inlet has a patch of its own."""
    (x, nx), (y, ny) = ([0, duct.inlet[0], duct.inlet[1], duct.width], duct.cells[0]), \
                       ([0, duct.inlet[0], duct.inlet[1], duct.width], duct.cells[1])

    def counts(faces, cells):
        return [round((b - a) / duct.width * cells) for a, b in zip(faces, faces[1:])]

    cx, cy = counts(x, nx), counts(y, ny)
    corner = lambda i, j, k: i + 4 * (j + 4 * k)
    lines = [header("dictionary", "blockMeshDict"), "scale 1;\nvertices ("]
    for k in (0, 1):
        lines += [f"({x[i]:.17g} {y[j]:.17g} {k * duct.height:.17g})" for j in range(4) for i in range(4)]
    lines.append(");\nblocks (")
    jet, rest, top = [], [], []
    for j in range(3):
        for i in range(3):
            low = [corner(i, j, 0), corner(i + 1, j, 0), corner(i + 1, j + 1, 0), corner(i, j + 1, 0)]
            high = [c + 16 for c in low]
            lines.append(f"hex ({' '.join(map(str, low + high))}) ({cx[i]} {cy[j]} {duct.cells[2]}) simpleGrading (1 1 1)")
            (jet if i == 1 and j == 1 else rest).append(low[::-1])
            top.append(high)
    lines.append(");\nedges ();\nboundary (")
    sides = [[corner(a, 0, 0), corner(a + 1, 0, 0), corner(a + 1, 0, 1), corner(a, 0, 1)] for a in range(3)]
    sides += [[corner(a + 1, 3, 0), corner(a, 3, 0), corner(a, 3, 1), corner(a + 1, 3, 1)] for a in range(3)]
    sides += [[corner(0, a + 1, 0), corner(0, a, 0), corner(0, a, 1), corner(0, a + 1, 1)] for a in range(3)]
    sides += [[corner(3, a, 0), corner(3, a + 1, 0), corner(3, a + 1, 1), corner(3, a, 1)] for a in range(3)]
    for name, kind, faces in (("jet", "patch", jet), ("top", "patch", top), ("walls", "wall", rest + sides)):
        text = " ".join("(" + " ".join(map(str, face)) + ")" for face in faces)
        lines.append(f"{name} {{ type {kind}; faces ({text}); }}")
    return "\n".join(lines) + "\n);\n"


def write_case(folder, duct, steps, cores, tolerance):
    shutil.rmtree(folder, ignore_errors=True)
    for part in ("0", "constant", "system"):
        (folder / part).mkdir(parents=True)
    end = steps * duct.step
    files = {
        "system/blockMeshDict": block_mesh(duct),
        "system/controlDict": header("dictionary", "controlDict") + f"""
application pimpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {end:.12g}; deltaT {duct.step:.12g};
writeControl timeStep; writeInterval {steps}; writeFormat binary; writePrecision 12; timePrecision 9;
runTimeModifiable no;
""",
        "system/fvSchemes": header("dictionary", "fvSchemes") + """
ddtSchemes { default Euler; }
gradSchemes { default Gauss linear; }
divSchemes { default none; div(phi,U) Gauss linear; div((nuEff*dev2(T(grad(U))))) Gauss linear; }
laplacianSchemes { default Gauss linear orthogonal; }
interpolationSchemes { default linear; }
snGradSchemes { default orthogonal; }
""",
        # Two pressure solves a step, as this project's two outer iterations have; the first one loose, as there.
        "system/fvSolution": header("dictionary", "fvSolution") + f"""
solvers {{
 p {{ solver GAMG; smoother GaussSeidel; tolerance 0; relTol 0.01; }}
 pFinal {{ solver GAMG; smoother GaussSeidel; tolerance {tolerance:g}; relTol 0; }}
 "U|UFinal" {{ solver smoothSolver; smoother symGaussSeidel; tolerance 1e-9; relTol 0; }}
}}
PIMPLE {{ nOuterCorrectors 1; nCorrectors 2; nNonOrthogonalCorrectors 0; momentumPredictor yes; }}
""",
        "system/decomposeParDict": header("dictionary", "decomposeParDict") + f"""
numberOfSubdomains {cores}; method simple; simpleCoeffs {{ n (1 1 {cores}); delta 0.001; }}
""",
        "constant/transportProperties": header("dictionary", "transportProperties") +
                                        f"transportModel Newtonian; nu {duct.viscosity / duct.density:.12g};\n",
        "constant/turbulenceProperties": header("dictionary", "turbulenceProperties") + "simulationType laminar;\n",
        "0/U": header("volVectorField", "U") + f"""
dimensions [0 1 -1 0 0 0 0]; internalField uniform (0 0 0);
boundaryField {{ walls {{ type noSlip; }} jet {{ type fixedValue; value uniform (0 0 {duct.velocity:g}); }}
 top {{ type pressureInletOutletVelocity; value uniform (0 0 0); }} }}
""",
        "0/p": header("volScalarField", "p") + """
dimensions [0 2 -2 0 0 0 0]; internalField uniform 0;
boundaryField { "walls|jet" { type zeroGradient; } top { type fixedValue; value uniform 0; } }
""",
    }
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")


def call(folder, *words, **more):
    run = subprocess.run(words, cwd=folder, env={**os.environ, **ENVIRONMENT}, capture_output=True, text=True,
                         check=False, **more)
    if run.returncode != 0:
        raise RuntimeError(f"{' '.join(words)} in {folder}:\n{run.stdout[-2000:]}{run.stderr[-2000:]}")
    return run.stdout


def run_case(folder, duct, steps, warm, cores, tolerance, pinned):
    """Seconds a step by the wall clock and of all processors together, after `warm` steps; memory; divergence."""
    write_case(folder, duct, steps, cores, tolerance)
    call(folder, "blockMesh")
    command = ["pimpleFoam"]
    if cores > 1:
        call(folder, "decomposePar")
        command = ["mpirun", "--bind-to", "none", "-np", str(cores), *command, "-parallel"]
    process = subprocess.Popen(pinned(cores) + command, cwd=folder, env={**os.environ, **ENVIRONMENT}, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    stamps, log, peak = [], [], 0
    for line in process.stdout:
        log.append(line)
        found = re.match(r"ExecutionTime = ([\d.]+) s", line)
        if found:
            stamps.append((time.monotonic(), float(found[1])))
            if len(stamps) == 1:  # before the clock counts; all arrays are there by then
                peak = memory(process.pid)
    if process.wait() != 0 or len(stamps) != steps:
        raise RuntimeError(f"{' '.join(command)} in {folder}:\n{''.join(log[-20:])}")
    (folder / "log").write_text("".join(log), encoding="utf-8")
    timed = steps - warm
    # The CPU time is that of one process; the other ones do as much, waiting included.
    return {"wall": (stamps[-1][0] - stamps[warm - 1][0]) / timed,
            "cpu": cores * (stamps[-1][1] - stamps[warm - 1][1]) / timed,
            "memory": peak, "divergence": duct.step * divergence(folder, cores)}


def memory(process):
    """Largest resident memory of the solver's processes below this one [bytes]."""
    total = 0
    children = subprocess.run(["pgrep", "-P", str(process)], capture_output=True, text=True, check=False).stdout.split()
    for number in [str(process), *children]:
        try:
            with open(f"/proc/{number}/status", encoding="utf-8") as file:
                text = file.read()
        except OSError:
            continue
        if "pimpleFoam" in text.splitlines()[0]:
            total += 1024 * int(re.search(r"VmHWM:\s+(\d+)", text)[1])
    return total


def divergence(folder, cores):
    """Largest |div phi| of a cell at the end [1/s]."""
    if cores > 1:
        call(folder, "reconstructPar", "-latestTime", "-fields", "(U p)")
        call(folder, "mpirun", "--bind-to", "none", "-np", str(cores), "postProcess", "-func", "div(phi)", "-latestTime",
             "-parallel")
        files = list(folder.glob("processor*/[0-9]*/div(phi)"))
    else:
        call(folder, "postProcess", "-func", "div(phi)", "-latestTime")
        files = list(folder.glob("[0-9]*/div(phi)"))
    if len(files) < cores:
        raise RuntimeError(f"{folder}: no field div(phi)")
    return max(largest_value(file) for file in files)


def largest_value(path):
    data = path.read_bytes()
    found = re.search(rb"internalField\s+nonuniform List<scalar>\s*(\d+)\s*\(", data)
    count = int(found[1])
    values = struct.unpack(f"<{count}d", data[found.end():found.end() + 8 * count])
    return max(map(abs, values))
