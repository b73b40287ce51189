#include "dem/stl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "core/error.hpp"
#include "core/files.hpp"
#include "dem/mesh_checks.hpp"

namespace pellicle::dem {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL files are little-endian");

constexpr std::size_t header_size = 80;
constexpr std::size_t facet_size = 50;  // normal and three corners in float, two bytes of anything
constexpr std::string_view allowed = "an STL file, ASCII or binary";

[[noreturn]] void refuse(const std::string& what, std::string_view instead = allowed) {
  throw std::invalid_argument(fmt::format("{}; {}", what, instead));
}

void check_count(std::int64_t count) {
  if (count <= most_triangles) return;
  refuse(fmt::format("it has {} triangles", count),
         fmt::format("at most {}: a mesh much finer than the particles gains nothing", most_triangles));
}

Vec3 checked_corner(const Vec3& corner, const std::string& place) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::isfinite(corner[axis]) && std::abs(corner[axis]) < 1e30) continue;
    refuse(fmt::format("{} has a corner at ({}, {}, {})", place, corner.x, corner.y, corner.z),
           "finite coordinates");
  }
  return corner;
}

std::vector<Facet> read_binary(std::string_view content) {
  std::uint32_t count = 0;
  std::memcpy(&count, content.data() + header_size, sizeof count);
  check_count(count);
  std::vector<Facet> facets(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    float numbers[12];
    std::memcpy(numbers, content.data() + header_size + sizeof count + t * facet_size, sizeof numbers);
    const auto vector = [&](int first) {
      return Vec3{numbers[first], numbers[first + 1], numbers[first + 2]};
    };
    facets[t].normal = vector(0);
    for (int i = 0; i < 3; ++i) {
      facets[t].corner[static_cast<std::size_t>(i)] =
          checked_corner(vector(3 + 3 * i), fmt::format("triangle {}", t + 1));
    }
  }
  return facets;
}

/// The words of an ASCII file, one after the other.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  /// Empty at the end.
  std::string_view next() {
    while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_.front())) != 0) {
      line_ += rest_.front() == '\n' ? 1 : 0;
      rest_.remove_prefix(1);
    }
    std::size_t size = 0;
    while (size < rest_.size() && std::isspace(static_cast<unsigned char>(rest_[size])) == 0) ++size;
    const std::string_view word = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return word;
  }
  void skip_line() {
    const std::size_t end = rest_.find('\n');
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end);
  }
  bool at_end() const { return rest_.empty(); }
  std::string place() const { return fmt::format("line {}", line_); }

 private:
  std::string_view rest_;
  std::int64_t line_ = 1;
};

bool is_word(std::string_view word, std::string_view expected) {
  return std::equal(word.begin(), word.end(), expected.begin(), expected.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

void expect(Words& words, std::string_view expected) {
  const std::string_view word = words.next();
  // The end may come within a word.
  const bool cut =
      words.at_end() && word.size() < expected.size() && is_word(word, expected.substr(0, word.size()));
  if (cut) refuse(fmt::format("{}: the file ends within a facet, it is truncated", words.place()));
  if (!is_word(word, expected)) {
    refuse(fmt::format("{}: \"{}\" where \"{}\" is expected", words.place(), word.substr(0, 40), expected));
  }
}

Vec3 read_vector(Words& words) {
  Vec3 v;
  for (int axis = 0; axis < 3; ++axis) {
    std::string_view word = words.next();
    if (word.empty()) refuse(fmt::format("{}: the file ends within a facet, it is truncated", words.place()));
    if (word.front() == '+') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), v[axis]);
    // A number too small for a double is zero for every purpose.
    if (error == std::errc::result_out_of_range) continue;
    if (error != std::errc{} || end != word.data() + word.size()) {
      refuse(fmt::format("{}: \"{}\" is no number", words.place(), word.substr(0, 40)), "a number");
    }
  }
  return v;
}

