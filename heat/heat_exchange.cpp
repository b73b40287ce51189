#include "heat/heat_exchange.hpp"

#include <string>

#include "core/checkpoint.hpp"
#include "core/error.hpp"

namespace pellicle::heat {

namespace {

/// Cells are solved at most so often; what changes after the last time is booked with the gas as found then.
constexpr int most_rounds = 20;

template <class T>
DeviceArray<T> make_device(const char* label, Index size) {
  return DeviceArray<T>(label, static_cast<std::size_t>(size));
}

/// What the kernels know of the particles.
struct ParticleView {
  dem::Particles particles;
  DeviceArray<Real> temperature;
  DeviceArray<Film> film;
  DeviceArray<Real> material_capacity;
  HeatCapacities capacities;
  WaterEnthalpy water;

  KOKKOS_INLINE_FUNCTION ParticleHeat heat(Index p) const {
    const Film f = film(p);
    return {temperature(p) - water.reference,
            particles.mass(p) * material_capacity(particles.velocity_spin(p).material) +
                f.liquid * capacities.liquid + f.solids * capacities.solids};
  }
  /// All its liquid evaporates within the step. The heat capacity is that of what remains: with that of the start a drop
  /// that is mostly liquid would be carried past the gas.
  KOKKOS_INLINE_FUNCTION ParticleResponse dry_up(Index p, Real heat_conductance, Real step) const {
    const Film f = film(p);
    ParticleHeat held = heat(p);
    held.capacity -= f.liquid * capacities.liquid;
    return limited_response(held, heat_conductance, f.liquid / step,
                            water.evaporation(water.reference + held.warmth), step);
  }
};

struct SaturationAt {
  int law;
  Real pressure;
  KOKKOS_INLINE_FUNCTION ValueAndSlope operator()(Real temperature) const {
    return saturated_fraction_by(law, temperature, pressure);
  }
};

/// What connects the particles with the gas, and how they answer to it during the step.
struct Surroundings {
  ParticleView view;
  coupling::FootprintView footprint;
  DeviceArray<coupling::SampledGas> sampled;
  DeviceArray<CellGas> gas;
  GasHeatProperties properties;
  int nusselt, sherwood;
  SaturationAt saturation;
  bool evaporation, stefan_flow;
  Real step;

  /// `surface`: w* [-] for Stefan's flow.
  KOKKOS_INLINE_FUNCTION Conductances conductances(Index p, const CellGas& g, Real surface) const {
    constexpr Real pi = 3.14159265358979323846;
    const Real diameter = 2 * view.particles.position_radius(p).radius;
    const Real viscosity = properties.sutherland ? cfd::sutherland_viscosity(view.water.reference + g.warmth)
                                                 : properties.viscosity;
    const coupling::SampledGas flow = sampled(p);
    const Real slip = norm(flow.velocity - view.particles.velocity_spin(p).velocity());
    const Real capacity = properties.capacity * (1 - g.vapour) + view.water.vapour_capacity * g.vapour;
    const auto reynolds = static_cast<float>(g.density * flow.void_fraction * slip * diameter / viscosity);
    const TransferLine line = transfer_line(nusselt, flow.void_fraction, reynolds);
    const Real prandtl = viscosity * capacity / properties.conductivity;
    const Real length = pi * diameter;  // A / d
    Conductances k{(line.still + line.stirred * cube_root(prandtl)) * properties.conductivity * length, 0};
    if (!evaporation) return k;
    const TransferLine vapour =
        sherwood == nusselt ? line : transfer_line(sherwood, flow.void_fraction, reynolds);
    const Real diffusion = g.density * properties.diffusivity;
    k.vapour = (vapour.still + vapour.stirred * cube_root(viscosity / diffusion)) * diffusion * length;
    if (stefan_flow) k.vapour *= stefan_factor(surface, g.vapour);
    return k;
  }
  /// The particle at the start, with its heat capacity at the end, about and rather too small: what evaporates takes its
  /// own along.
  KOKKOS_INLINE_FUNCTION ParticleHeat losing(Index p, Real evaporation_rate) const {
    ParticleHeat held = view.heat(p);
    const Real lost = Kokkos::min(step * evaporation_rate, view.film(p).liquid);
    held.capacity -= view.capacities.liquid * Kokkos::max(lost, Real(0));
    return held;
  }
};

struct Respond {
  Surroundings around;
  DeviceArray<ParticleResponse> response;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    const CellGas g = around.footprint.sample(p, around.gas);
    const WaterEnthalpy& water = around.view.water;
    const Real temperature = around.view.temperature(p);
    const ValueAndSlope surface = around.evaporation ? around.saturation(temperature) : ValueAndSlope{0, 0};
    const Conductances k = around.conductances(p, g, surface.value);
    if (!around.evaporation || (!(around.view.film(p).liquid > 0) && g.vapour <= surface.value)) {
      // Dry, and nothing condenses.
      response(p) = limited_response(around.view.heat(p), k.heat, 0, 0, around.step);
      return;
    }
    const ParticleHeat held = around.losing(p, k.vapour * (surface.value - g.vapour));
    const ValueAndSlope line =
        find_chord(around.saturation, surface, held, k, water, g.warmth, g.vapour, around.step);
    response(p) = wet_response(held, k, line, water.evaporation(temperature), around.step);
  }
};

/// Gas of each cell together with all its particles: C (T' - T) = -step sum of heat, M (w' - w) = step (1 - w) sum of
/// evaporation, both at T' and w'. With the signs of the sums the matrix is an M-matrix: T' and w' lie between those of
/// the gas and of its particles' surfaces.
struct SolveCells {
  coupling::CellRows rows;
  DeviceArray<ParticleResponse> response;
  DeviceArray<CellGas> gas;
  DeviceArray<CellEnd> end;
  Real dry_capacity, vapour_capacity;
  Real step;
  bool one_way;

