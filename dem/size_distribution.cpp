#include "dem/size_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace pellicle::dem {
namespace {

constexpr int class_count = 4096;

void require(bool good, const char* what) {
  if (!good) throw std::invalid_argument(what);
}

/// Edges from min to max, equal in length or in ratio.
std::vector<Real> make_edges(Real min, Real max, bool by_ratio) {
  std::vector<Real> edges(class_count + 1);
  for (int k = 0; k <= class_count; ++k) {
    const Real share = static_cast<Real>(k) / class_count;
    edges[static_cast<std::size_t>(k)] =
        by_ratio ? min * std::pow(max / min, share) : min + share * (max - min);
  }
  edges.back() = max;
  return edges;
}

template <class Cumulative>
std::vector<Real> at_edges(const std::vector<Real>& edges, const Cumulative& cumulative) {
  std::vector<Real> finer(edges.size());
  for (std::size_t k = 0; k < edges.size(); ++k) finer[k] = cumulative(edges[k]);
  return finer;
}

/// Standard normal distribution function, exact in its lower tail too.
Real normal_finer(Real x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

void require_bounds(Real min, Real max) {
  require(min > 0, "min must be greater than 0");
  require(max > min, "max must be greater than min");
}

/// Mean of 1/d³ between two diameters over a constant density: particles per mass.
Real mean_inverse_cube(Real low, Real high) { return 0.5 * (low + high) / (low * low * high * high); }

}  // namespace

SizeSampler::SizeSampler(const SizeDistribution& distribution) {
  if (const auto* uniform = std::get_if<UniformSizes>(&distribution)) {
    require_bounds(uniform->min, uniform->max);
    make_classes({uniform->min, uniform->max}, {0, 1}, ShareOf::count);
  } else if (const auto* normal = std::get_if<NormalSizes>(&distribution)) {
    require_bounds(normal->min, normal->max);
    require(normal->sd > 0, "sd must be greater than 0");
    const auto edges = make_edges(normal->min, normal->max, false);
    make_classes(edges,
                 at_edges(edges, [&](Real d) { return normal_finer((d - normal->mean) / normal->sd); }),
                 ShareOf::count);
  } else if (const auto* log_normal = std::get_if<LogNormalSizes>(&distribution)) {
    require_bounds(log_normal->min, log_normal->max);
    require(log_normal->median > 0, "median must be greater than 0");
    require(log_normal->geometric_sd > 1, "geometric_sd must be greater than 1");
    const Real width = std::log(log_normal->geometric_sd);
    const auto edges = make_edges(log_normal->min, log_normal->max, true);
    make_classes(
        edges,
        at_edges(edges, [&](Real d) { return normal_finer(std::log(d / log_normal->median) / width); }),
        log_normal->by);
  } else if (const auto* rosin = std::get_if<RosinRammlerSizes>(&distribution)) {
    require_bounds(rosin->min, rosin->max);
    require(rosin->size > 0 && rosin->spread > 0, "size and spread must be greater than 0");
    const auto edges = make_edges(rosin->min, rosin->max, true);
    make_classes(
        edges,
        at_edges(edges, [&](Real d) { return -std::expm1(-std::pow(d / rosin->size, rosin->spread)); }),
        ShareOf::mass);
  } else {
    const auto& table = std::get<TableSizes>(distribution);
    require(!table.diameters.empty() && table.diameters.front() > 0, "diameters must be greater than 0");
    require(std::adjacent_find(table.diameters.begin(), table.diameters.end(), std::greater_equal<>()) ==
                table.diameters.end(),
            "diameters must increase");
    if (!table.finer.empty()) {
      require(table.finer.size() == table.diameters.size() && table.finer.size() > 1,
              "finer must have as many entries as diameters, at least two");
      require(std::is_sorted(table.finer.begin(), table.finer.end()), "finer must not decrease");
      make_classes(table.diameters, table.finer, table.by);
      return;
    }
    require(table.shares.size() == table.diameters.size(), "shares must have as many entries as diameters");
    discrete_ = true;
    edges_ = table.diameters;
    Real sum = 0;
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      require(table.shares[k] >= 0, "shares must not be negative");
      const Real d = edges_[k];
      sum += table.by == ShareOf::mass ? table.shares[k] / (d * d * d) : table.shares[k];
      cumulative_.push_back(sum);
    }
    require(sum > 0, "one of the shares must be greater than 0");
    for (Real& c : cumulative_) c /= sum;
  }
}

void SizeSampler::make_classes(std::vector<Real> edges, const std::vector<Real>& finer, ShareOf by) {
  edges_ = std::move(edges);
  constant_ = by;
  Real sum = 0;
  for (std::size_t k = 0; k + 1 < edges_.size(); ++k) {
    const Real share = finer[k + 1] - finer[k];
    sum += by == ShareOf::mass ? share * mean_inverse_cube(edges_[k], edges_[k + 1]) : share;
    cumulative_.push_back(sum);
  }
  require(sum > 0, "no share of the distribution is between its bounds");
  for (Real& c : cumulative_) c /= sum;
}

Real SizeSampler::diameter(Real share) const {
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), share);
  const auto k = std::min(static_cast<std::size_t>(found - cumulative_.begin()), cumulative_.size() - 1);
  if (discrete_) return edges_[k];
  const Real below = k == 0 ? 0 : cumulative_[k - 1];
  const Real within = std::clamp((share - below) / (cumulative_[k] - below), Real{0}, Real{1});
  const Real low = edges_[k], high = edges_[k + 1];
  if (constant_ == ShareOf::count) return std::clamp(low + within * (high - low), low, high);
  // Constant by mass is d⁻³ by number, whose integral from low is (low⁻² − d⁻²)/2.
  const Real most = 1 / (low * low), least = 1 / (high * high);
  return std::clamp(1 / std::sqrt(most - within * (most - least)), low, high);
}

Real SizeSampler::mean_volume() const {
  Real mean_cube = 0;
  for (std::size_t k = 0; k < cumulative_.size(); ++k) {
    const Real share = cumulative_[k] - (k == 0 ? 0 : cumulative_[k - 1]);
    const Real low = edges_[k], high = discrete_ ? low : edges_[k + 1];
    // Means of d³ over the class: of a constant density by number, and of one by mass.
    mean_cube +=
        share * (constant_ == ShareOf::count || discrete_ ? 0.25 * (low + high) * (low * low + high * high)
                                                          : 1 / mean_inverse_cube(low, high));
  }
  return std::numbers::pi / 6 * mean_cube;
}

}  // namespace pellicle::dem
