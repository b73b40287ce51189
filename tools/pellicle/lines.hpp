// Time-averaged profiles along lines: lines/NAME.csv.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/time_control.hpp"
#include "tools/pellicle/case_spec.hpp"
#include "tools/pellicle/gas_fields.hpp"
#include "tools/pellicle/particle_lines.hpp"
#include "tools/pellicle/results_folder.hpp"

namespace pellicle::core {
class CheckpointReader;
class CheckpointWriter;
}  // namespace pellicle::core

namespace pellicle::tools {

/// All lines of a case, sampled after every outer step within each line's averaging window.
///
/// A particle quantity counts each particle whose centre is in the bin, at each step, as one sample: the value is the
/// sum of all samples over their number. A gas quantity has one sample a step: its mean over the bin's volume.
class Lines {
 public:
  /// `gas_grid` may be null in a run without gas. Throws InputError for an unknown quantity, for a gas quantity
  /// without gas, or for a line that is none.
  Lines(const std::vector<LineSpec>& specs, core::TimeControl& time, const CartesianGrid* gas_grid);

  /// Adds the samples of this step; either may be null.
  void sample(std::int64_t step, const ParticleColumns* particles, const GasFields* gas);
  /// Replaces lines/NAME.csv: position, value, standard deviation, samples. Bins without a sample have value nan.
  void write(const ResultsFolder& folder) const;

  void save(core::CheckpointWriter& checkpoint) const;
  /// A line that is new, or has changed since the checkpoint, starts to average from now on, with a warning.
  void load(const core::CheckpointReader& checkpoint);

 private:
  struct Line {
    LineSpec spec;
    LineGeometry geometry;
    core::StepWindow window;
    int gas_quantity = -1;  ///< or a particle quantity, then:
    std::unique_ptr<ParticleLine> particles;
    std::vector<std::vector<CellShare>> cells;      ///< of a gas quantity, by bin
    std::vector<core::RunningMoments> gas_moments;  ///< of a gas quantity, by bin
  };
  static std::vector<core::RunningMoments> moments_of(const Line& line);
  static std::string fingerprint(const Line& line);

  std::vector<Line> lines_;
};

}  // namespace pellicle::tools
