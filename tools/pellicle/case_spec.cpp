#include "tools/pellicle/case_spec.hpp"

#include "core/graded_axis.hpp"

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

void refine(GridSpec& grid, const DomainSpec& domain) {
  const RefinementSpec& refinement = *grid.refinement;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const Real low = domain.box.min[axis];
    const Real high = domain.box.max[axis];
    if (refinement.single_cell[a]) {
      grid.faces[a] = {low, high};
    } else {
      std::vector<SizeZone> zones;
      zones.reserve(refinement.zones.size());
      for (const GridZoneSpec& zone : refinement.zones)
        zones.push_back({zone.box.min[axis], zone.box.max[axis], zone.cell_size});
      grid.faces[a] = make_graded_faces(low, high, refinement.cell_size, refinement.max_growth, zones,
                                        domain.periodic[a]);
    }
    grid.cells[axis] = static_cast<Index>(grid.faces[a].size()) - 1;
  }
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

bool CaseSpec::follows(std::string_view quantity) const {
  const bool warm = heat.has_value();
  const bool sprayed = !spray.empty();
  if (quantity.starts_with("wall_heat")) return warm && heat->contact_conduction;
  if (quantity == "particle_temperature" || quantity == "particle_temperature_mean") return warm;
  if (quantity == "hits" || quantity == "first_hit_time" || quantity == "last_hit_time") return sprayed;
  if (quantity == "film_liquid" || quantity == "film_solids" || quantity == "coating_thickness") {
    return warm || sprayed;
  }
  return true;
}

}  // namespace pellicle::tools
