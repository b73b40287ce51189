// The whole simulation: owns all states and the loop.
#pragma once

#include <optional>
#include <string>

#include "core/types.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

struct RunOptions {
  std::string output_folder;  ///< exists or may be made; whether it may be used has been checked
  std::optional<Real> until;  ///< stop here with a checkpoint, before time.end [s]
  bool resume = false;        ///< go on from the checkpoint in output_folder
  bool overwrite = false;
  int threads = 0;
  std::string case_yaml_text;  ///< the case with all defaults filled in
};

/// Runs the case and returns the exit code; throws InputError or RunError. Kokkos must be initialised.
int run_simulation(const CaseSpec& spec, const RunOptions& options);

}  // namespace pellicle::tools
