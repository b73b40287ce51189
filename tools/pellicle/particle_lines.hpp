// Moments of a particle quantity in the bins of a line, on the device.
#pragma once

#include <vector>

#include "core/running_moments.hpp"
#include "core/types.hpp"
#include "core/views.hpp"
#include "tools/pellicle/line_geometry.hpp"
#include "tools/pellicle/particle_columns.hpp"

namespace pellicle::tools {

/// The bins of one line. Each add() counts every particle whose centre lies in a bin as one sample of that bin.
/// The moments are formed in the order of the particles in memory, by one thread a bin, so that they do not depend on
/// the number of threads.
class ParticleLine {
 public:
  /// `quantity`: position in particle_quantities.
  ParticleLine(const LineGeometry& line, int quantity);

  void add(const ParticleColumns& columns);

  /// One entry a bin.
  std::vector<core::RunningMoments> moments() const;
  void set_moments(const std::vector<core::RunningMoments>& moments);

 private:
  LineGeometry line_;
  int quantity_;
  DeviceArray<core::RunningMoments> moments_;
  DeviceArray<Index> bin_of_;   ///< bin of each particle or -1
  DeviceArray<Index> hit_bin_;  ///< of the particles in the line, in their order
  DeviceArray<Real> hit_value_;
};

}  // namespace pellicle::tools
