// Everything that a run writes while it runs, behind a few calls.
#pragma once

#include <optional>

#include "core/time_control.hpp"
#include "tools/pellicle/case_spec.hpp"
#include "tools/pellicle/gas_average.hpp"
#include "tools/pellicle/lines.hpp"
#include "tools/pellicle/probes.hpp"
#include "tools/pellicle/results_folder.hpp"
#include "tools/pellicle/snapshots.hpp"
#include "tools/pellicle/wetness_outputs.hpp"
#include "tools/pellicle/zone_outputs.hpp"

namespace pellicle::tools {

/// Snapshots, averages, lines, probes, histograms, zones and wetness of a case.
class Outputs {
 public:
  /// `gas_grid` is null without gas. `resume_step` is the step of the checkpoint that the run goes on from: files
  /// are continued and what is later in them is dropped. `time` rounds the times of the outputs to outer steps and
  /// keeps the messages. Throws InputError for what the case asks for and cannot be shown.
  Outputs(const CaseSpec& spec, const ResultsFolder& folder, core::TimeControl& time,
          const CartesianGrid* gas_grid, std::optional<std::int64_t> resume_step);

  /// After each outer step, and once before the first one of a new run: takes the samples and writes the snapshots
  /// that are due. Does nothing while settling (step < 0). `last`: the run ends here, so that a snapshot is written
  /// even between two.
  void sample(const OutputState& state, bool last = false);

  /// Hands all rows to the operating system and rewrites lines and averages; to be called before a checkpoint and at the end.
  void flush();

  /// The averages so far.
  void save(core::CheckpointWriter& checkpoint) const {
    lines_.save(checkpoint);
    probes_.save(checkpoint);
    if (gas_average_) gas_average_->save(checkpoint);
  }
  void load(const core::CheckpointReader& checkpoint) {
    lines_.load(checkpoint);
    probes_.load(checkpoint);
    if (gas_average_) gas_average_->load(checkpoint);
  }

 private:
  const ResultsFolder& folder_;
  Lines lines_;
  Probes probes_;
  Histograms histograms_;
  ZoneOutputs zones_;
  WetnessOutputs wetness_;
  core::Schedule snapshot_schedule_;
  std::optional<ParticleSnapshots> particle_snapshots_;
  std::optional<SpraySnapshots> spray_snapshots_;
  std::optional<GasSnapshots> gas_snapshots_;
  std::optional<GasAverage> gas_average_;
};

}  // namespace pellicle::tools
