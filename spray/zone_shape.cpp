#include "spray/zone_shape.hpp"

#include <fmt/format.h>

namespace pellicle::spray {

std::string describe(const ZoneShape& shape) {
  const auto of = [](const Vec3& v) { return fmt::format("({} {} {})", v.x, v.y, v.z); };
  if (shape.is_box) return fmt::format("box {} {}", of(shape.min), of(shape.max));
  return fmt::format("cylinder {} {} {} {}", of(shape.from), of(shape.axis), shape.length, shape.radius);
}

}  // namespace pellicle::spray
