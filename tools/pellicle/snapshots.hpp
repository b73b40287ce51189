// Snapshots of all particles, of the spray and of the gas: particles.h5, spray.h5 and gas.h5, each with an XDMF file
// beside it, which is what ParaView opens. One group a snapshot, "step0000005000", with attributes step and time [s].
//
// The HDF5 file is open only while a snapshot is being added, and the XDMF file, replaced afterwards as a whole, names
// complete snapshots only: a run can be watched while it runs, and a killed one leaves both readable.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "tools/pellicle/gas_fields.hpp"
#include "tools/pellicle/host_parcels.hpp"
#include "tools/pellicle/particle_quantities.hpp"

namespace pellicle::core {
class Hdf5File;
}

namespace pellicle::tools {

/// What an XDMF file says of one array of a snapshot.
struct SnapshotArray {
  std::string name;
  std::vector<std::size_t> shape;
  bool integer = false;
};

struct SnapshotRecord {
  std::string group;
  std::int64_t step = 0;
  Real time = 0;  ///< [s]
  std::vector<SnapshotArray> arrays;
};

/// Writes one grid of the XDMF file: topology, geometry, attributes.
using DescribeSnapshot = std::function<std::string(const std::string& h5_name, const SnapshotRecord&)>;

/// The arrays of a group, as the XDMF file names them.
std::vector<SnapshotArray> arrays_of(const core::Hdf5File& file, const std::string& group);
/// Replaces the XDMF file beside an HDF5 file by one of these snapshots.
void write_xdmf(const std::filesystem::path& h5, const std::vector<SnapshotRecord>& records,
                const DescribeSnapshot& describe);

/// A time series of groups in one HDF5 file with its XDMF description: what particles and gas have in common.
class SnapshotSeries {
 public:
  /// Begins FOLDER/NAME.h5, or with `resume_step` goes on with it, dropping later snapshots (write_xdmf() then has to
  /// follow). A file that cannot be read any more is kept as NAME.h5.damaged, with a warning.
  SnapshotSeries(const std::filesystem::path& folder, const std::string& name, DescribeSnapshot describe,
                 std::optional<std::int64_t> resume_step);

  /// Adds what does not change in time, unless it is there already.
  void write_once(const std::string& name, const std::function<void(core::Hdf5File&)>& write);
  /// Adds a snapshot; `write` fills the group that it is given. Replaces one of the same step.
  void add(std::int64_t step, Real time,
           const std::function<void(core::Hdf5File&, const std::string& group)>& write);

  /// Replaces the XDMF file by one of the present snapshots.
  void write_xdmf() const { tools::write_xdmf(h5_, records_, describe_); }

  const std::vector<SnapshotRecord>& records() const { return records_; }
  /// Shape of an array outside the snapshots; empty if it is not there.
  std::vector<std::size_t> shape(const std::string& name) const;

 private:
  void resume(std::int64_t step);

  std::filesystem::path h5_;
  DescribeSnapshot describe_;
  std::vector<SnapshotRecord> records_;
};

/// A time series of clouds of points, as many of them as there are at the time: the field "position" of each snapshot.
class CloudSeries {
 public:
  /// As SnapshotSeries.
  CloudSeries(const std::filesystem::path& folder, const std::string& name,
              std::optional<std::int64_t> resume_step);
  CloudSeries(const CloudSeries&) = delete;
  CloudSeries& operator=(const CloudSeries&) = delete;
  /// Adds a snapshot of `count` points; `write` fills the group that it is given.
  void add(std::int64_t step, Real time, std::size_t count,
           const std::function<void(core::Hdf5File&, const std::string& group)>& write);

 private:
  std::size_t rows_ = 0;  ///< length of the data set "rows": 0, 1, 2, ..., which XDMF needs as a connectivity
  SnapshotSeries series_;
};

/// particles.h5: one row a particle, in the order of their ids; positions always, other fields as named.
class ParticleSnapshots {
 public:
  /// `fields`: names from particle_snapshot_fields.
  ParticleSnapshots(const std::filesystem::path& folder, std::vector<std::string> fields,
                    std::optional<std::int64_t> resume_step = std::nullopt);
  void write(std::int64_t step, Real time, const HostParticles& particles);

 private:
  std::vector<std::string> fields_;
  CloudSeries series_;
};

/// spray.h5: one row a parcel in flight, in the order of nozzles and of their numbers; positions always, other fields as
/// named.
class SpraySnapshots {
 public:
  /// `fields`: names from spray_snapshot_fields.
  SpraySnapshots(const std::filesystem::path& folder, std::vector<std::string> fields,
                 std::optional<std::int64_t> resume_step = std::nullopt);
  void write(std::int64_t step, Real time, const HostParcels& parcels);

 private:
  std::vector<std::string> fields_;
  CloudSeries series_;
};

/// gas.h5: fields at cell centres, arrays nz x ny x nx (x 3), and the face coordinates of the grid.
class GasSnapshots {
 public:
  /// `fields`: names from gas_snapshot_fields.
  GasSnapshots(const std::filesystem::path& folder, std::vector<std::string> fields,
               const CartesianGrid& grid, std::optional<std::int64_t> resume_step = std::nullopt);
  void write(std::int64_t step, Real time, const GasFields& gas);

 private:
  std::vector<std::string> fields_;
  SnapshotSeries series_;
};

/// Replaces FOLDER/NAME.h5 by one with a single group "average", with attributes step and time [s], that `write` fills
/// with fields laid out as those of gas.h5, and the XDMF file beside it. Whoever reads finds the old or the new one. Throws
/// RunError.
void replace_gas_snapshot(const std::filesystem::path& folder, const std::string& name,
                          const CartesianGrid& grid, std::int64_t step, Real time,
                          const std::function<void(core::Hdf5File&, const std::string& group)>& write);

}  // namespace pellicle::tools
