// How the diameters of a population are spread, and how to draw one.
#pragma once

#include <variant>
#include <vector>

#include "core/model_list.hpp"
#include "core/types.hpp"

namespace pellicle::dem {

/// Whether shares of a distribution count particles or weigh them.
enum class ShareOf { count, mass };

// Families. Lengths in m; each is cut at `min` and `max`: what falls outside is drawn again.

struct UniformSizes {
  Real min = 0, max = 0;
  static constexpr core::ModelInfo info{"uniform", "each diameter between min and max equally often"};
};

struct NormalSizes {
  Real mean = 0, sd = 0;  ///< before the cut
  Real min = 0, max = 0;
  static constexpr core::ModelInfo info{"normal", "by number, cut at min and max"};
};

/// ln d is normal around ln median with standard deviation ln geometric_sd, before the cut.
struct LogNormalSizes {
  Real median = 0, geometric_sd = 1;
  Real min = 0, max = 0;
  ShareOf by = ShareOf::count;
  static constexpr core::ModelInfo info{"log_normal",
                                        "normal in the logarithm of the diameter, cut at min and max",
                                        "Crow & Shimizu (eds.), Lognormal Distributions (1988)"};
};

/// The share of mass finer than d is 1 − exp(−(d/size)^spread), before the cut.
struct RosinRammlerSizes {
  Real size = 0;  ///< 63.2 % of the mass is finer
  Real spread = 1;
  Real min = 0, max = 0;
  static constexpr core::ModelInfo info{"rosin_rammler", "by mass, cut at min and max",
                                        "Rosin & Rammler, J. Inst. Fuel 7 (1933) 29"};
};

/// Given diameters only (`shares`, one a diameter), or classes between them (`finer`: the cumulative share at each,
/// from 0 to 1 or in any unit, linear in between: a sieve analysis). Exactly one of the two is filled.
struct TableSizes {
  std::vector<Real> diameters;  ///< increasing
  std::vector<Real> shares;
  std::vector<Real> finer;
  ShareOf by = ShareOf::count;
  static constexpr core::ModelInfo info{"table", "given diameters with shares, or a sieve analysis"};
};

using SizeDistribution =
    std::variant<UniformSizes, NormalSizes, LogNormalSizes, RosinRammlerSizes, TableSizes>;

/// Draws diameters by number. All families become classes between edges, within each of which the density by number
/// or by mass is constant: 4096 classes from the exact cumulative distribution for the continuous families, which is
/// then met at every edge.
class SizeSampler {
 public:
  /// Throws std::invalid_argument naming the parameter that makes no sense (no width, nothing between the bounds).
  explicit SizeSampler(const SizeDistribution& distribution);

  /// Diameter [m] for a number in [0, 1): the inverse of the cumulative distribution by number.
  Real diameter(Real share) const;
  Real smallest() const { return edges_.front(); }
  Real largest() const { return edges_.back(); }
  /// Mean over particles of the volume of a sphere [m³].
  Real mean_volume() const;

  /// The classes, for those who draw otherwise: their edges, or the diameters of a discrete table [m]; the cumulative
  /// share by number at the upper edge of each (at each diameter); and what is constant within a class.
  const std::vector<Real>& edges() const { return edges_; }
  const std::vector<Real>& cumulative() const { return cumulative_; }
  bool is_discrete() const { return discrete_; }
  ShareOf constant_within_classes() const { return constant_; }

 private:
  void make_classes(std::vector<Real> edges, const std::vector<Real>& finer, ShareOf by);

  std::vector<Real> edges_;       // of the classes, or the diameters of a discrete table [m]
  std::vector<Real> cumulative_;  // by number at the upper edge of each class, up to 1
  ShareOf constant_ = ShareOf::count;
  bool discrete_ = false;
};

}  // namespace pellicle::dem