  KOKKOS_INLINE_FUNCTION void operator()(const Index c) const {
    const CellGas g = gas(c);
    const Index first = rows.begin(c), last = rows.begin(c + 1);
    end(c) = {g.warmth, g.vapour};
    if (one_way || first == last || !(g.mass > 0)) return;
    ParticleResponse sum{};
    for (Index e = first; e < last; ++e) {
      const Real share = step * rows.share_of(e);
      const ParticleResponse r = response(rows.particle(e));
      sum.heat_0 += share * r.heat_0;
      sum.heat_warmth += share * r.heat_warmth;
      sum.heat_vapour += share * r.heat_vapour;
      sum.evaporation_0 += share * r.evaporation_0;
      sum.evaporation_warmth += share * r.evaporation_warmth;
      sum.evaporation_vapour += share * r.evaporation_vapour;
    }
    const Real dry = 1 - g.vapour;
    const Real capacity = g.mass * (dry_capacity * dry + vapour_capacity * g.vapour);
    // Unknown: the changes, which keep more digits than the values.
    const Real a11 = capacity + sum.heat_warmth, a12 = sum.heat_vapour;
    const Real a21 = -dry * sum.evaporation_warmth, a22 = g.mass - dry * sum.evaporation_vapour;
    const Real b1 = -sum.heat(g.warmth, g.vapour), b2 = dry * sum.evaporation(g.warmth, g.vapour);
    const Real determinant = a11 * a22 - a12 * a21;
    end(c) = {g.warmth + (b1 * a22 - b2 * a12) / determinant, g.vapour + (b2 * a11 - b1 * a21) / determinant};
  }
};

/// Heat and evaporation of a particle, from all its cells.
struct Exchanged {
  Real heat = 0, evaporation = 0;
};
KOKKOS_INLINE_FUNCTION Exchanged exchanged_by(Index p, const ParticleResponse& r,
                                              const coupling::FootprintView& footprint,
                                              const DeviceArray<CellEnd>& end) {
  Exchanged sum;
  for (Index e = footprint.begin(p); e < footprint.begin(p + 1); ++e) {
    const coupling::FootprintEntry entry = footprint.entries(e);
    const Real share = footprint.share * static_cast<Real>(entry.pieces);
    const CellEnd g = end(entry.cell);
    sum.heat += share * r.heat(g.warmth, g.vapour);
    sum.evaporation += share * r.evaporation(g.warmth, g.vapour);
  }
  return sum;
}

/// Looks at what the cells' gas makes of each particle. One that would lose more liquid than it has loses all of it instead;
/// that is never taken back, since with less vapour from it the gas is warmer and drier. One that ends elsewhere than
/// the line in place of w* was drawn to, because its gas changes more than a little, gets another line.
struct Review {
  Surroundings around;
  DeviceArray<CellEnd> end;
  DeviceArray<ParticleResponse> response;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p, Index& found) const {
    constexpr Real tolerance = 0.1;  // [K]
    const ParticleResponse r = response(p);
    if (r.is_given()) return;
    const Exchanged got = exchanged_by(p, r, around.footprint, end);
    if (around.step * got.evaporation > around.view.film(p).liquid) {
      response(p) = around.view.dry_up(p, r.conductance, around.step);
      ++found;
      return;
    }
    const Real temperature = around.view.temperature(p);
    const Real latent = around.view.water.evaporation(temperature);
    const ParticleHeat held = around.losing(p, got.evaporation);
    const Real change = around.step / held.capacity * (got.heat - latent * got.evaporation);
    if (Kokkos::fabs(change) < tolerance) return;
    const ValueAndSlope surface = around.saturation(temperature);
    const ValueAndSlope there = around.saturation(temperature + change);
    if (Kokkos::fabs(surface.value + r.slope * change - there.value) < tolerance * there.slope) return;
    const CellGas g = around.footprint.sample(p, around.gas);
    response(p) = wet_response(held, around.conductances(p, g, surface.value),
                               {surface.value, (there.value - surface.value) / change}, latent, around.step);
    ++found;
  }
};

