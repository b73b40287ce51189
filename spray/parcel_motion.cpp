#include "spray/parcel_motion.hpp"

#include "core/random.hpp"

namespace pellicle::spray {
namespace {

/// A bouncing droplet is left so far from the particle, as a share of the sum of radii, that rounding does not put it
/// inside.
constexpr Real lift_off = 1e-6;

/// What of a path matters to a search.
struct Path {
  Vec3 start;   ///< [m]
  Vec3 way;     ///< [m]
  Real radius;  ///< of the droplet [m]
  Real late;    ///< after the beginning of the move, when it starts [s]
  Real dt;      ///< over which it goes [s]
};

/// A droplet's drag during a move.
struct Drag {
  Vec3 velocity;      ///< of the droplet when the move begins [m/s]
  Vec3 gas_velocity;  ///< [m/s]
  Real rate;          ///< at which it loses its slip [1/s]
  Index cell;         ///< whose gas it is; -1: no gas
  DragGas gas;        ///< that of the cell
  Real slip;          ///< [m/s]
  Real mass;          ///< of the parcel [kg]
};

struct Touch {
  Real share = never;
  std::int32_t id = 0;
  Index particle = -1;
};

template <bool Repeats>
struct MoveParcel {
  ParcelMove m;

  KOKKOS_INLINE_FUNCTION void operator()(const Index i) const {
    const ParcelEnd before = m.parcels.end(i);
    if (before.fate != ParcelFate::flying || before.time >= m.end) return;
    ParcelState parcel = m.parcels.state(i);
    const NozzleView& nozzle = m.nozzle(m.parcels.name(i).nozzle);
    const Real start = Kokkos::max(before.time, m.begin);
    const Real dt = m.end - start;

    const Drag drag = drag_on(parcel, nozzle, i);
    const DropletStep step = move_droplet(parcel.velocity, drag.gas_velocity, drag.rate, m.gravity, dt);
    const Path path{parcel.position, step.path, 0.5 * parcel.diameter, start - m.begin, dt};

    const Touch touch = find_touch(path);
    const Real wall = first_wall(path.start, path.way);
    const Real side = leaves_at(path);
    parcel.velocity = step.velocity;
    // At the same moment a particle is met before a wall, and a wall before the side that it may be.
    ParcelEnd after;
    Real share = 1;
    bool booked = false;
    if (touch.share <= 1 && touch.share <= wall && touch.share <= side) {
      share = touch.share;
      if (wall_between(touch, path)) {
        after.fate = ParcelFate::wall_loss;
      } else if (stays(touch, path, parcel, nozzle, i)) {
        after.fate = ParcelFate::captured;
        after.particle = touch.particle;
      } else {
        book_drag(parcel, drag, dt);
        booked = true;
        const Vec3 arriving = parcel.velocity;
        bounce(touch, path, parcel, after);
        book_bounce(parcel, nozzle, i, drag.cell, touch.particle, arriving);
        if (after.fate == ParcelFate::flying) {
          evaporate(i, parcel, nozzle, drag, dt, after);
          m.parcels.state(i) = parcel;
          finish(i, after, m.end);
          return;
        }
      }
    } else if (wall <= 1 && wall <= side * (1 + 1e-9) + 1e-12) {
      share = wall;
      after.fate = ParcelFate::wall_loss;
    } else if (side <= 1) {
      share = side;
      after.fate = ParcelFate::overspray;
    }
    if (!booked) book_drag(parcel, drag, share * dt);
    evaporate(i, parcel, nozzle, drag, share * dt, after);
    parcel.position = wrapped(parcel.position + share * path.way);
    m.parcels.state(i) = parcel;
    finish(i, after, start + share * dt);
  }

 private:
  KOKKOS_INLINE_FUNCTION void finish(Index i, ParcelEnd& after, Real time) const {
    if (after.fate == ParcelFate::flying) return;
    after.time = time;
    m.parcels.end(i) = after;
  }

  KOKKOS_INLINE_FUNCTION Drag drag_on(const ParcelState& parcel, const NozzleView& nozzle, Index i) const {
    Drag drag{parcel.velocity, {0, 0, 0}, 0, -1, {}, 0, 0};
    if (!(m.gas.drag.viscosity > 0)) return drag;
    drag.cell = m.gas.cell_of(parcel.position);
    drag.gas = m.gas.drag_in(drag.cell);
    drag.gas_velocity = m.gas.velocity(drag.cell);
    drag.slip = Kokkos::sqrt(norm_squared(drag.gas_velocity - parcel.velocity));
    drag.mass = mass_of(m.parcels, i, nozzle, m.units);
    drag.rate = relaxation_rate(drag.gas, density_of(parcel, nozzle, i), parcel.diameter, drag.slip);
    return drag;
  }

