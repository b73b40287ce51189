// What a nozzle is, and what of it the kernels need.
#pragma once

#include <limits>
#include <string>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "spray/droplet_sizes.hpp"
#include "spray/spray_pattern.hpp"
#include "spray/swept_capture_laws.hpp"

namespace pellicle::spray {

struct Nozzle {
  std::string name;
  Vec3 position;        ///< centre of the orifice [m]
  Vec3 axis;            ///< unit vector into the spray
  Real cone_angle = 0;  ///< full angle at the apex [rad]
  SprayPattern pattern = SprayPattern::full;
  Real inner_cone_angle = 0;  ///< of the cone without droplets in a hollow spray, full angle [rad]
  Real radius = 0;            ///< of the orifice [m]
  Real speed = 0;             ///< of the droplets as they leave [m/s]
  Real mass_rate = 0;         ///< of liquid and solids together [kg/s]
  Real solids_fraction = 0;   ///< share of the mass that is solids
  Real density = 1000;        ///< of a droplet [kg/m3]
  Real temperature = 0;       ///< of the droplets as they leave [K]; of use with a gas that has a temperature
  DropletDiameter diameter = Real(0);
  Real droplets_per_parcel = 1;                ///< that a parcel of droplets of the mean volume stands for
  Real from = 0;                               ///< when it opens [s]
  Real to = std::numeric_limits<Real>::max();  ///< when it closes [s]
  CaptureEfficiency efficiency{};
};

}  // namespace pellicle::spray