/// What each cell gives and gets; before the particles' temperatures change.
struct SumGains {
  coupling::CellRows rows;
  DeviceArray<ParticleResponse> response;
  DeviceArray<CellEnd> end;
  DeviceArray<Real> temperature;
  DeviceArray<dem::VelocitySpin> velocity_spin;
  WaterEnthalpy water;
  DeviceArray<CellGain> gain;

  KOKKOS_INLINE_FUNCTION void operator()(const Index c) const {
    const CellEnd g = end(c);
    CellGain sum;
    for (Index e = rows.begin(c); e < rows.begin(c + 1); ++e) {
      const Index p = rows.particle(e);
      const ParticleResponse r = response(p);
      const Real share = rows.share_of(e);
      const Real evaporation = share * r.evaporation(g.warmth, g.vapour);
      sum.heat += evaporation * water.vapour_capacity * (temperature(p) - water.reference) -
                  share * r.heat(g.warmth, g.vapour);
      sum.vapour += evaporation;
      sum.momentum += evaporation * velocity_spin(p).velocity();
    }
    gain(c) = sum;
  }
};

/// The particles take what their cells gave, as enthalpy; vapour leaves at the temperature of the start.
struct FinishParticles {
  ParticleView view;
  coupling::FootprintView footprint;
  DeviceArray<CellEnd> end;
  DeviceArray<ParticleResponse> response;
  Real step;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p, Index& broken) const {
    const ParticleResponse r = response(p);
    const Exchanged got = exchanged_by(p, r, footprint, end);
    const ParticleHeat held = view.heat(p);
    const Real evaporated = step * got.evaporation;
    const Real enthalpy = held.capacity * held.warmth + step * got.heat -
                          evaporated * view.water.vapour(view.water.reference + held.warmth);
    Film film = view.film(p);
    // All of it if all was to evaporate, without what rounding would leave.
    film.liquid = r.is_given() && evaporated > 0 ? Real(0) : Kokkos::max(film.liquid - evaporated, Real(0));
    view.film(p) = film;
    const Real temperature = view.water.reference + enthalpy / view.heat(p).capacity;
    view.temperature(p) = temperature;
    if (!Kokkos::isfinite(temperature)) ++broken;
  }
};

}  // namespace

HeatExchange::HeatExchange(const HeatOptions& options, const HostArray<Real>& open_volume)
    : options_(options),
      cells_(static_cast<Index>(open_volume.extent(0))),
      sums_(cells_),
      gas_(make_device<CellGas>("heat::heat_exchange::gas", cells_)),
      end_(make_device<CellEnd>("heat::heat_exchange::end", cells_)),
      gain_(make_device<CellGain>("heat::heat_exchange::gain", cells_)),
      volume_(open_volume),
      gas_host_("heat::heat_exchange::gas_host", open_volume.extent(0)),
      gain_host_("heat::heat_exchange::gain_host", open_volume.extent(0)),
      heat_rate_("heat::heat_exchange::heat_rate", open_volume.extent(0)),
      vapour_rate_("heat::heat_exchange::vapour_rate", open_volume.extent(0)),
      zero_("heat::heat_exchange::zero", open_volume.extent(0)),
      momentum_rate_("heat::heat_exchange::momentum_rate", open_volume.extent(0)) {}

