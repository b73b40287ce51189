// What films add to the particles that carry them.
#pragma once

#include "core/model_list.hpp"

namespace pellicle::heat {

enum class FilmGrowth {
  none,            ///< films weigh nothing in the particles' motion
  mass,            ///< they count in the mass; the radius stays that of the bare particle
  mass_and_radius  ///< likewise, and the dry coating in the radius
};

/// Names of the case file, in the order of the enum.
inline constexpr core::ModelInfo film_growth_models[] = {
    {"none", "films weigh nothing in the particles' motion"},
    {"mass", "liquid and solids count in a particle's mass, once a gas step; its radius stays"},
    {"mass_and_radius", "likewise, and the dry coating makes the particle larger by its thickness"},
};

}  // namespace pellicle::heat
