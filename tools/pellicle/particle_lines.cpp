#include "tools/pellicle/particle_lines.hpp"

#include "tools/pellicle/particle_quantities.hpp"

namespace pellicle::tools {

namespace {

struct FindBins {
  LineGeometry line;
  DeviceArray<const dem::PositionRadius> position_radius;
  DeviceArray<Index> bin_of;

  KOKKOS_INLINE_FUNCTION void operator()(Index p) const {
    bin_of(p) = line.bin(position_radius(p).position());
  }
};

/// Lists the particles that lie in a bin of the line, in their order. A scan visits each particle twice: so it reads
/// one number that FindBins has left, three times as fast as finding the bin again.
struct ListHits {
  int quantity;
  DeviceArray<const Index> bin_of;
  ParticleColumns particles;
  DeviceArray<Index> hit_bin;
  DeviceArray<Real> hit_value;

  KOKKOS_INLINE_FUNCTION void operator()(Index p, Index& hits, bool final) const {
    const Index bin = bin_of(p);
    if (bin < 0) return;
    if (final) {
      hit_bin(hits) = bin;
      hit_value(hits) = particle_quantity(quantity, particles(p));
    }
    ++hits;
  }
};

/// Adds the listed particles to their bins, one thread a bin.
struct AddHits {
  Index hits;
  DeviceArray<const Index> hit_bin;
  DeviceArray<const Real> hit_value;
  DeviceArray<core::RunningMoments> moments;

  KOKKOS_INLINE_FUNCTION void operator()(Index bin) const {
    core::RunningMoments of_bin = moments(bin);
    for (Index h = 0; h < hits; ++h) {
      if (hit_bin(h) == bin) of_bin.add(hit_value(h));
    }
    moments(bin) = of_bin;
  }
};

}  // namespace

ParticleLine::ParticleLine(const LineGeometry& line, int quantity)
    : line_(line),
      quantity_(quantity),
      moments_("tools::particle_lines::moments", static_cast<std::size_t>(line.points)) {}

void ParticleLine::add(const ParticleColumns& columns) {
  const dem::Particles& particles = columns.particles;
  if (particles.count == 0) return;
  if (hit_bin_.extent(0) < static_cast<std::size_t>(particles.count)) {
    // As long as all particles: whatever moves into the line, nothing is allocated in a later step.
    const auto size = particles.position_radius.extent(0);
    using Kokkos::view_alloc, Kokkos::WithoutInitializing;
    bin_of_ = DeviceArray<Index>(view_alloc("tools::particle_lines::bin_of", WithoutInitializing), size);
    hit_bin_ = DeviceArray<Index>(view_alloc("tools::particle_lines::hit_bin", WithoutInitializing), size);
    hit_value_ = DeviceArray<Real>(view_alloc("tools::particle_lines::hit_value", WithoutInitializing), size);
  }
  const DeviceRange all(0, particles.count);
  Kokkos::parallel_for("tools::particle_lines::find_bins", all,
                       FindBins{line_, particles.position_radius, bin_of_});
  Index hits = 0;
  Kokkos::parallel_scan("tools::particle_lines::list_hits", all,
                        ListHits{quantity_, bin_of_, columns, hit_bin_, hit_value_}, hits);
  if (hits == 0) return;
  Kokkos::parallel_for("tools::particle_lines::add_hits", DeviceRange(0, line_.points),
                       AddHits{hits, hit_bin_, hit_value_, moments_});
}

std::vector<core::RunningMoments> ParticleLine::moments() const {
  std::vector<core::RunningMoments> moments(moments_.extent(0));
  Kokkos::deep_copy(Kokkos::View<core::RunningMoments*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>(
                        moments.data(), moments.size()),
                    moments_);
  return moments;
}

void ParticleLine::set_moments(const std::vector<core::RunningMoments>& moments) {
  Kokkos::deep_copy(moments_,
                    Kokkos::View<const core::RunningMoments*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>(
                        moments.data(), moments.size()));
}

}  // namespace pellicle::tools
