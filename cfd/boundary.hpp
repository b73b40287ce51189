// Boundaries of the gas: named regions on the faces of the domain.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cfd/scalar_options.hpp"
#include "cfd/turbulence_options.hpp"
#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::cfd {

/// A side of the domain; in the case file left, right, front, back, bottom, top.
enum class Side { x_min, x_max, y_min, y_max, z_min, z_max };

inline int axis_of(Side side) { return static_cast<int>(side) / 2; }
inline bool is_max(Side side) { return static_cast<int>(side) % 2 == 1; }
/// Name of a side in the case file.
std::string_view name_of(Side side);

/// Gas comes in at right angles to the side or the wall, with void fraction 1 in the plane of the inlet.
struct Inlet {
  std::optional<Real> velocity;     ///< superficial, inward [m/s]; exactly one of the three is set
  std::optional<Real> flow_rate;    ///< spread uniformly over the inlet's area [m3/s]
  Real share{1};                    ///< of the flow rate that comes through this inlet
  std::optional<Real> mass_flow{};  ///< likewise, at the density of the gas that comes in [kg/s]
};
/// Gas leaves at a given pressure. Gas that comes back in has that pressure as its stagnation pressure.
struct Outlet {
  Real pressure = 0;  ///< [Pa], without the hydrostatic part density gravity.x
};
/// The gas sticks to a wall that moves in its own plane.
struct NoSlip {
  Vec3 velocity;  ///< tangential [m/s]
};
/// A wall without shear.
struct FreeSlip {};
/// A plane of symmetry; acts on the gas as a wall without shear does.
struct Symmetry {};

/// A disc, or an annulus, on a side of the domain.
struct DiscRegion {
  Vec3 centre;            ///< its part along the side counts [m]
  Real radius = 0;        ///< [m]
  Real inner_radius = 0;  ///< [m]
};

struct BoundaryPatch {
  std::string name;
  Side on = Side::z_min;
  std::optional<Box>
      region;  ///< the part of the side inside this box; neither this nor disc: what no region of that side takes
  std::variant<Inlet, Outlet, NoSlip, FreeSlip, Symmetry> kind;
  std::string where;  ///< `file:line: key`, opens messages about this patch
  std::array<ScalarBoundary, scalar_count>
      scalars{};                     ///< what scalars meet here; of use where they are solved
  std::optional<DiscRegion> disc{};  ///< the part of the side inside this disc, in place of a box
  std::optional<std::string>
      wall{};                    ///< name of a surface within the domain that it is, in place of the side
  InletTurbulence turbulence{};  ///< of an inlet; of use with a model of turbulence
};

}  // namespace pellicle::cfd
