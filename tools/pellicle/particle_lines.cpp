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
  DeviceArray<std::int64_t> samples;
  DeviceArray<Real> sum, square;

  KOKKOS_INLINE_FUNCTION void operator()(Index bin) const {
    std::int64_t count = 0;
    Real first = 0, second = 0;
    for (Index h = 0; h < hits; ++h) {
      if (hit_bin(h) != bin) continue;
      ++count;
      first += hit_value(h);
      second += hit_value(h) * hit_value(h);
    }
    samples(bin) += count;
    sum(bin) += first;
    square(bin) += second;
  }
};

template <class T>
void copy_out(const DeviceArray<T>& from, std::vector<T>& to) {
  to.resize(from.extent(0));
  Kokkos::deep_copy(Kokkos::View<T*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>(to.data(), to.size()), from);
}

template <class T>
void copy_in(const std::vector<T>& from, const DeviceArray<T>& to) {
  Kokkos::deep_copy(
      to, Kokkos::View<const T*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged>(from.data(), from.size()));
}

}  // namespace

ParticleLine::ParticleLine(const LineGeometry& line, int quantity)
    : line_(line),
      quantity_(quantity),
      samples_("tools::particle_lines::samples", static_cast<std::size_t>(line.points)),
      sum_("tools::particle_lines::sum", static_cast<std::size_t>(line.points)),
      square_("tools::particle_lines::square", static_cast<std::size_t>(line.points)) {}

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
                       AddHits{hits, hit_bin_, hit_value_, samples_, sum_, square_});
}

BinSums ParticleLine::sums() const {
  BinSums sums;
  copy_out(samples_, sums.samples);
  copy_out(sum_, sums.sum);
  copy_out(square_, sums.square);
  return sums;
}

void ParticleLine::set_sums(const BinSums& sums) {
  copy_in(sums.samples, samples_);
  copy_in(sums.sum, sum_);
  copy_in(sums.square, square_);
}

}  // namespace pellicle::tools
