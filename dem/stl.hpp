// Triangle meshes from STL files, ASCII and binary, and what is wrong with them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "dem/walls.hpp"

namespace pellicle::dem {

/// More triangles than this are refused.
inline constexpr std::int64_t most_triangles = 5'000'000;

/// What a mesh is like, after it was cleaned.
struct MeshReport {
  std::int64_t triangles = 0;      ///< kept
  std::int64_t corners = 0;        ///< different ones
  std::int64_t degenerate = 0;     ///< dropped: no area
  std::int64_t doubled = 0;        ///< dropped: the same three corners as another one
  std::int64_t open_edges = 0;     ///< of one triangle alone
  std::int64_t crowded_edges = 0;  ///< of more than two triangles
  std::int64_t flipped_edges = 0;  ///< of two triangles whose corners run in opposite senses
  std::int64_t wrong_normals =
      0;              ///< triangles whose normal in the file contradicts the order of their corners
  Real volume = 0;    ///< enclosed, if watertight [m³]; negative: normals point inwards
  Vec3 min{}, max{};  ///< bounds [m]

  bool watertight() const { return open_edges == 0 && crowded_edges == 0 && flipped_edges == 0; }
};

/// One line that says what a mesh is like, and one that says what is doubtful about it (empty: nothing).
std::string describe_mesh(const MeshReport& report);
std::string doubts_about_mesh(const MeshReport& report);

/// Reads the text or the bytes of an STL file; lengths times `scale` are in m. Corners closer than 1e-6 of the mesh's
/// size are one. Throws std::invalid_argument with `what is wrong; what is allowed`: no STL, truncated, coordinates that
/// are no numbers, too many triangles, none with an area.
TriangleMesh parse_stl(std::string_view content, Real scale, MeshReport& report);

/// A larger file is not read: five million triangles as text take about half as much.
inline constexpr std::uintmax_t most_bytes = 2'500'000'000;

/// The same from a file, of which no more than the header is read if that announces too many triangles.
TriangleMesh read_stl(const std::filesystem::path& path, Real scale, MeshReport& report);

}  // namespace pellicle::dem
