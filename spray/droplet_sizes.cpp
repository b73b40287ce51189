#include "spray/droplet_sizes.hpp"

#include <numbers>
#include <vector>

#include "core/to_device.hpp"

namespace pellicle::spray {

DropletSizes make_droplet_sizes(const DropletDiameter& diameter, Real& mean_volume) {
  std::vector<Real> edges{0};
  std::vector<Real> cumulative{1};
  DropletSizes made;
  if (const auto* single = std::get_if<Real>(&diameter)) {
    edges[0] = *single;
    mean_volume = std::numbers::pi / 6 * *single * *single * *single;
  } else {
    const dem::SizeSampler sampler(std::get<dem::SizeDistribution>(diameter));
    mean_volume = sampler.mean_volume();
    edges = sampler.edges();
    cumulative = sampler.cumulative();
    made.discrete = sampler.is_discrete();
    made.constant_by_mass = sampler.constant_within_classes() == dem::ShareOf::mass;
    // Shares by number times the mean of d³ over the class: of a constant density by number, and of one by mass.
    Real before = 0;
    Real sum = 0;
    for (std::size_t k = 0; k < cumulative.size(); ++k) {
      const Real share = cumulative[k] - before;
      before = cumulative[k];
      const Real low = edges[k];
      const Real high = made.discrete ? low : edges[k + 1];
      const Real mean_cube = made.constant_by_mass && !made.discrete
                                 ? 2 * low * low * high * high / (low + high)
                                 : 0.25 * (low + high) * (low * low + high * high);
      sum += share * mean_cube;
      cumulative[k] = sum;
    }
    for (Real& c : cumulative) c /= sum;
  }
  made.edges = to_device("spray::droplet_sizes::edges", edges);
  made.cumulative = to_device("spray::droplet_sizes::cumulative", cumulative);
  return made;
}

}  // namespace pellicle::spray
