#include "spray/region_identity.hpp"

#include <fmt/format.h>

#include "core/log.hpp"
#include "spray/contact_wetness.hpp"
#include "spray/zone_visits.hpp"

namespace pellicle::spray {

std::string identity_of(const ZoneOptions& o) {
  return fmt::format("{}; absence {}, longest {}, {} bins, {} size classes", describe(o.shape),
                     o.shortest_absence, o.longest_time, o.bins, o.size_classes);
}

std::string identity_of(const WetnessOptions& o) {
  return fmt::format("{}; measure {}, to {} in {}, to {} m/s in {}, sampled {}", describe(o.shape),
                     static_cast<int>(o.measure), o.wettest, o.bins, o.fastest, o.speed_bins,
                     o.every_substep);
}

bool goes_on(const core::CheckpointReader& file, const std::string& path, const std::string& identity,
             const std::string& what) {
  if (file.has(path) && file.read_string(path) == identity) return true;
  core::log().warn("the {} is new or has changed since the checkpoint: its counts begin now", what);
  return false;
}

}  // namespace pellicle::spray
