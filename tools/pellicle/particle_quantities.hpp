// One number of one particle, on the device and on the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"
#include "dem/particles.hpp"
#include "tools/pellicle/output_fields.hpp"
#include "tools/pellicle/particle_columns.hpp"

namespace pellicle::tools {

/// Value of particle_quantities[quantity] (output_fields.hpp).
KOKKOS_INLINE_FUNCTION Real particle_quantity(int quantity, const ParticleSample& particle) {
  const dem::PositionRadius& place = particle.position_radius;
  const dem::VelocitySpin& motion = particle.velocity_spin;
  switch (quantity) {
    case 0:
      return motion.vx;
    case 1:
      return motion.vy;
    case 2:
      return motion.vz;
    case 3:
      return Kokkos::sqrt(norm_squared(motion.velocity()));
    case 4:
      return motion.wx;
    case 5:
      return motion.wy;
    case 6:
      return motion.wz;
    case 7:
      return place.x;
    case 8:
      return place.y;
    case 9:
      return place.z;
    case 10:
      return 2 * place.radius;
    case 11:
      return particle.mass;
    case 12:
      return 0.5 * particle.mass * norm_squared(motion.velocity());
    case 13:
      return particle.acceleration.z;
    case 14:
      return particle.temperature;
    case 15:
      return particle.film.liquid;
    case 16:
      return particle.film.solids;
    case 17:
      return particle.coating_thickness();
    case 18:
      return static_cast<Real>(particle.hit.hits);
    case 19:
      return particle.hit.first_hit;
    default:
      return particle.hit.last_hit;
  }
}
static_assert(particle_quantities.size() == 21 && particle_quantities[3].name == "particle_speed" &&
                  particle_quantities[7].name == "particle_position_x" &&
                  particle_quantities[12].name == "particle_kinetic_energy" &&
                  particle_quantities[17].name == "coating_thickness" &&
                  particle_quantities[20].name == "last_hit_time",
              "the codes above are positions in particle_quantities");

/// Rows of the particles' arrays in the order of their ids.
using RowOrder = std::shared_ptr<const std::vector<std::int32_t>>;

/// One column of the particles as seen by the host, in the order of their ids. Where the device is the host it is the
/// particles' own memory, read in another order: a copy of millions of particles would double what they take.
template <class T>
class HostColumn {
 public:
  HostColumn() = default;
  HostColumn(const DeviceArray<T>& column, RowOrder order)
      : values_(Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), column)), order_(std::move(order)) {}
  // NOLINTNEXTLINE(google-explicit-constructor): columns of numbers that are at hand
  HostColumn(std::initializer_list<T> values) : values_("tools::host_column::values", values.size()) {
    auto order = std::make_shared<std::vector<std::int32_t>>();
    for (const T& value : values) {
      values_(order->size()) = value;
      order->push_back(static_cast<std::int32_t>(order->size()));
    }
    order_ = std::move(order);
  }

  std::size_t size() const { return order_ ? order_->size() : 0; }
  bool empty() const { return size() == 0; }
  const T& operator[](std::size_t n) const { return values_((*order_)[n]); }

 private:
  Kokkos::View<T*, Kokkos::HostSpace> values_;
  RowOrder order_;
};

/// The particles as outputs on the host see them, in the order of their ids. Columns that the case has not are empty.
/// To be used before the particles change.
struct HostParticles {
  HostColumn<dem::PositionRadius> position_radius;
  HostColumn<dem::VelocitySpin> velocity_spin;
  HostColumn<Real> mass;
  HostColumn<dem::Vec3f> acceleration;
  HostColumn<Real> temperature;
  HostColumn<heat::Film> film;
  HostColumn<spray::HitRecord> hits;
  Real solids_density = 1;
  bool radius_grows = false;
  std::size_t count() const { return mass.size(); }
  ParticleSample sample(std::size_t p) const;
};

/// Particles in the order of their ids.
HostParticles copy_to_host(const ParticleColumns& columns);

}  // namespace pellicle::tools