void HeatExchange::copy_gas(const cfd::GasState& gas) {
  const HostArray<Real>& temperature = gas.scalars[index_of(cfd::Scalar::temperature)];
  const HostArray<Real>& moisture = gas.scalars[index_of(cfd::Scalar::moisture)];
  const bool moist = moisture.extent(0) > 0;
  const Real reference = options_.water.reference;
  const HostArray<Real> volume = volume_, density = gas.density, void_fraction = gas.void_fraction;
  const HostArray<CellGas> to = gas_host_;
  Kokkos::parallel_for("heat::heat_exchange::collect_gas", HostRange(0, cells_), [=](const Index c) {
    to(c) = {temperature(c) - reference, moist ? moisture(c) : Real(0),
             density(c) * void_fraction(c) * volume(c), density(c)};
  });
  Kokkos::deep_copy(gas_, gas_host_);
}

coupling::CellRows HeatExchange::find_rows(const coupling::MomentumExchange& exchange) {
  if (exchange.has_one_grid()) return exchange.cell_sums().rows();
  sums_.sort(exchange.gas_footprint());
  return sums_.rows();
}

void HeatExchange::update(const dem::Particles& particles, const coupling::MomentumExchange& exchange,
                          const cfd::GasState& gas, const SurfaceState& surface, Real step) {
  const auto response = exchange.scratch().take<ParticleResponse>(particles.count);
  copy_gas(gas);
  const coupling::CellRows rows = find_rows(exchange);
  const coupling::FootprintView& footprint = exchange.gas_footprint().view();
  const ParticleView view{surface.bare(particles), surface.temperature(), surface.film(),
                          surface.heat_capacity(), surface.capacities(),  options_.water};
  const DeviceRange all(0, particles.count), cells(0, cells_);
  const Surroundings around{view,
                            footprint,
                            exchange.sampled_gas(),
                            gas_,
                            options_.gas,
                            static_cast<int>(options_.nusselt.index()),
                            static_cast<int>(options_.sherwood.index()),
                            {static_cast<int>(options_.saturation.index()), options_.gas.pressure},
                            options_.evaporation,
                            options_.stefan_flow,
                            step};
  Kokkos::parallel_for("heat::heat_exchange::respond", all, Respond{around, response});
  Index changed = 1;
  for (rounds_ = 0; rounds_ < most_rounds && changed > 0; ++rounds_) {
    Kokkos::parallel_for("heat::heat_exchange::solve_cells", cells,
                         SolveCells{rows, response, gas_, end_, options_.gas.capacity,
                                    options_.water.vapour_capacity, step, options_.one_way});
    changed = 0;
    if (!options_.evaporation) continue;
    Kokkos::parallel_reduce("heat::heat_exchange::review", all, Review{around, end_, response}, changed);
  }
  Kokkos::parallel_for(
      "heat::heat_exchange::sum_gains", cells,
      SumGains{rows, response, end_, surface.temperature(), particles.velocity_spin, options_.water, gain_});
  Index broken = 0;
  Kokkos::parallel_reduce("heat::heat_exchange::finish_particles", all,
                          FinishParticles{view, footprint, end_, response, step}, broken);
  Kokkos::deep_copy(gain_host_, gain_);
  book(step);
  if (broken > 0) {
    throw RunError("heat: the temperature of " + std::to_string(broken) + " particles is no longer finite");
  }
}

void HeatExchange::book(Real step) {
  Real heat = 0, vapour = 0;
  for (Index c = 0; c < cells_; ++c) {
    const CellGain& gain = gain_host_(c);
    heat += gain.heat;
    vapour += gain.vapour;
    if (!(volume_(c) > 0)) continue;  // no gas, and no particle either: all stays 0
    const Real per_volume = 1 / volume_(c);
    heat_rate_(c) = per_volume * gain.heat;
    vapour_rate_(c) = per_volume * gain.vapour;
    momentum_rate_(c) = per_volume * gain.momentum;
  }
  totals_.heat -= step * heat;
  totals_.evaporated += step * vapour;
}

void HeatExchange::add_to(cfd::ParticleExchange& exchange) const {
  if (options_.one_way) return;
  exchange.scalars[index_of(cfd::Scalar::temperature)] = {heat_rate_, zero_};
  if (!options_.evaporation) return;
  exchange.scalars[index_of(cfd::Scalar::moisture)] = {vapour_rate_, zero_};
  exchange.mass_source = vapour_rate_;
  exchange.mass_source_momentum = momentum_rate_;
}

void HeatExchange::save(core::CheckpointWriter& file) const {
  file.write("heat/given_heat", totals_.heat);
  file.write("heat/evaporated", totals_.evaporated);
}

void HeatExchange::load(const core::CheckpointReader& file) {
  totals_.heat = file.read_double("heat/given_heat");
  totals_.evaporated = file.read_double("heat/evaporated");
}

}  // namespace pellicle::heat
