#!/usr/bin/python3
"""Compiles every file that holds a kernel for an NVIDIA GPU, without linking or running it.

Kokkos's headers contain the CUDA backend even where the library was built without it, so four small headers before
the Kokkos include path are enough to let nvcc compile the device code. The registers and spills of each kernel, as
ptxas reports them, go to kernels.txt in the output folder. A file that has not changed is not compiled again.

Device folders are core, dem, coupling, heat and spray, and files of cfd named *device*; the rest of cfd runs on the
host only. Without nvcc the check says 'skipped' and succeeds. Exit 1: a file does not compile.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

TOP = pathlib.Path(__file__).resolve().parents[2]
DEVICE_FOLDERS = ("core", "dem", "coupling", "heat", "spray")
KERNEL = re.compile(r"\bKokkos::(?:Experimental::)?parallel_(?:for|reduce|scan)\b")
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
# No fused multiply-add, as on the host: the two forces of a pair stay exactly opposite.
FLAGS = [
    "-x", "cu", "-arch=sm_90", "-std=c++20", "-O3", "--fmad=false", "--expt-extended-lambda",
    "--expt-relaxed-constexpr", "-Werror", "cross-execution-space-call", "-DDESUL_ATOMICS_ENABLE_CUDA",
    "-Xcompiler", "-fopenmp", "-Xptxas", "-v",
]


def project_includes(path, seen=None):
    """The file and all project headers it includes, directly or not."""
    seen = {} if seen is None else seen
    if path in seen:
        return seen
    seen[path] = path.read_text()
    for name in INCLUDE.findall(seen[path]):
        header = TOP / name
        if header.is_file():
            project_includes(header, seen)
    return seen


def kernel_files():
    """Source files to compile, each with the texts of everything of this project that it includes."""
    found = {}
    for folder in DEVICE_FOLDERS:
        for path in sorted((TOP / folder).glob("*.cpp")):
            texts = project_includes(path)
            if any(KERNEL.search(text) for text in texts.values()):
                found[path] = texts
    others = list((TOP / "cfd").glob("*device*.cpp")) + list((TOP / "tools/pellicle").glob("*.cpp"))
    for path in sorted(others):
        if KERNEL.search(path.read_text()):
            found[path] = project_includes(path)
    return found


def write_backend_headers(kokkos_include, folder):
    """The packaged configuration with CUDA added; OpenMP stays the host's backend."""
    config = next((d / "KokkosCore_config.h" for d in kokkos_include if (d / "KokkosCore_config.h").is_file()), None)
    if config is None:
        sys.exit(f"cuda-check: no KokkosCore_config.h in {', '.join(map(str, kokkos_include))}")
    text = config.read_text()
    added = "".join(
        f"#define {name}\n"
        for name in ("KOKKOS_ENABLE_CUDA", "KOKKOS_ENABLE_CUDA_LAMBDA", "KOKKOS_ARCH_HOPPER", "KOKKOS_ARCH_HOPPER90",
                     "KOKKOS_IMPL_ARCH_NVIDIA_GPU 90"))
    marker = "#define KOKKOS_ENABLE_OPENMP\n"
    if marker not in text:
        sys.exit("cuda-check: the installed Kokkos has no OpenMP backend")
    headers = {
        "KokkosCore_config.h": text.replace(marker, marker + added),
        "KokkosCore_Config_FwdBackend.hpp":
            "#pragma once\n#include <fwd/Kokkos_Fwd_CUDA.hpp>\n#include <fwd/Kokkos_Fwd_OPENMP.hpp>\n",
        "KokkosCore_Config_DeclareBackend.hpp":
            "#pragma once\n#include <decl/Kokkos_Declare_OPENMP.hpp>\n#include <decl/Kokkos_Declare_CUDA.hpp>\n",
        "KokkosCore_Config_SetupBackend.hpp": "#pragma once\n#include <setup/Kokkos_Setup_Cuda.hpp>\n",
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in headers.items():
        path = folder / name
        if not path.is_file() or path.read_text() != content:
            path.write_text(content)
    return "".join(headers.values())


def split_top_level(text, separator):
    """Where `separator` first occurs outside brackets, or -1."""
    depth = 0
    i = 0
    while i < len(text):
        if depth == 0 and text.startswith(separator, i):
            return i
        if text[i] in "<([{":
            depth += 1
        elif text[i] in ">)]}":
            depth -= 1
        i += 1
    return -1


def short_name(demangled):
    """('dem::f<Law>', number of the lambda) of one of this project's kernels, None for Kokkos's own."""
    match = re.search(r"Kokkos::Impl::Parallel(?:For|Reduce|Scan|ScanWithTotal)<", demangled)
    if not match:
        return None
    functor = demangled[match.end():]
    functor = re.sub(r"_INTERNAL_\w+?::", "", functor).replace("(anonymous namespace)::", "")
    functor = functor[:split_top_level(functor, ",")]
    functor = re.sub(r"^(Kokkos::Impl::Combined(?:FunctorReducer|ReductionFunctorWrapper)<)+", "", functor)
    if functor.startswith("Kokkos::"):
        return None
    number = 1
    lambda_at = functor.find("::{lambda")
    if lambda_at >= 0:
        number = int(re.search(r"#(\d+)", functor[lambda_at:]).group(1))
        functor = functor[:lambda_at]
        functor = functor[:split_top_level(functor, "(")] if split_top_level(functor, "(") > 0 else functor
    functor = functor[split_top_level(functor, " ") + 1:]  # the return type of an instantiated template
    return functor.replace("pellicle::", ""), number


def labels_by_function(texts):
    """Function or functor name -> labels of its kernels, in order; '' where the label is not a literal."""
    labels = {}
    for text in texts.values():
        for match in KERNEL.finditer(text):
            literal = re.match(r'\s*(?:<[^>]*>)?\s*\(\s*"([^"]+)"', text[match.end():])
            # The enclosing function starts at the last line before with a name and a bracket in the first column.
            heads = re.findall(r"^(?!//|#|template|using|namespace|struct|class|\})\S.*?([\w~]+)\(", text[:match.start()],
                               re.MULTILINE)
            if heads:
                labels.setdefault(heads[-1], []).append(literal.group(1) if literal else "")
            call = text[match.end():text.find(";", match.end())]
            for functor in re.findall(r"\b([A-Z]\w+)\s*[<{(]", call):
                labels.setdefault(functor, []).append(literal.group(1) if literal else "")
    return labels


def read_kernels(log, texts):
    """Rows (kernel, label, registers, stack, spill stores, spill loads) of one file's ptxas report."""
    reports = re.findall(
        r"Compiling entry function '([^']+)' for '\w+'.*?(\d+) bytes stack frame, (\d+) bytes spill stores, "
        r"(\d+) bytes spill loads.*?Used (\d+) registers", log, re.DOTALL)
    names = subprocess.run(["c++filt"], input="\n".join(r[0] for r in reports), capture_output=True, text=True,
                           check=True).stdout.split("\n")
    rows = []
    for name, (_, stack, stores, loads, registers) in zip(names, reports):
        short = short_name(name)
        if short:
            rows.append([short[0], short[1], int(registers), int(stack), int(stores), int(loads)])
    labels = labels_by_function(texts)
    numbers = {}
    for name, number, *_ in rows:
        numbers.setdefault(name, set()).add(number)
    result = []
    for name, number, *figures in rows:
        bare = re.sub(r"<.*", "", name).split("::")[-1]
        known = labels.get(bare, [])
        place = sorted(numbers[name]).index(number)
        label = known[place] if place < len(known) else ""
        shown = name if len(numbers[name]) == 1 else f"{name} #{number}"
        result.append([shown, label, *figures])
    return result


def compile_file(path, texts, nvcc, include_flags, salt, cache):
    """(rows, seconds, log) on success or failure; rows is None if the file did not compile."""
    key = hashlib.sha256(salt.encode())
    for name in sorted(texts):
        key.update(str(name.relative_to(TOP)).encode() + b"\0" + texts[name].encode())
    record = cache / f"{key.hexdigest()[:32]}.json"
    if record.is_file():
        return json.loads(record.read_text()), 0.0, ""
    started = time.monotonic()
    run = subprocess.run([nvcc, *FLAGS, *include_flags, "-c", str(path), "-o", os.devnull], capture_output=True,
                         text=True)
    log = run.stdout + run.stderr
    if run.returncode != 0:
        return None, time.monotonic() - started, log
    rows = read_kernels(log, texts)
    record.write_text(json.dumps(rows))
    return rows, time.monotonic() - started, log


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=pathlib.Path, default=TOP / "build/cuda-check")
    parser.add_argument("--kokkos-include", default="", help="include folders of Kokkos, separated by ';'")
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("PELLICLE_JOBS", os.cpu_count() or 1)))
    parser.add_argument("files", nargs="*", type=pathlib.Path, help="only these files")
    arguments = parser.parse_args()

    nvcc = shutil.which("nvcc") or shutil.which("/usr/local/cuda/bin/nvcc")
    if nvcc is None:
        print("cuda-check: skipped, there is no nvcc here")
        return 0
    files = kernel_files()
    if arguments.files:
        wanted = {f.resolve() for f in arguments.files}
        files = {path: texts for path, texts in files.items() if path in wanted}
    if arguments.kokkos_include:
        kokkos_include = [pathlib.Path(d) for d in arguments.kokkos_include.split(";")]
    else:
        kokkos_include = [d for d in (TOP / ".deps/usr/include/kokkos", pathlib.Path("/usr/include/kokkos")) if d.is_dir()]

    headers = arguments.output / "headers"
    backend = write_backend_headers(kokkos_include, headers)
    cache = arguments.output / "cache"
    cache.mkdir(exist_ok=True)
    include_flags = ["-isystem", str(headers)]
    for folder in kokkos_include:
        include_flags += ["-isystem", str(folder)]
    include_flags.append(f"-I{TOP}")
    version = subprocess.run([nvcc, "--version"], capture_output=True, text=True, check=True).stdout
    salt = "\0".join([version, *FLAGS, backend, pathlib.Path(__file__).read_text()])

    failed = []
    table = []
    with concurrent.futures.ThreadPoolExecutor(max(1, arguments.jobs)) as pool:
        work = {path: pool.submit(compile_file, path, texts, nvcc, include_flags, salt, cache)
                for path, texts in files.items()}
        for path, future in work.items():
            rows, seconds, log = future.result()
            name = path.relative_to(TOP)
            if rows is None:
                failed.append(name)
                print(f"cuda-check: {name} does not compile:\n{log}")
                continue
            print(f"cuda-check: {name}: {len(rows)} kernels" + (f", {seconds:.0f} s" if seconds else ", unchanged"))
            table += [[str(name), *row] for row in rows]

    spilling = sum(1 for row in table if row[5] or row[6])
    lines = [f"{len(table)} kernels of {len(files)} files, sm_90, {spilling} with spills. Stack and spills in bytes.", ""]
    heading = ["registers", "stack", "spill stores", "spill loads", "kernel (function it stands in)", "label"]
    lines.append("  ".join([*heading[:4], f"{heading[4]:<60}", heading[5]]))
    seen = set()
    for _, kernel, label, registers, stack, stores, loads in sorted(table, key=lambda row: (row[0], row[1])):
        line = f"{registers:>9}  {stack:>5}  {stores:>12}  {loads:>11}  {kernel:<60}  {label}".rstrip()
        if line not in seen:  # a template compiled by several files
            seen.add(line)
            lines.append(line)
    (arguments.output / "kernels.txt").write_text("\n".join(lines) + "\n")
    print(f"cuda-check: {lines[0]} Table: {arguments.output / 'kernels.txt'}")
    if failed:
        print(f"cuda-check: {len(failed)} of {len(files)} files failed: {', '.join(map(str, failed))}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
