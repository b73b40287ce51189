#include "tools/pellicle/outputs.hpp"

#include "tools/pellicle/histogram_file.hpp"

namespace pellicle::tools {

namespace {

std::optional<Real> time_of(const core::TimeControl& time, std::optional<std::int64_t> step) {
  if (!step) return std::nullopt;
  return time.time_of(*step);
}

}  // namespace

Outputs::Outputs(const CaseSpec& spec, const ResultsFolder& folder, core::TimeControl& time,
                 const CartesianGrid* gas_grid, std::optional<std::int64_t> resume_step)
    : folder_(folder),
      lines_(spec.output.lines, time, gas_grid),
      probes_(spec.output.probes, time, folder, spec.domain.box, gas_grid, time_of(time, resume_step)),
      histograms_(spec.output.histograms, time, folder, time_of(time, resume_step)),
      zones_(spec.output.zones, time, folder, time_of(time, resume_step)),
      wetness_(spec.output.wetness, time, folder, time_of(time, resume_step)),
      snapshot_schedule_(time.schedule(spec.output.snapshots.every, "output.snapshots.every")) {
  if (gas_grid != nullptr && spec.output.average) {
    gas_average_.emplace(*spec.output.average, time, *gas_grid);
  }
  if (snapshot_schedule_.steps == 0) return;
  if (!spec.particles.empty()) {
    particle_snapshots_.emplace(folder.path(), spec.output.snapshots.particles, resume_step);
  }
  if (!spec.spray.empty() && !spec.output.snapshots.spray.empty()) {
    spray_snapshots_.emplace(folder.path(), spec.output.snapshots.spray, resume_step);
  }
  if (gas_grid != nullptr && !spec.output.snapshots.gas.empty()) {
    gas_snapshots_.emplace(folder.path(), spec.output.snapshots.gas, *gas_grid, resume_step);
  }
}

void Outputs::sample(const OutputState& state, bool last) {
  if (state.step < 0) return;
  lines_.sample(state.step, state.particles, state.gas);
  probes_.sample(state);
  histograms_.sample(state, last);
  zones_.sample(state, last);
  wetness_.sample(state, last);
  if (gas_average_ && state.gas != nullptr) gas_average_->sample(state.step, *state.gas);
  if (!snapshot_schedule_.due(state.step) && !last) return;
  if (particle_snapshots_) particle_snapshots_->write(state.step, state.time, state.host_particles());
  if (spray_snapshots_ && state.spray != nullptr) {
    spray_snapshots_->write(state.step, state.time, copy_to_host(*state.spray));
  }
  if (gas_snapshots_ && state.gas != nullptr) gas_snapshots_->write(state.step, state.time, *state.gas);
}

void Outputs::flush() {
  lines_.write(folder_);
  if (gas_average_) gas_average_->write(folder_.path());
  probes_.flush();
  histograms_.flush();
  zones_.flush();
  wetness_.flush();
  write_histogram_file(folder_.path());
}

}  // namespace pellicle::tools
