// How wet particles are when they meet, and how fast: where a bed is at risk of clumping.
#pragma once

#include <string>
#include <vector>

#include "core/checkpoint.hpp"
#include "core/types.hpp"
#include "core/views.hpp"
#include "dem/engine.hpp"
#include "heat/surface_state.hpp"
#include "spray/zone_shape.hpp"

namespace pellicle::spray {

/// What the wetness of a contact is that of, the wetter of the two particles in it.
enum class WetnessMeasure {
  liquid_per_surface,  ///< liquid over the surface of the bare particle [kg/m2]
  liquid_fraction      ///< liquid over liquid and solids of the film
};

struct WetnessOptions {
  std::string name;
  ZoneShape shape;  ///< contacts count whose point lies in it
  WetnessMeasure measure = WetnessMeasure::liquid_per_surface;
  Real wettest = 1;  ///< upper end of the bins of wetness; what is wetter is in one more
  Index bins = 20;   ///< of wetness, besides one for dry contacts below them
  Real fastest = 1;  ///< upper end of the bins of speed; what is faster is in one more [m/s]
  Index speed_bins = 20;
  bool every_substep = false;  ///< contacts of all substeps are looked at, not only of an outer step's first
};

/// Contacts that began, by wetness and speed. Row 0 are those of two dry particles, the last row those above `wettest`; the
/// last column those above `fastest`.
struct WetnessCounts {
  Index rows = 0, columns = 0;
  std::vector<std::int64_t> pairs, walls;  ///< entry row x columns + column
};

/// The histogram of one region. A contact begins in a substep if the two overlap after it and did not before, at the places
/// that they had then; so nothing needs to be remembered of a contact. With `every_substep` false only those are looked
/// for that began in the substep before an outer step, and each counts for as many as that step has substeps: a sample
/// that is fair as long as contacts do not keep time with outer steps.
class ContactWetness {
 public:
  explicit ContactWetness(const WetnessOptions& options);

  /// In substep `k` of `substeps`, within the hook of Engine::advance, before the particles move: counts the contacts that
  /// began in the substep before. `film` is that of the particles.
  void count(int k, int substeps, const dem::Engine& engine, const DeviceArray<heat::Film>& film);

  WetnessCounts counts() const;
  const WetnessOptions& options() const { return options_; }

  void save(core::CheckpointWriter& file) const;
  /// A region that is new, or another one than the checkpoint's, begins at zero, with a warning.
  void load(const core::CheckpointReader& file);

 private:
  WetnessOptions options_;
  DeviceArray<std::int64_t> pairs_, walls_;
};

}  // namespace pellicle::spray
