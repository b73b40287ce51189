#!/usr/bin/python3
"""Reads every #include of the project and fails on an arrow between folders that the design does not have."""

import os
import pathlib
import re
import sys
import unittest

TOP = pathlib.Path(os.environ.get("PELLICLE_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))

# core <- dem, cfd <- coupling <- heat <- spray <- tools; only tests include tools.
ALLOWED = {
    "core": {"core"},
    "dem": {"core", "dem"},
    "cfd": {"core", "cfd"},
    "coupling": {"core", "dem", "cfd", "coupling"},
    "heat": {"core", "dem", "cfd", "coupling", "heat"},
    "spray": {"core", "dem", "cfd", "coupling", "heat", "spray"},
    "tools": {"core", "dem", "cfd", "coupling", "heat", "spray", "tools"},
    "tests": {"core", "dem", "cfd", "coupling", "heat", "spray", "tools", "tests"},
}
DEVICE_FOLDERS = ("core", "dem", "coupling", "heat", "spray")
# nvcc has to read whatever a kernel file includes.
HOST_ONLY_LIBRARY = re.compile(r"^(amgcl|hdf5|yaml-cpp|spdlog|nlohmann|CLI|Eigen)\b|^H5")
INCLUDE = re.compile(r'^\s*#\s*include\s+(["<])([^">]+)[">]', re.MULTILINE)
KERNEL = re.compile(r"\bKokkos::parallel_(for|reduce|scan)\b")
GENERATED = {"pellicle_build_info.hpp"}


def includes(path):
    """(kind, name) of each include line; kind is '"' for files of this project."""
    return INCLUDE.findall(path.read_text())


def sources():
    for folder in ALLOWED:
        for ending in ("*.cpp", "*.hpp"):
            yield from sorted((TOP / folder).rglob(ending))


def library_includes(path, seen):
    """Names in angle brackets that the file reaches through this project's headers, with the file that has them."""
    if path in seen:
        return
    seen.add(path)
    for kind, name in includes(path):
        if kind == "<":
            yield name, path
        elif (TOP / name).is_file():
            yield from library_includes(TOP / name, seen)


class IncludeDirection(unittest.TestCase):
    def test_there_are_sources(self):
        self.assertGreater(len(list(sources())), 3)

    def test_arrows_between_folders(self):
        wrong = []
        for path in sources():
            folder = path.relative_to(TOP).parts[0]
            for kind, name in includes(path):
                if kind != '"' or name in GENERATED:
                    continue
                target = pathlib.PurePosixPath(name).parts[0]
                if not (TOP / name).is_file():
                    wrong.append(f'{path.relative_to(TOP)}: "{name}" is no file below the top folder')
                elif target not in ALLOWED[folder]:
                    wrong.append(f'{path.relative_to(TOP)}: {folder} must not include "{name}"')
        self.assertEqual(wrong, [], "\n" + "\n".join(wrong))

    def test_laws_include_only_core_and_each_other(self):
        # Laws, and what a law is told of a contact, stand by themselves: a test calls them without any loop. Those of
        # another folder may be among them (saturation in heat/ is that of the gas): in which direction, see above.
        wrong = []
        for path in sources():
            if not path.name.endswith(("_laws.hpp", "contact_state.hpp")):
                continue
            for kind, name in includes(path):
                law = name.endswith(("_laws.hpp", "contact_state.hpp"))
                if kind == '"' and not name.startswith("core/") and not law:
                    wrong.append(f'{path.relative_to(TOP)}: a file of laws must not include "{name}"')
        self.assertEqual(wrong, [], "\n" + "\n".join(wrong))

    def test_kernel_files_include_no_host_library(self):
        wrong = []
        for path in sources():
            if path.relative_to(TOP).parts[0] not in DEVICE_FOLDERS or not KERNEL.search(path.read_text()):
                continue
            for name, where in library_includes(path, set()):
                if HOST_ONLY_LIBRARY.search(name):
                    wrong.append(f"{path.relative_to(TOP)}: holds a kernel, but reaches <{name}> in "
                                 f"{where.relative_to(TOP)}")
        self.assertEqual(wrong, [], "\n" + "\n".join(wrong))

    def test_headers_are_guarded(self):
        wrong = [str(path.relative_to(TOP)) for path in sources()
                 if path.suffix == ".hpp" and "#pragma once" not in path.read_text()]
        self.assertEqual(wrong, [], "no #pragma once")


if __name__ == "__main__":
    sys.exit(unittest.main())
