// One particle by its number, on the device.
#pragma once

#include "core/types.hpp"
#include "tools/pellicle/particle_columns.hpp"

namespace pellicle::tools {

/// Looks particles up by id. Owns the one entry in device memory that the answer passes through.
class ParticleFinder {
 public:
  ParticleFinder();
  /// False if there is no such particle (any more); `sample` is then left as it is.
  bool find(const ParticleColumns& particles, Index id, ParticleSample& sample) const;

 private:
  DeviceArray<ParticleSample> found_;
  DeviceArray<Index> count_;
};

}  // namespace pellicle::tools
