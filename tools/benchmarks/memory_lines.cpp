// What memory gives one thread: the rate of a triad, and what a cache line costs when lines are read in order, in an order
// that the processor cannot foresee (shuffled within 32 KB, as the particles of a block are met), the same but asked for
// 32 KB ahead, and in random order. CPU time of the best of five.
//
//   build/release/memory_lines

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace {

constexpr std::size_t line_bytes = 64;
constexpr std::size_t group = 32768 / line_bytes;  // lines that are shuffled among each other

struct alignas(line_bytes) Line {
  std::int64_t number[line_bytes / sizeof(std::int64_t)];
};

/// [ns] for each of `count` items.
template <class Work>
double time_each(std::size_t count, const Work& work) {
  double best = std::numeric_limits<double>::max();
  for (int k = 0; k < 5; ++k) {
    const std::clock_t begin = std::clock();
    work();
    best = std::min(best, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return 1e9 * best / static_cast<double>(count);
}

void time_triad(std::size_t megabytes) {
  const std::size_t n = megabytes * 1000000 / 24;
  std::vector<double> a(n, 0);
  const std::vector<double> b(n, 1);
  const std::vector<double> c(n, 2);
  const double each = time_each(n, [&] {
    for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + 3 * c[i];
  });
  std::printf("%4zu MB: triad %.1f GB/s, %.1f with what is fetched to be written over\n", megabytes,
              24 / each, 32 / each);
}

/// The lines in an order; without `ahead`, none is asked for before its turn.
std::int64_t add_up(const std::vector<Line>& lines, const std::vector<std::uint32_t>& order,
                    std::size_t ahead) {
  std::int64_t sum = 0;
  const std::size_t last = lines.size() - 1;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (ahead > 0) __builtin_prefetch(&lines[std::min(k + ahead, last)]);
    sum += lines[order[k]].number[0];
  }
  return sum;
}

void time_lines(std::size_t megabytes) {
  const std::vector<Line> lines(megabytes * 1000000 / line_bytes, Line{{1}});
  std::vector<std::uint32_t> order(lines.size());
  std::iota(order.begin(), order.end(), 0U);
  std::mt19937 random(1);
  std::int64_t sum = 0;
  const auto each = [&](std::size_t ahead) {
    return time_each(lines.size(), [&] { sum += add_up(lines, order, ahead); });
  };
  const double in_order = each(0);
  for (std::size_t first = 0; first < order.size(); first += group) {
    const std::size_t end = std::min(first + group, order.size());
    std::shuffle(order.begin() + static_cast<std::ptrdiff_t>(first),
                 order.begin() + static_cast<std::ptrdiff_t>(end), random);
  }
  const double shuffled = each(0);
  const double asked_for = each(group);
  std::shuffle(order.begin(), order.end(), random);
  const double anywhere = each(0);
  std::printf("%4zu MB: a line %.1f ns in order, %.1f shuffled, %.1f asked for ahead, %.1f random%s\n",
              megabytes, in_order, shuffled, asked_for, anywhere, sum == 0 ? " (wrong sum)" : "");
}

}  // namespace

int main() {
  for (const std::size_t megabytes : {std::size_t{12}, std::size_t{50}, std::size_t{500}}) {
    time_triad(megabytes);
    time_lines(megabytes);
  }
  return 0;
}
