#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

std::string CaseSpec::where(const std::string& path) const {
  for (std::string given = path;;) {
    if (const auto found = lines.find(given); found != lines.end()) return found->second + ": " + path;
    const auto dot = given.rfind('.');
    if (dot == std::string::npos) return file + ":1: " + path;
    given.resize(dot);
  }
}

dem::FillRegion FillSpec::region() const {
  if (cylinder) return *cylinder;
  if (cone) return *cone;
  if (annulus) return *annulus;
  return box.value_or(Box{});
}

bool FillSpec::mixes_with(const FillSpec& other) const {
  const auto same_box = [&] { return box->min == other.box->min && box->max == other.box->max; };
  return pattern == dem::FillPattern::random && other.pattern == pattern &&
         box.has_value() == other.box.has_value() && (!box || same_box()) && cylinder == other.cylinder &&
         cone == other.cone && annulus == other.annulus;
}

std::optional<dem::SizeDistribution> SizesSpec::distribution() const {
  if (uniform) return *uniform;
  if (normal) return *normal;
  if (log_normal) return *log_normal;
  if (rosin_rammler) return *rosin_rammler;
  if (table) return *table;
  return std::nullopt;
}

CartesianGrid make_grid(const GridSpec& grid, const DomainSpec& domain) {
  std::array<std::vector<Real>, 3> faces;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (!grid.faces[a].empty()) {
      faces[a] = grid.faces[a];
      continue;
    }
    const Real low = domain.box.min[axis];
    const Real length = domain.box.max[axis] - low;
    const auto cells = static_cast<std::size_t>(grid.cells[axis]);
    // Sizes 1, g, g2, ... scaled to the length; sums, so that neighbouring faces are in order.
    std::vector<Real> sums{0};
    Real size = 1;
    for (std::size_t i = 0; i < cells; ++i) {
      sums.push_back(sums.back() + size);
      size *= grid.growth[axis];
    }
    for (const Real sum : sums) faces[a].push_back(low + length * sum / sums.back());
    faces[a].back() = domain.box.max[axis];
  }
  return CartesianGrid(faces, domain.periodic);
}

}  // namespace pellicle::tools
