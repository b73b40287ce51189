#include "tools/pellicle/gas_average.hpp"

#include <cmath>

#include "core/hdf5_file.hpp"
#include "core/running_moments.hpp"
#include "core/warn.hpp"
#include "tools/pellicle/snapshots.hpp"

namespace pellicle::tools {

namespace {

struct AddSample {
  GasFieldNumbers now;
  std::int64_t samples;
  HostArray<Real> mean, squares;

  void operator()(std::size_t n) const { core::update_moments(now(n), samples, mean(n), squares(n)); }
};

}  // namespace

GasAverage::GasAverage(const GasAverageSpec& spec, core::TimeControl& time, const CartesianGrid& grid)
    : grid_(grid),
      window_(time.window(spec.window.from, spec.window.to, "output.average")),
      gas_step_(time.gas_step()),
      last_(window_.from) {
  for (const std::string& name : spec.gas) {
    const auto numbers = static_cast<std::size_t>(grid.cell_count()) * gas_field_components(name);
    fields_.push_back({name, 0, HostArray<Real>("tools::gas_average::mean", numbers),
                       HostArray<Real>("tools::gas_average::squares", numbers)});
  }
}

void GasAverage::sample(std::int64_t step, const GasFields& gas) {
  if (!window_.contains(step)) return;
  last_ = step;
  for (Field& field : fields_) {
    Kokkos::parallel_for("tools::gas_average::add_sample", HostRange(0, field.mean.extent(0)),
                         AddSample{gas_field(gas, field.name), ++field.samples, field.mean, field.squares});
  }
}

void GasAverage::write(const std::filesystem::path& folder) const {
  if (fields_.empty() || last_ == window_.from) return;
  const Real from = static_cast<Real>(window_.from) * gas_step_, to = static_cast<Real>(last_) * gas_step_;
  replace_gas_snapshot(folder, "gas_average", grid_, last_, to,
                       [&](core::Hdf5File& file, const std::string& group) {
                         for (const Field& field : fields_) {
                           if (field.samples == 0) continue;
                           const std::vector<std::size_t> shape = gas_field_shape(grid_, field.name);
                           const auto count = static_cast<Real>(field.samples);
                           std::vector<double> rms(field.squares.extent(0));
                           for (std::size_t n = 0; n < rms.size(); ++n)
                             rms[n] = std::sqrt(field.squares(n) / count);
                           file.write(group + "/" + field.name + "_mean",
                                      std::span<const double>(field.mean.data(), rms.size()), shape);
                           file.write(group + "/" + field.name + "_rms", std::span<const double>(rms), shape);
                           file.set_attribute(group + "/" + field.name + "_mean", "samples", field.samples);
                         }
                         file.set_attribute(group, "from", from);
                       });
}

void GasAverage::save(core::CheckpointWriter& checkpoint) const {
  checkpoint.write("output/average/last", last_);
  for (const Field& field : fields_) {
    const std::string path = "output/average/" + field.name;
    checkpoint.write(path + "/from", window_.from);
    checkpoint.write(path + "/samples", field.samples);
    checkpoint.write(path + "/mean", field.mean);
    checkpoint.write(path + "/squares", field.squares);
  }
}

void GasAverage::load(const core::CheckpointReader& checkpoint) {
  for (Field& field : fields_) {
    const std::string path = "output/average/" + field.name;
    if (!checkpoint.has(path + "/from") || checkpoint.read_int64(path + "/from") != window_.from) {
      const std::string text = "the average of the gas's " + field.name +
                               " is new or has changed since the checkpoint: it begins now";
      core::warn(text);
      continue;
    }
    last_ = checkpoint.read_int64("output/average/last");
    field.samples = checkpoint.read_int64(path + "/samples");
    checkpoint.read_into(path + "/mean", field.mean);
    checkpoint.read_into(path + "/squares", field.squares);
  }
}

}  // namespace pellicle::tools
