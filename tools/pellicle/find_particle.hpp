// One particle by its number, on the device.
#pragma once

#include "core/types.hpp"
#include "dem/particles.hpp"

namespace pellicle::tools {

/// Everything about one particle.
struct ParticleSample {
  dem::PositionRadius position_radius{};
  dem::VelocitySpin velocity_spin{};
  Real mass = 0;
  dem::Vec3f acceleration;
};

/// Looks particles up by id. Owns the one entry in device memory that the answer passes through.
class ParticleFinder {
 public:
  ParticleFinder();
  /// False if there is no such particle (any more); `sample` is then left as it is.
  bool find(const dem::Particles& particles, Index id, ParticleSample& sample) const;

 private:
  DeviceArray<ParticleSample> found_;
  DeviceArray<Index> count_;
};

}  // namespace pellicle::tools
