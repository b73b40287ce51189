// How well the steps of the gas converged, over a run.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "cfd/gas_solver.hpp"
#include "core/types.hpp"

namespace pellicle::core {
class CheckpointWriter;
class CheckpointReader;
}  // namespace pellicle::core

namespace pellicle::tools {

/// Totals and worst cases of all gas steps since t = 0, over all resumes.
struct GasConvergence {
  std::int64_t steps = 0;             ///< outer steps are several where they are divided
  std::int64_t outer_iterations = 0;  ///< of all steps
  std::int64_t pressure_iterations = 0, momentum_iterations = 0;  ///< of the linear solvers
  std::int64_t steps_not_converged = 0;
  Real largest_velocity_change = 0;      ///< by a step's last outer iteration, relative
  Real largest_continuity_residual = 0;  ///< sum over the cells / gas throughput
  Real largest_momentum_residual = 0;    ///< relative
  Real largest_divergence = 0;           ///< of a cell, times the step
  Real largest_courant_number = 0;
  Real smallest_step = 0;  ///< [s]

  void add(const cfd::StepReport& report, Real dt);
  void save(core::CheckpointWriter& file) const;
  void load(core::CheckpointReader& file);
};

}  // namespace pellicle::tools
