#include "dem/wall_contacts.hpp"

namespace pellicle::dem {

template <class Tangential>
void run_wall_contacts(const WallInput& walls, const ContactInput& input, const Tangential& tangential,
                       const ContactOptions& options, const ContactResult& result);

namespace {

KOKKOS_INLINE_FUNCTION void add_report(WallReport& sum, const WallReport& r) {
  sum.include(r);
  sum.impulse += r.impulse;
  sum.angular_impulse += r.angular_impulse;
  sum.touching += r.touching;
  sum.bridges += r.bridges;
  sum.crowded += r.crowded;
}

}  // namespace

void add_wall_contacts(const WallInput& walls, const ContactInput& input, const ContactOptions& options,
                       const ContactResult& result) {
  if (walls.geometry.body.extent(0) == 0) return;
  std::visit([&](const auto& tangential) { run_wall_contacts(walls, input, tangential, options, result); },
             options.tangential);
}

std::vector<WallReport> collect_wall_reports(const DeviceArray<WallReport>& report,
                                             const DeviceArray<WallReport>& scratch) {
  const auto walls = static_cast<Index>(report.extent(0)) / wall_blocks;
  std::vector<WallReport> sums(static_cast<std::size_t>(walls));
  if (walls == 0) return sums;
  constexpr Index blocks = wall_blocks / report_parts;
  Kokkos::parallel_for(
      "dem::wall_contacts::collect", DeviceRange(0, report_parts * walls), KOKKOS_LAMBDA(const Index item) {
        const Index part = item / walls;
        const Index wall = item % walls;
        WallReport sum;
        for (Index b = part * blocks; b < (part + 1) * blocks; ++b) {
          add_report(sum, report(b * walls + wall));
          report(b * walls + wall) = WallReport{};
        }
        scratch(item) = sum;
      });
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, scratch);
  for (Index item = 0; item < report_parts * walls; ++item)
    add_report(sums[static_cast<std::size_t>(item % walls)], host(item));
  return sums;
}

}  // namespace pellicle::dem
