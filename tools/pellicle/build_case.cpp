#include "tools/pellicle/build_case.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/error.hpp"
#include "core/model_variant.hpp"
#include "tools/pellicle/build_gas.hpp"
#include "tools/pellicle/case_checks.hpp"

namespace pellicle::tools {
namespace {

template <class Family>
void choose_model(const std::string& name, const std::string& where, Family& family) {
  const int index = core::find_model(core::model_list<Family>(), name);
  if (index < 0) throw InputError(where + ": no model named '" + name + "'");
  family = core::make_model<Family>(index);
}

}  // namespace

dem::EngineSetup make_engine_setup(const CaseSpec& spec, Real particle_step) {
  dem::EngineSetup setup;
  setup.domain.box = spec.domain.box;
  const bool boxed =
      std::any_of(spec.walls.begin(), spec.walls.end(), [](const WallSpec& w) { return w.box; });
  for (int axis = 0; axis < 3; ++axis) {
    const bool periodic = spec.domain.periodic[static_cast<std::size_t>(axis)];
    setup.domain.periodic[axis] = periodic ? 1 : 0;
    // Without box walls particles leave wherever no other wall holds them.
    setup.domain.open_min[axis] = setup.domain.open_max[axis] = boxed || periodic ? 0 : 1;
  }
  setup.materials = make_materials(spec);
  setup.pairs = make_pairs(spec);
  choose_model(spec.contacts.normal, spec.where("contacts.model.normal"), setup.contacts.normal);
  choose_model(spec.contacts.tangential, spec.where("contacts.model.tangential"), setup.contacts.tangential);
  choose_model(spec.contacts.rolling, spec.where("contacts.model.rolling"), setup.contacts.rolling);
  // Without rolling friction anywhere the law would compute zeros.
  if (std::all_of(spec.contacts.pairs.begin(), spec.contacts.pairs.end(),
                  [](const PairSpec& p) { return p.rolling_friction == 0; })) {
    setup.contacts.rolling = dem::NoRolling{};
  }
  if (spec.contacts.cohesion) setup.contacts.cohesion = spec.contacts.cohesion->willett;
  setup.contacts.clip = spec.contacts.clip;
  setup.contacts.overlap_limit = spec.contacts.overlap_limit;
  for (const WallSpec& wall : spec.walls) {
    if (wall.box) {
      for (const cfd::Side side : wall.open)
        (cfd::is_max(side) ? setup.domain.open_max : setup.domain.open_min)[cfd::axis_of(side)] = 1;
    }
  }
  setup.walls = make_walls(spec);
  for (const PopulationSpec& population : spec.particles) {
    if (!population.feed) continue;
    const DiameterRange diameters = diameter_range(population);
    dem::LaterParticles& later = setup.later;
    later.materials.push_back(population.material);
    later.smallest_radius = later.count == 0 ? 0.5 * diameters.smallest
                                             : std::min(later.smallest_radius, 0.5 * diameters.smallest);
    later.largest_radius = std::max(later.largest_radius, 0.5 * diameters.largest);
    later.count += std::max(std::int64_t{1}, fed_count(spec, population));
  }
  setup.gravity = spec.gravity;
  setup.time_step = particle_step;
  return setup;
}

coupling::CouplingOptions make_coupling_options(const CaseSpec& spec) {
  const CouplingSpec& c = spec.coupling;
  coupling::CouplingOptions options;
  choose_model(c.drag, spec.where("coupling.drag"), options.drag);
  choose_model(c.deposition, spec.where("coupling.deposition"), options.deposition);
  options.exchange = c.exchange;
  options.coefficients = c.coefficients;
  options.pressure_gradient_force = c.pressure_gradient_force;
  options.minimum_void_fraction = c.minimum_void_fraction;
  options.pending_release = c.pending_release;
  options.smoothing_length = c.smoothing_length;
  return options;
}

}  // namespace pellicle::tools