std::vector<Facet> read_ascii(std::string_view content) {
  std::vector<Facet> facets;
  Words words(content);
  expect(words, "solid");
  words.skip_line();  // its name
  for (;;) {
    const std::string_view word = words.next();
    if (word.empty()) refuse(fmt::format("{}: there is no endsolid, the file is truncated", words.place()));
    if (is_word(word, "endsolid")) {
      words.skip_line();
      const std::string_view more = words.next();
      if (more.empty()) return facets;
      if (!is_word(more, "solid")) {
        refuse(fmt::format("{}: \"{}\" after the end of the solid", words.place(), more.substr(0, 40)));
      }
      words.skip_line();
      continue;
    }
    if (words.at_end() && !is_word(word, "facet")) {
      refuse(fmt::format("{}: the file ends before endsolid, it is truncated", words.place()));
    }
    if (!is_word(word, "facet")) {
      refuse(fmt::format("{}: \"{}\" where \"facet\" or \"endsolid\" is expected", words.place(),
                         word.substr(0, 40)));
    }
    Facet facet;
    expect(words, "normal");
    facet.normal = read_vector(words);
    expect(words, "outer");
    expect(words, "loop");
    for (Vec3& corner : facet.corner) {
      expect(words, "vertex");
      corner = read_vector(words);
      checked_corner(corner, words.place());
    }
    expect(words, "endloop");
    expect(words, "endfacet");
    facets.push_back(facet);
    check_count(static_cast<std::int64_t>(facets.size()));
  }
}

/// Bytes that no text holds.
bool looks_binary(std::string_view content) {
  return content.substr(0, 1024).find('\0') != std::string_view::npos;
}

std::vector<Facet> read_facets(std::string_view content) {
  if (content.empty()) refuse("the file is empty");
  const std::size_t first = content.find_first_not_of(" \t\r\n");
  const bool solid = first != std::string_view::npos && is_word(content.substr(first, 5), "solid");
  if (content.size() >= header_size + 4) {
    std::uint32_t count = 0;
    std::memcpy(&count, content.data() + header_size, sizeof count);
    const std::size_t size = header_size + 4 + std::size_t{count} * facet_size;
    // Some programs begin the header of a binary file with "solid": the size decides.
    if (content.size() == size) return read_binary(content);
    if (looks_binary(content)) {
      check_count(count);
      refuse(
          fmt::format("it is no STL file, or not all of one: its header announces {} triangles, which "
                      "take {} bytes, but it has {}",
                      count, size, content.size()));
    }
  } else if (looks_binary(content)) {
    refuse(fmt::format("it has {} bytes, fewer than the header of a binary STL file: no STL, or truncated",
                       content.size()));
  }
  if (!solid) refuse("it is no STL file: it neither begins with \"solid\" nor has the size of a binary one");
  return read_ascii(content);
}

}  // namespace

TriangleMesh parse_stl(std::string_view content, Real scale, MeshReport& report) {
  std::vector<Facet> facets = read_facets(content);
  for (Facet& facet : facets) {
    for (Vec3& corner : facet.corner) corner *= scale;
  }
  TriangleMesh mesh = weld_facets(facets, report);
  if (mesh.triangles.empty()) {
    refuse(facets.empty() ? "it has no triangles" : "none of its triangles has an area",
           "at least one triangle");
  }
  return mesh;
}

namespace {

/// Refuses a file that is none, or too large to be read, from its size and the header of a binary file.
void check_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) refuse("it cannot be read", "a file that is there");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::array<char, header_size + 4> header{};
  std::uint32_t count = 0;
  if (std::ifstream(path, std::ios::binary).read(header.data(), header.size())) {
    std::memcpy(&count, header.data() + header_size, sizeof count);
    if (size == header.size() + std::uintmax_t{count} * facet_size) check_count(count);
  }
  if (size > most_bytes) refuse(fmt::format("it has {} bytes", size), fmt::format("at most {}", most_bytes));
}

}  // namespace

TriangleMesh read_stl(const std::filesystem::path& path, Real scale, MeshReport& report) {
  check_file(path);
  std::string content;
  try {
    content = core::read_file(path);
  } catch (const RunError&) {
    refuse("it cannot be read", "a file that is there");
  }
  return parse_stl(content, scale, report);
}

}  // namespace pellicle::dem
