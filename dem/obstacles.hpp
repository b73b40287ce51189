// Walls as particles that are being placed must not overlap them, on the host, before and during a run.
#pragma once

#include <optional>
#include <vector>

#include "core/views.hpp"
#include "dem/fill_region.hpp"
#include "dem/wall_geometry.hpp"

namespace pellicle::dem {

/// The walls of a case, at first where they rest before they move. Planes and blocks are solid; the other shapes are thin, and a
/// sphere may be on either side of them, but for closed meshes of which one side was chosen.
class Obstacles {
 public:
  /// No walls.
  Obstacles() = default;
  explicit Obstacles(const std::vector<Wall>& walls);

  /// Of each closed mesh the side that most of the region is on is room from now on, the other one is solid.
  void choose_sides(const FillRegion& region);
  /// The same for a region that these points are spread over.
  void choose_sides(const std::vector<Vec3>& points);

  /// Brings walls to `time` seconds after they began to move; negative: to where they rest before. A copy shares them.
  void move_to(Real time);
  /// Time after which the slowest of the walls that move is where it was [s]; 0 if none moves.
  Real longest_period() const;

  /// Where a sphere overlaps a wall.
  struct Overlap {
    std::int32_t wall = 0;
    Real depth = 0;  ///< how far the sphere reaches beyond the surface [m]
    Vec3 out{};      ///< unit vector: the shortest way out
  };
  /// The deepest overlap of a sphere, if any.
  std::optional<Overlap> deepest(const Vec3& centre, Real radius) const;

  /// Whether a sphere overlaps nothing, to 1e-6 of its radius.
  bool clear(const Vec3& centre, Real radius) const { return !deepest(centre, (1 - slack) * radius); }

  /// Moves a sphere out of what it overlaps; says whether it did overlap. In narrow places it may still do so.
  bool push_out(Vec3& centre, Real radius) const;

  /// The closed meshes, by the number of their wall.
  std::vector<std::int32_t> closed_meshes() const;
  /// Whether a point is within the closed mesh of a wall.
  bool encloses(std::int32_t wall, const Vec3& point) const;

  bool empty() const { return meshes_.empty() && geometry_.primitives == 0; }

 private:
  static constexpr Real slack = 1e-6;  // of a radius
  enum class Side { both, inside, outside };
  struct Mesh {
    MeshGrid grid;
    bool closed;
    Side room;
  };
  // These two take points of the frame of the wall.
  bool encloses(const MeshGrid& grid, const Vec3& point) const;
  std::optional<ClosestPoint> closest_on(const Mesh& mesh, const Vec3& c, Real reach) const;

  BasicWallGeometry<Host> geometry_;
  std::vector<Mesh> meshes_;
};

}  // namespace pellicle::dem