  /// Of the droplets [kg/m3]; what evaporates gets as dense as its solids.
  KOKKOS_INLINE_FUNCTION Real density_of(const ParcelState& parcel, const NozzleView& nozzle, Index i) const {
    return m.parcels.evaporate ? mass_of(m.parcels, i, nozzle, m.units) / volume_of(parcel) : nozzle.density;
  }

  /// What the parcel exchanges with the gas of its cell over `time` [s], in whole units: both sides book the same number.
  KOKKOS_INLINE_FUNCTION void evaporate(Index i, ParcelState& parcel, const NozzleView& nozzle,
                                        const Drag& drag, Real time, ParcelEnd& after) const {
    if (!m.parcels.evaporate || !(time > 0)) return;
    const WholeUnits& unit = m.units;
    const DropletHeat& law = m.gas.heat;
    ParcelWater water = m.parcels.water(i);
    const std::int64_t all = nozzle.liquid_units;
    const bool was_dry = water.evaporated >= all;
    const heat::Film content = content_of(nozzle, water, unit.water);
    const Real warmth =
        unit.heat * static_cast<Real>(water.enthalpy) / law.capacity(content.liquid, content.solids);
    const DropletExchange got =
        exchange_of(law, {content.liquid, content.solids, warmth, parcel.diameter, parcel.droplets},
                    {drag.gas.density, drag.gas.viscosity, m.gas.temperature(drag.cell) - law.water.reference,
                     m.gas.vapour(drag.cell)},
                    drag.slip, time);
    const std::int64_t left = all - water.evaporated;
    std::int64_t evaporated = Kokkos::min(whole(got.evaporated / unit.water), left);
    // Of droplets without solids the last goes at once: of less than this the units of heat would make no temperature.
    const bool vanishes =
        !(content.solids > 0) && left - evaporated < Kokkos::min(std::int64_t{1} << 16, all / 1024);
    if (vanishes) evaporated = left;
    const Real mass = unit.water * static_cast<Real>(evaporated);
    const std::int64_t latent = whole(law.water.latent * mass / unit.heat);
    // What vanishes leaves all its heat to the gas.
    const std::int64_t to_gas =
        vanishes ? water.enthalpy - latent
                 : whole((mass * law.water.vapour_capacity * warmth - got.heat) / unit.heat);
    water.evaporated += evaporated;
    water.enthalpy -= to_gas + latent;
    m.parcels.water(i) = water;
    VapourGains& gains = m.gas.vapour_gains(drag.cell);
    Kokkos::atomic_add(&gains.vapour, evaporated);
    Kokkos::atomic_add(&gains.heat, to_gas);
    Kokkos::atomic_add(&gains.reach, whole(got.reach / unit.mass));
    for (int axis = 0; axis < 3; ++axis)
      Kokkos::atomic_add(&gains.momentum[axis], whole(mass * parcel.velocity[axis] / unit.impulse));
    if (!was_dry && water.evaporated >= all) Kokkos::atomic_inc(&m.dried(m.parcels.name(i).nozzle));
    if (vanishes) {
      if (after.fate == ParcelFate::flying) after.fate = ParcelFate::evaporated;
      return;
    }
    // Volumes add up.
    const Real shrunk = unit.water * static_cast<Real>(water.evaporated) / nozzle.liquid_density;
    const Real volume = nozzle.parcel_mass / nozzle.density - shrunk;
    parcel.diameter = Kokkos::cbrt(volume / (3.14159265358979323846 / 6 * parcel.droplets));
  }

  /// Where droplets push the gas: gives it the opposite of the drag's impulse over `time` [s], in whole units, and the
  /// droplet the velocity that it has by the same number.
  KOKKOS_INLINE_FUNCTION void book_drag(ParcelState& parcel, const Drag& drag, Real time) const {
    if (!m.gas.gains.is_on()) return;
    const Real mass = drag.mass;
    const Vec3 fallen = time * m.gravity;
    const DropletStep step = move_droplet(drag.velocity, drag.gas_velocity, drag.rate, m.gravity, time);
    const Vec3 impulse = m.gas.gains.take_impulse(drag.cell, mass * (step.velocity - drag.velocity - fallen));
    parcel.velocity = drag.velocity + fallen + (1 / mass) * impulse;
    m.gas.gains.book_flight(drag.cell, mass, time, -Kokkos::expm1(-drag.rate * time));
  }

