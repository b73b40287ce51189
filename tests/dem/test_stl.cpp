// STL files: what is read, what is said of a mesh, what is refused and in which words.
#include "dem/stl.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "tests/core/temporary_folder.hpp"
#include "tests/dem/meshes.hpp"

namespace pellicle::dem {
namespace {

using tests::ascii_stl;
using tests::binary_stl;
using tests::box_triangles;

const Vec3 low{1, 2, 3}, high{3, 5, 7};  // 2 x 3 x 4

std::string error_of(const std::string& content) {
  MeshReport report;
  try {
    parse_stl(content, 1, report);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

void expect_error(const std::string& content, const std::string& part) {
  const std::string message = error_of(content);
  EXPECT_NE(message.find(part), std::string::npos) << message << "\ninstead of something with\n" << part;
}

TEST(Stl, ReadsAsciiAndBinaryAlike) {
  const auto box = box_triangles(low, high);
  for (const std::string& content :
       {ascii_stl(box), binary_stl(box), binary_stl(box, "solid, says this header")}) {
    MeshReport report;
    const TriangleMesh mesh = parse_stl(content, 1e-3, report);  // in mm
    ASSERT_EQ(mesh.triangles.size(), 12U);
    EXPECT_EQ(report.triangles, 12);
    EXPECT_EQ(report.corners, 8);
    EXPECT_EQ(mesh.corners.size(), 8U);
    EXPECT_TRUE(report.watertight());
    EXPECT_NEAR(report.volume, 24e-9, 1e-20);
    EXPECT_EQ(report.min, 1e-3 * low);
    EXPECT_EQ(report.max, 1e-3 * high);
    EXPECT_EQ(doubts_about_mesh(report), "");
    EXPECT_NE(describe_mesh(report).find("watertight, around 2.4e-08 m3, normals point outwards"),
              std::string::npos)
        << describe_mesh(report);
    // The order of the triangles is that of the file.
    EXPECT_EQ(mesh.triangle(7).a, 1e-3 * box[7].a);
    EXPECT_EQ(mesh.triangle(7).c, 1e-3 * box[7].c);
  }
}

TEST(Stl, FilesThatAreNoneOrTooLargeAreNotRead) {
  const tests::TemporaryFolder folder;
  MeshReport report;
  const auto error = [&](const std::filesystem::path& path) {
    try {
      read_stl(path, 1, report);
    } catch (const std::invalid_argument& problem) {
      return std::string(problem.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error(folder / "none.stl"), "it cannot be read; a file that is there");
  EXPECT_EQ(error(folder / "."), "it cannot be read; a file that is there");
  EXPECT_EQ(error("/dev/zero"), "it cannot be read; a file that is there");  // without end
  // Ten million triangles of nothing: a file with a hole, so that it takes no space.
  const auto large = folder / "large.stl";
  {
    std::ofstream file(large, std::ios::binary);
    const std::uint32_t count = 10'000'000;
    file.write(std::string(80, ' ').data(), 80).write(reinterpret_cast<const char*>(&count), sizeof count);
  }
  std::filesystem::resize_file(large, 84 + std::uintmax_t{50} * 10'000'000);
  EXPECT_EQ(error(large),
            "it has 10000000 triangles; at most 5000000: a mesh much finer than the particles gains nothing");
  std::filesystem::resize_file(large, most_bytes + 1);
  EXPECT_EQ(error(large), "it has 2500000001 bytes; at most 2500000000");
}

TEST(Stl, SaysWhatIsDoubtful) {
  auto box = box_triangles(low, high);
  MeshReport report;
  // A hole: the three edges of one triangle are open.
  auto open = box;
  open.pop_back();
  parse_stl(binary_stl(open), 1, report);
  EXPECT_FALSE(report.watertight());
  EXPECT_EQ(report.open_edges, 3);
  // One triangle the wrong way round: its three edges run the same way twice.
  auto flipped = box;
  std::swap(flipped[5].b, flipped[5].c);
  parse_stl(binary_stl(flipped), 1, report);
  EXPECT_EQ(report.flipped_edges, 3);
  // All of them: a cavity.
  for (auto& t : box) std::swap(t.b, t.c);
  parse_stl(binary_stl(box), 1, report);
  EXPECT_TRUE(report.watertight());
  EXPECT_NEAR(report.volume, -24, 1e-9);
  // Corners that differ by what six digits make of them are one, a line and a repeated triangle are dropped.
  box[3].a += Vec3{1e-6, -1e-6, 0};
  box.push_back({low, 0.5 * (low + high), high});
  box.push_back({high, high, low});
  box.push_back({box[4].b, box[4].c, box[4].a});
  parse_stl(binary_stl(box), 1, report);
  EXPECT_TRUE(report.watertight());
  EXPECT_EQ(report.corners, 9);  // the middle of the line was looked at
  EXPECT_EQ(report.triangles, 12);
  EXPECT_EQ(report.degenerate, 2);
  EXPECT_EQ(report.doubled, 1);
  EXPECT_EQ(doubts_about_mesh(report),
            "2 triangles without area (dropped), 1 triangles that are there twice (dropped once)");
  // Three leaves at one edge, and a normal that contradicts its corners.
  std::vector<TriangleShape> leaves;
  for (const Vec3& tip : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{-1, -1, 0}})
    leaves.push_back({{0, 0, 0}, {0, 0, 1}, tip});
  std::string content = ascii_stl(leaves);
  const std::size_t normal = content.find("normal ") + 7;
  content[content.find_first_not_of("-.0 ", normal)] = '9';
  parse_stl(content, 1, report);
  EXPECT_EQ(report.crowded_edges, 1);
  EXPECT_EQ(report.open_edges, 6);
}

TEST(Stl, RefusesWhatIsNoMesh) {
  const auto box = box_triangles(low, high);
  const std::string ascii = ascii_stl(box);
  const std::string binary = binary_stl(box);
  expect_error("", "the file is empty; an STL file, ASCII or binary");
  expect_error("<html>404</html>", "it is no STL file: it neither begins with \"solid\" nor");
  expect_error(std::string("\x7f"
                           "ELF\0\0\0",
                           7),
               "it has 7 bytes, fewer than the header of a binary STL file");
  expect_error(binary.substr(0, binary.size() - 30),
               "its header announces 12 triangles, which take 684 bytes, but it has 654");
  expect_error(binary + "!", "announces 12 triangles, which take 684 bytes, but it has 685");
  for (const std::size_t size :
       {ascii.size() / 2, ascii.size() / 2 + 5, ascii.size() / 2 + 10, ascii.size() / 3})
    expect_error(ascii.substr(0, size), "truncated");
  expect_error(ascii.substr(0, ascii.rfind("endsolid")),
               "line 86: there is no endsolid, the file is truncated");
  expect_error("solid empty\nendsolid empty\n", "it has no triangles; at least one triangle");
  expect_error(ascii_stl({{low, low, high}}), "none of its triangles has an area");
  std::string misspelt = ascii;
  misspelt.replace(misspelt.find("vertex"), 6, "vertax");
  expect_error(misspelt, "line 4: \"vertax\" where \"vertex\" is expected");
  std::string no_number = ascii;
  no_number.replace(no_number.find("vertex") + 7, 8, "1.0e0x00");
  expect_error(no_number, "line 4: \"1.0e0x00\" is no number; a number");
}

TEST(Stl, RefusesCoordinatesThatAreNoNumbers) {
  auto box = box_triangles(low, high);
  for (const Real bad : {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity()}) {
    auto broken = box;
    broken[4].b.y = bad;
    expect_error(binary_stl(broken), "triangle 5 has a corner at (");
    // The fifth facet of seven lines begins at line 30, its second corner is in line 33.
    expect_error(ascii_stl(broken), "line 33 has a corner at (");
    expect_error(ascii_stl(broken), "; finite coordinates");
  }
}

TEST(Stl, RefusesTenMillionTriangles) {
  // The count in the header decides, before anything is allocated.
  std::string content = binary_stl({});
  const std::uint32_t count = 10'000'000;
  std::memcpy(content.data() + 80, &count, sizeof count);
  expect_error(content, "it has 10000000 triangles; at most 5000000");
}

TEST(Stl, RefusesAFileThatIsNotThere) {
  MeshReport report;
  EXPECT_THROW(read_stl("/nowhere/mesh.stl", 1, report), std::invalid_argument);
}

}  // namespace
}  // namespace pellicle::dem
