// Meshes for tests, made by hand, and STL files of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "dem/walls.hpp"

namespace pellicle::tests {

/// The twelve triangles of a box, normals outwards.
inline std::vector<dem::TriangleShape> box_triangles(const Vec3& min, const Vec3& max) {
  std::vector<dem::TriangleShape> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (int upper = 0; upper < 2; ++upper) {
      const auto corner = [&](bool far_u, bool far_v) {
        Vec3 x;
        x[axis] = upper == 1 ? max[axis] : min[axis];
        x[u] = far_u ? max[u] : min[u];
        x[v] = far_v ? max[v] : min[v];
        return x;
      };
      const Vec3 a = corner(false, false), b = corner(true, false), c = corner(true, true),
                 d = corner(false, true);
      if (upper == 1) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
      } else {
        triangles.push_back({a, c, b});
        triangles.push_back({a, d, c});
      }
    }
  }
  return triangles;
}

/// The mantle of a polygonal tube about the axis along y through the origin: `facets` flat strips whose middles lie at
/// `radius`, between y0 and y1, each of two triangles.
inline std::vector<dem::TriangleShape> tube_triangles(Real radius, Real y0, Real y1, int facets) {
  std::vector<dem::TriangleShape> triangles;
  const Real corner_radius = radius / std::cos(M_PI / facets);
  const auto corner = [&](int i, Real y) {
    const Real angle = 2 * M_PI * (i % facets) / facets;
    return Vec3{corner_radius * std::sin(angle), y, -corner_radius * std::cos(angle)};
  };
  for (int i = 0; i < facets; ++i) {
    triangles.push_back({corner(i, y0), corner(i + 1, y0), corner(i + 1, y1)});
    triangles.push_back({corner(i, y0), corner(i + 1, y1), corner(i, y1)});
  }
  return triangles;
}

/// Loose triangles as a mesh: every corner its own.
inline std::shared_ptr<const dem::TriangleMesh> loose_mesh(const std::vector<dem::TriangleShape>& triangles) {
  auto mesh = std::make_shared<dem::TriangleMesh>();
  for (const dem::TriangleShape& t : triangles) {
    const auto first = static_cast<std::int32_t>(mesh->corners.size());
    mesh->corners.insert(mesh->corners.end(), {t.a, t.b, t.c});
    mesh->triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

inline std::string ascii_stl(const std::vector<dem::TriangleShape>& triangles) {
  std::string text = "solid made up\n";
  const auto vector = [](const Vec3& v) {
    return std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
  };
  for (const dem::TriangleShape& t : triangles) {
    text += "  facet normal " + vector(cross(t.b - t.a, t.c - t.a)) + "    outer loop\n";
    for (const Vec3& corner : {t.a, t.b, t.c}) text += "      vertex " + vector(corner);
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid made up\n";
}

inline std::string binary_stl(const std::vector<dem::TriangleShape>& triangles,
                              std::string header = "made up") {
  header.resize(80, ' ');
  std::string bytes = header;
  const auto add = [&bytes](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  add(static_cast<std::uint32_t>(triangles.size()));
  for (const dem::TriangleShape& t : triangles) {
    for (const Vec3& v : {cross(t.b - t.a, t.c - t.a), t.a, t.b, t.c}) {
      for (int axis = 0; axis < 3; ++axis) add(static_cast<float>(v[axis]));
    }
    add(std::uint16_t{0});
  }
  return bytes;
}

}  // namespace pellicle::tests
