#pragma once

#include <string>

namespace pellicle {

/// Version number of the program, for example "0.1.0".
std::string version();

/// Git commit the program was built from, with "-dirty" if files had changed; "unknown" outside a repository.
std::string commit();

/// Several lines for `--version` and the log: version, commit, build type, Kokkos and its backends, compiler.
std::string version_text();

}  // namespace pellicle
