#include "spray/region_identity.hpp"

#include <sstream>

#include "core/warn.hpp"
#include "spray/contact_wetness.hpp"
#include "spray/zone_visits.hpp"

namespace pellicle::spray {

std::string identity_of(const ZoneOptions& o) {
  std::ostringstream text;
  text.precision(17);
  text << describe(o.shape) << "; absence " << o.shortest_absence << ", longest " << o.longest_time << ", "
       << o.bins << " bins, " << o.size_classes << " size classes";
  return text.str();
}

std::string identity_of(const WetnessOptions& o) {
  std::ostringstream text;
  text.precision(17);
  text << describe(o.shape) << "; measure " << static_cast<int>(o.measure) << ", to " << o.wettest << " in "
       << o.bins << ", to " << o.fastest << " m/s in " << o.speed_bins << ", sampled " << o.every_substep;
  return text.str();
}

bool goes_on(const core::CheckpointReader& file, const std::string& path, const std::string& identity,
             const std::string& what) {
  if (file.has(path) && file.read_string(path) == identity) return true;
  const std::string text =
      "the " + what + " is new or has changed since the checkpoint: its counts begin now";
  core::warn(text);
  return false;
}

}  // namespace pellicle::spray
