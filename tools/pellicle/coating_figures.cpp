#include "tools/pellicle/coating_figures.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace pellicle::tools {
namespace {

/// Mean, and standard deviation (of all there are, not of a sample of them) over the mean. In two passes.
template <class Value>
std::pair<Real, Real> mean_and_variation(std::size_t count, const Value& value) {
  Real sum = 0, squares = 0;
  for (std::size_t p = 0; p < count; ++p) sum += value(p);
  const Real mean = sum / static_cast<Real>(count);
  for (std::size_t p = 0; p < count; ++p) squares += (value(p) - mean) * (value(p) - mean);
  return {mean, std::sqrt(squares / static_cast<Real>(count)) / mean};
}

}  // namespace

CoatingFigures compute_coating_figures(const HostParticles& particles) {
  CoatingFigures coating;
  const std::size_t n = particles.count();
  if (n == 0) return coating;
  const auto count = static_cast<Real>(n);
  for (std::size_t p = 0; p < n; ++p) {
    const ParticleSample particle = particles.sample(p);
    coating.mass += particle.film.solids;
    coating.liquid += particle.film.liquid;
    coating.coated_share += particle.film.solids > 0 ? 1 / count : 0;
    coating.wet_share += particle.film.liquid > 0 ? 1 / count : 0;
    coating.temperature_mean += particle.temperature / count;
  }
  std::tie(coating.mass_mean, coating.mass_variation) =
      mean_and_variation(n, [&](std::size_t p) { return particles.sample(p).film.solids; });
  std::tie(coating.thickness_mean, coating.thickness_variation) =
      mean_and_variation(n, [&](std::size_t p) { return particles.sample(p).coating_thickness(); });
  return coating;
}

Real coating_quantity(std::string_view name, const CoatingFigures& coating) {
  if (name == "coating_mass") return coating.mass;
  if (name == "coating_mass_mean") return coating.mass_mean;
  if (name == "coating_mass_cov") return coating.mass_variation;
  if (name == "coated_share") return coating.coated_share;
  if (name == "coating_thickness_mean") return coating.thickness_mean;
  if (name == "coating_thickness_cov") return coating.thickness_variation;
  if (name == "film_liquid_mass") return coating.liquid;
  if (name == "wet_share") return coating.wet_share;
  if (name == "particle_temperature_mean") return coating.temperature_mean;
  throw std::logic_error("no coating quantity " + std::string(name));
}

}  // namespace pellicle::tools
