#include "dem/fill_region.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellicle::dem {
namespace {

constexpr Real fit_tolerance = 1e-9;  // of a radius

/// Box around a disc.
void include_disc(Box& box, const Vec3& centre, const Vec3& axis, Real radius) {
  for (int a = 0; a < 3; ++a) {
    const Real reach = radius * std::sqrt(std::max(0.0, 1 - axis[a] * axis[a]));
    box.min[a] = std::min(box.min[a], centre[a] - reach);
    box.max[a] = std::max(box.max[a], centre[a] + reach);
  }
}

struct RoundEnds {
  Vec3 from, to;
  Real from_radius, to_radius, inner_radius;
};

RoundEnds round_ends(const FillRegion& region) {
  if (const auto* cylinder = std::get_if<CylinderRegion>(&region)) {
    return {cylinder->from, cylinder->to, cylinder->radius, cylinder->radius, 0};
  }
  if (const auto* cone = std::get_if<ConeRegion>(&region)) {
    return {cone->from, cone->to, cone->from_radius, cone->to_radius, 0};
  }
  const auto& annulus = std::get<AnnulusRegion>(region);
  return {annulus.from, annulus.to, annulus.outer_radius, annulus.outer_radius, annulus.inner_radius};
}

}  // namespace

Real region_volume(const FillRegion& region) {
  if (const auto* box = std::get_if<Box>(&region)) {
    const Vec3 l = box->max - box->min;
    return l.x * l.y * l.z;
  }
  const RoundEnds ends = round_ends(region);
  const Real a = ends.from_radius, b = ends.to_radius;
  return std::numbers::pi * norm(ends.to - ends.from) *
         ((a * a + a * b + b * b) / 3 - ends.inner_radius * ends.inner_radius);
}

Box region_bounds(const FillRegion& region) {
  if (const auto* box = std::get_if<Box>(&region)) return *box;
  const RoundEnds ends = round_ends(region);
  const Vec3 axis = (1 / norm(ends.to - ends.from)) * (ends.to - ends.from);
  Box box{ends.from, ends.from};
  include_disc(box, ends.from, axis, ends.from_radius);
  include_disc(box, ends.to, axis, ends.to_radius);
  return box;
}

Box region_bounds(const DiscRegion& disc) {
  Box box{disc.centre, disc.centre};
  include_disc(box, disc.centre, disc.normal, disc.radius);
  return box;
}

Room::Room(const FillRegion& region) {
  if (const auto* box = std::get_if<Box>(&region)) {
    box_ = *box;
    return;
  }
  const RoundEnds ends = round_ends(region);
  round_ = true;
  from_ = ends.from;
  length_ = norm(ends.to - ends.from);
  axis_ = (1 / length_) * (ends.to - ends.from);
  radius_ = ends.from_radius;
  slope_ = (ends.to_radius - ends.from_radius) / length_;
  slant_ = std::sqrt(1 + slope_ * slope_);
  inner_ = ends.inner_radius;
}

bool Room::holds(const Vec3& centre, Real sphere_radius) const {
  const Real radius = (1 - fit_tolerance) * sphere_radius;
  if (!round_) {
    for (int a = 0; a < 3; ++a) {
      if (centre[a] < box_.min[a] + radius || centre[a] > box_.max[a] - radius) return false;
    }
    return true;
  }
  const Real along = dot(centre - from_, axis_);
  if (along < radius || along > length_ - radius) return false;
  const Real out = norm(centre - from_ - along * axis_);
  return out <= radius_at(along) - slant_ * radius && (inner_ == 0 || out >= inner_ + radius);
}

bool Room::bring_inside(Vec3& centre, Real radius) const {
  const Real slack = 0.5 * fit_tolerance * radius;
  if (!round_) {
    for (int a = 0; a < 3; ++a) {
      const Real low = box_.min[a] + radius, high = box_.max[a] - radius;
      if (low > high + 2 * slack) return false;
      centre[a] = low < high ? std::clamp(centre[a], low, high) : 0.5 * (low + high);
    }
    return true;
  }
  // Along the axis: clear of both ends, and where the region is wide enough.
  Real low = radius, high = length_ - radius;
  const Real least_width = slant_ * radius + (inner_ > 0 ? inner_ + radius : 0);
  const Real lacking = least_width - slack - radius_;  // of the radius at `from`
  if (slope_ > 0) low = std::max(low, lacking / slope_);
  if (slope_ < 0) high = std::min(high, lacking / slope_);
  if (low > high + 2 * slack || (slope_ == 0 && lacking > 0)) return false;
  const Vec3 x = centre - from_;
  const Real given = dot(x, axis_);
  const Real along = low < high ? std::clamp(given, low, high) : 0.5 * (low + high);
  const Vec3 radial = x - given * axis_;
  const Real out = norm(radial);
  const Real most = std::max(0.0, radius_at(along) - slant_ * radius);
  const Real least = inner_ > 0 ? std::min(most, inner_ + radius) : 0;
  const Real allowed = std::clamp(out, least, most);
  if (along == given && allowed == out) return true;
  const Vec3 direction = out > 0 ? (1 / out) * radial : perpendicular_to(axis_);
  centre = from_ + along * axis_ + allowed * direction;
  return true;
}

}  // namespace pellicle::dem
