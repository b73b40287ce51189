#include "tools/pellicle/gas_convergence.hpp"

#include "core/checkpoint.hpp"

namespace pellicle::tools {

namespace {

template <class Convergence, class Count, class Worst>
void visit(Convergence& c, const Count& count, const Worst& worst) {
  count("run/gas/steps", c.steps);
  count("run/gas/outer_iterations", c.outer_iterations);
  count("run/gas/pressure_iterations", c.pressure_iterations);
  count("run/gas/momentum_iterations", c.momentum_iterations);
  count("run/gas/steps_not_converged", c.steps_not_converged);
  worst("run/gas/largest_velocity_change", c.largest_velocity_change);
  worst("run/gas/largest_continuity_residual", c.largest_continuity_residual);
  worst("run/gas/largest_momentum_residual", c.largest_momentum_residual);
  worst("run/gas/largest_divergence", c.largest_divergence);
  worst("run/gas/largest_courant_number", c.largest_courant_number);
  worst("run/gas/smallest_step", c.smallest_step);
}

}  // namespace

void GasConvergence::add(const cfd::StepReport& report, Real dt) {
  const auto keep_largest = [](Real& largest, Real value) { largest = std::max(largest, value); };
  ++steps;
  outer_iterations += report.outer_iterations;
  pressure_iterations += report.pressure_iterations;
  momentum_iterations += report.momentum_iterations;
  if (!report.converged) ++steps_not_converged;
  keep_largest(largest_velocity_change, report.velocity_change);
  keep_largest(largest_continuity_residual, report.continuity_residual);
  keep_largest(largest_momentum_residual, report.momentum_residual);
  keep_largest(largest_divergence, report.divergence);
  keep_largest(largest_courant_number, report.courant_number);
  smallest_step = steps == 1 ? dt : std::min(smallest_step, dt);
}

void GasConvergence::save(core::CheckpointWriter& file) const {
  visit(
      *this, [&](const char* name, std::int64_t value) { file.write(name, value); },
      [&](const char* name, Real value) { file.write(name, value); });
}

void GasConvergence::load(core::CheckpointReader& file) {
  visit(
      *this, [&](const char* name, std::int64_t& value) { value = file.read_int64(name); },
      [&](const char* name, Real& value) { value = file.read_double(name); });
}

}  // namespace pellicle::tools
