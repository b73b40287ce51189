// Time averages of fields of the gas, cell by cell: gas_average.h5.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/checkpoint.hpp"
#include "core/time_control.hpp"
#include "tools/pellicle/case_spec.hpp"
#include "tools/pellicle/gas_fields.hpp"

namespace pellicle::tools {

/// Mean and RMS of the fluctuation about it of each number of each cell, sampled after every outer step of a window.
/// They take 16 bytes a number, and a step reads and writes them once.
class GasAverage {
 public:
  GasAverage(const GasAverageSpec& spec, core::TimeControl& time, const CartesianGrid& grid);

  /// Takes up the fields of a step, if it is in the window.
  void sample(std::int64_t step, const GasFields& gas);
  /// Replaces gas_average.h5 and its XDMF file: of each field FIELD_mean and FIELD_rms. Nothing before the first sample.
  void write(const std::filesystem::path& folder) const;

  void save(core::CheckpointWriter& checkpoint) const;
  /// A field that is new, or whose average began at another time, begins now, with a warning.
  void load(const core::CheckpointReader& checkpoint);

 private:
  struct Field {
    std::string name;
    std::int64_t samples = 0;
    HostArray<Real> mean, squares;  ///< as RunningMoments has them; numbers of a cell one after the other
  };

  const CartesianGrid& grid_;
  core::StepWindow window_;
  Real gas_step_;
  std::int64_t last_;  ///< sampled step
  std::vector<Field> fields_;
};

}  // namespace pellicle::tools