  /// Books the impulse of a bounce in whole units: the droplet has it, and the particle the opposite if droplets push
  /// particles.
  KOKKOS_INLINE_FUNCTION void book_bounce(ParcelState& parcel, const NozzleView& nozzle, Index i, Index cell,
                                          Index particle, const Vec3& arriving) const {
    if (!m.gas.gains.is_on() && !m.pushes.is_on()) return;
    const Real mass = mass_of(m.parcels, i, nozzle, m.units);
    Vec3 impulse = mass * (parcel.velocity - arriving);
    if (m.gas.gains.is_on()) impulse = m.gas.gains.book_bounce(cell, impulse);
    if (m.pushes.is_on()) impulse = -m.pushes.push(particle, -impulse);
    parcel.velocity = arriving + (1 / mass) * impulse;
  }

  KOKKOS_INLINE_FUNCTION Vec3 velocity_of(Index p) const {
    const dem::VelocitySpin& motion = m.targets.particles.velocity_spin(p);
    return motion.inverse_mass != 0 ? motion.velocity() : Vec3{0, 0, 0};
  }

  /// The first particle that the path touches, of several at the same moment that with the lowest id.
  KOKKOS_INLINE_FUNCTION Touch find_touch(const Path& path) const {
    const ParcelTargets& targets = m.targets;
    Touch first;
    if (targets.particles.count == 0) return first;
    const Vec3 middle = path.start + 0.5 * path.way;
    const Real reach = 0.5 * Kokkos::sqrt(norm_squared(path.way)) + path.radius +
                       (path.late + path.dt) * targets.largest_speed;
    dem::visit_runs<Repeats>(
        targets.cells, targets.cell_start, dem::PositionRadius{middle.x, middle.y, middle.z, reach},
        [&](std::int32_t begin, std::int32_t end) {
          for (std::int32_t slot = begin; slot < end; ++slot) {
            const Index p = targets.order(slot);
            const dem::PositionRadius place = targets.particles.position_radius(p);
            Vec3 apart = middle - place.position();
            if (Repeats) apart = m.domain.shortest(apart);
            const Real near = reach + place.radius;
            if (norm_squared(apart) > near * near) continue;
            // As the particle sees it: it was where it is when the move began, and goes on meanwhile.
            const Vec3 velocity = velocity_of(p);
            const Vec3 start = apart - 0.5 * path.way - path.late * velocity;
            const Real share = first_touch(start, path.way - path.dt * velocity, place.radius + path.radius);
            if (share > 1 || share > first.share) continue;
            const std::int32_t id = targets.particles.velocity_spin(p).id;
            if (share < first.share || id < first.id) first = Touch{share, id, p};
          }
        });
    return first;
  }

  /// Beyond a periodic side a path goes on at the other.
  KOKKOS_INLINE_FUNCTION Real first_wall(const Vec3& start, const Vec3& way) const {
    const Vec3 end = start + way;
    Real first = first_wall_crossing(m.walls, start, end);
    if (!Repeats) return first;
    const Vec3 inside = wrapped(end);
    if (inside == end) return first;
    return Kokkos::min(first, first_wall_crossing(m.walls, start + (inside - end), inside));
  }

  KOKKOS_INLINE_FUNCTION Vec3 wrapped(Vec3 place) const {
    if (!Repeats) return place;
    const Vec3 length = m.domain.length();
    for (int axis = 0; axis < 3; ++axis) {
      if (m.domain.periodic[axis] == 0) continue;
      if (place[axis] < m.domain.box.min[axis]) place[axis] += length[axis];
      if (place[axis] >= m.domain.box.max[axis]) place[axis] -= length[axis];
    }
    return place;
  }

  /// Share of the path at which it leaves the domain, or `never`.
  KOKKOS_INLINE_FUNCTION Real leaves_at(const Path& path) const {
    Real first = never;
    for (int axis = 0; axis < 3; ++axis) {
      if (m.domain.periodic[axis] != 0) continue;
      const Real end = path.start[axis] + path.way[axis];
      const Real low = m.domain.box.min[axis];
      const Real high = m.domain.box.max[axis];
      if (end >= low && end <= high) continue;
      const Real way = path.way[axis];
      const Real share = way != 0 ? ((end < low ? low : high) - path.start[axis]) / way : Real(0);
      first = Kokkos::min(first, Kokkos::max(share, Real(0)));
    }
    return first;
  }

  /// Vector [m] from the particle's centre to the droplet's at the moment of touch.
  KOKKOS_INLINE_FUNCTION Vec3 from_centre(const Touch& touch, const Path& path) const {
    const Vec3 centre = m.targets.particles.position_radius(touch.particle).position();
    const Vec3 apart = path.start + touch.share * path.way - centre -
                       (path.late + touch.share * path.dt) * velocity_of(touch.particle);
    return Repeats ? m.domain.shortest(apart) : apart;
  }

