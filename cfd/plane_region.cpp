#include "cfd/plane_region.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace pellicle::cfd {

Real Rectangle::area() const { return std::max(max[0] - min[0], 0.0) * std::max(max[1] - min[1], 0.0); }

Rectangle Rectangle::intersect(const Rectangle& b) const {
  return {{std::max(min[0], b.min[0]), std::max(min[1], b.min[1])},
          {std::min(max[0], b.max[0]), std::min(max[1], b.max[1])}};
}

Real circle_rectangle_area(const std::array<Real, 2>& centre, Real radius, const Rectangle& rectangle) {
  const Real x0 = std::clamp(rectangle.min[0] - centre[0], -radius, radius);
  const Real x1 = std::clamp(rectangle.max[0] - centre[0], -radius, radius);
  const Real y0 = std::clamp(rectangle.min[1] - centre[1], -radius, radius);
  const Real y1 = std::clamp(rectangle.max[1] - centre[1], -radius, radius);
  if (!(x1 > x0) || !(y1 > y0)) return 0;
  // Between the places where the circle crosses the rectangle's lower and upper side either the one or the other
  // bounds the area above and below.
  std::vector<Real> ends{x0, x1};
  for (const Real y : {y0, y1}) {
    const Real x = std::sqrt(std::max(radius * radius - y * y, 0.0));
    for (const Real at : {-x, x}) {
      if (at > x0 && at < x1) ends.push_back(at);
    }
  }
  std::sort(ends.begin(), ends.end());
  const auto height = [&](Real x) { return std::sqrt(std::max(radius * radius - x * x, 0.0)); };
  const auto integral = [&](Real x) {
    return 0.5 * (x * height(x) + radius * radius * std::asin(std::clamp(x / radius, -1.0, 1.0)));
  };
  Real area = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const Real from = ends[i];
    const Real to = ends[i + 1];
    const Real arc = height(0.5 * (from + to));
    if (arc <= y0 || -arc >= y1) continue;
    const Real under = integral(to) - integral(from);
    const Real above = arc < y1 ? under : y1 * (to - from);
    const Real below = -arc > y0 ? -under : y0 * (to - from);
    area += above - below;
  }
  return area;
}

Real circle_circle_area(const std::array<Real, 2>& centre_a, Real a, const std::array<Real, 2>& centre_b,
                        Real b) {
  const Real d = std::hypot(centre_a[0] - centre_b[0], centre_a[1] - centre_b[1]);
  if (a <= 0 || b <= 0 || d >= a + b) return 0;
  const Real smaller = std::min(a, b);
  if (d <= std::abs(a - b)) return std::numbers::pi * smaller * smaller;
  // Two segments that share a chord.
  const auto segment = [&](Real own, Real other) {
    const Real to_chord = (d * d + own * own - other * other) / (2 * d);
    const Real angle = std::acos(std::clamp(to_chord / own, -1.0, 1.0));
    return own * own * angle - to_chord * std::sqrt(std::max(own * own - to_chord * to_chord, 0.0));
  };
  return segment(a, b) + segment(b, a);
}

Real PlaneRegion::area_within(const Rectangle& rectangle) const {
  if (!round_) return rectangle_.intersect(rectangle).area();
  const Real inner = inner_radius_ > 0 ? circle_rectangle_area(centre_, inner_radius_, rectangle) : 0;
  return circle_rectangle_area(centre_, radius_, rectangle) - inner;
}

Real PlaneRegion::area_within(const PlaneRegion& other) const {
  if (!round_) return other.area_within(rectangle_);
  if (!other.round_) return area_within(other.rectangle_);
  const auto both = [&](Real a, Real b) { return circle_circle_area(centre_, a, other.centre_, b); };
  return both(radius_, other.radius_) - both(inner_radius_, other.radius_) -
         both(radius_, other.inner_radius_) + both(inner_radius_, other.inner_radius_);
}

}  // namespace pellicle::cfd
