// Parts of a plane: rectangles, discs and annuli, and what area two of them share.
#pragma once

#include <array>

#include "core/types.hpp"

namespace pellicle::cfd {

struct Rectangle {
  std::array<Real, 2> min{}, max{};

  /// 0 if it is empty.
  Real area() const;
  Rectangle intersect(const Rectangle& b) const;
};

/// Area that a circle shares with a rectangle.
Real circle_rectangle_area(const std::array<Real, 2>& centre, Real radius, const Rectangle& rectangle);

/// Area that two circles share.
Real circle_circle_area(const std::array<Real, 2>& centre_a, Real radius_a,
                        const std::array<Real, 2>& centre_b, Real radius_b);

/// A rectangle, or what is left of a circle with a smaller one about the same centre taken out.
class PlaneRegion {
 public:
  explicit PlaneRegion(const Rectangle& rectangle) : rectangle_(rectangle) {}
  PlaneRegion(const std::array<Real, 2>& centre, Real radius, Real inner_radius)
      : round_(true), centre_(centre), radius_(radius), inner_radius_(inner_radius) {}

  /// Area that it shares with a rectangle.
  Real area_within(const Rectangle& rectangle) const;
  /// Area that it shares with another region.
  Real area_within(const PlaneRegion& other) const;

 private:
  bool round_ = false;
  Rectangle rectangle_;
  std::array<Real, 2> centre_{};
  Real radius_ = 0, inner_radius_ = 0;
};

}  // namespace pellicle::cfd