  /// Whether a wall stands between a droplet and the particle that it touches: soft particles reach a little through thin
  /// walls, and so do droplets that come close to them. Such a droplet touches the wall.
  KOKKOS_INLINE_FUNCTION bool wall_between(const Touch& touch, const Path& path) const {
    return first_wall(path.start + touch.share * path.way, -from_centre(touch, path)) <= 1;
  }

  /// Whether a droplet that touches a particle stays there.
  KOKKOS_INLINE_FUNCTION bool stays(const Touch& touch, const Path& path, const ParcelState& parcel,
                                    const NozzleView& nozzle, Index i) const {
    if (nozzle.efficiency.points == 0) return true;
    const Vec3 apart = from_centre(touch, path);
    const Real distance = Kokkos::sqrt(norm_squared(apart));
    const Real normal_speed =
        distance > 0 ? -dot(parcel.velocity - velocity_of(touch.particle), apart) / distance : Real(0);
    const Real weber = weber_number(density_of(parcel, nozzle, i), normal_speed, parcel.diameter,
                                    nozzle.efficiency.surface_tension);
    const ParcelName name = m.parcels.name(i);
    const Real draw = core::random_uniform(m.seed, core::Purpose::capture, name.number, name.nozzle,
                                           static_cast<std::uint32_t>(m.substep % (std::int64_t{1} << 16)));
    return draw < nozzle.efficiency(weber);
  }

  /// Throws the droplet back from the particle like a mirror, and leaves it on the particle's surface for the rest of the
  /// move, unless a wall is in between.
  KOKKOS_INLINE_FUNCTION void bounce(const Touch& touch, const Path& path, ParcelState& parcel,
                                     ParcelEnd& after) const {
    const Vec3 apart = from_centre(touch, path);
    const Real distance = Kokkos::sqrt(norm_squared(apart));
    const Vec3 normal = distance > 0 ? (1 / distance) * apart : Vec3{0, 0, 1};
    const Vec3 velocity = velocity_of(touch.particle);
    const Real approach = dot(parcel.velocity - velocity, normal);
    if (approach < 0) parcel.velocity -= (2 * approach) * normal;
    const Real sum = m.targets.particles.position_radius(touch.particle).radius + path.radius;
    const Vec3 centre = path.start + touch.share * path.way - apart;  // of the particle, then
    const Vec3 end = centre + ((1 - touch.share) * path.dt) * velocity + ((1 + lift_off) * sum) * normal;
    const Real wall = first_wall(path.start, end - path.start);
    const Real side = leaves_at({path.start, end - path.start, path.radius, path.late, path.dt});
    if (wall <= 1) after.fate = ParcelFate::wall_loss;
    if (side <= 1 && side < wall) after.fate = ParcelFate::overspray;
    parcel.position = wrapped(end);
  }
};

}  // namespace

void move_parcels(const ParcelMove& move) {
  // Parcels near particles cost more than others: threads take them as they come.
  const Kokkos::RangePolicy<Device, Kokkos::Schedule<Kokkos::Dynamic>> range(0, move.parcels.count,
                                                                             Kokkos::ChunkSize(64));
  if (move.domain.repeats()) {
    Kokkos::parallel_for("spray::parcel_motion::move_periodic", range, MoveParcel<true>{move});
  } else {
    Kokkos::parallel_for("spray::parcel_motion::move", range, MoveParcel<false>{move});
  }
}

ParticleBounds find_bounds(const dem::Particles& particles) {
  if (particles.count == 0) return {};
  const auto motion = particles.velocity_spin;
  const auto place = particles.position_radius;
  Real largest = 0;
  Real smallest = 0;
  Kokkos::parallel_reduce(
      "spray::parcel_motion::find_bounds", DeviceRange(0, particles.count),
      KOKKOS_LAMBDA(const Index p, Real& most, Real& least) {
        const dem::VelocitySpin& v = motion(p);
        if (v.inverse_mass != 0) most = Kokkos::max(most, v.vx * v.vx + v.vy * v.vy + v.vz * v.vz);
        least = Kokkos::min(least, place(p).radius);
      },
      Kokkos::Max<Real>(largest), Kokkos::Min<Real>(smallest));
  return {largest > 0 ? Kokkos::sqrt(largest) : 0, smallest};
}

Real largest_parcel_speed(const Parcels& parcels) {
  const auto state = parcels.state;
  Real largest = 0;
  Kokkos::parallel_reduce(
      "spray::parcel_motion::largest_parcel_speed", DeviceRange(0, parcels.count),
      KOKKOS_LAMBDA(const Index i, Real& most) { most = Kokkos::max(most, norm_squared(state(i).velocity)); },
      Kokkos::Max<Real>(largest));
  return largest > 0 ? Kokkos::sqrt(largest) : 0;
}

}  // namespace pellicle::spray
