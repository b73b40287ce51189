// What a checkpoint keeps of the engine.
#include "dem/engine.hpp"

#include <span>

#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
void Engine::save(core::CheckpointWriter& file) const {
  const Index n = particles_.count;
  file.write("dem/count", std::int64_t{n});
  file.write("dem/substeps", substeps_);
  file.write("dem/walls_since", walls_since_);
  file.write("dem/list_builds", builds_);
  file.write("dem/left", left_);
  file.write("dem/left_by_side", left_by_side_);
  file.write("dem/left_momentum", left_momentum_);
  file.write("dem/left_mass", left_mass_);
  file.write("dem/entered_mass", entered_mass_);
  file.write("dem/entered_momentum", entered_momentum_);
  file.write("dem/grown_mass", grown_mass_);
  file.write("dem/grown_momentum", grown_momentum_);
  file.write("dem/next_id", std::int64_t{next_id_});
  file.write("dem/gravity_impulse", gravity_impulse_);
  file.write("dem/volume_time", volume_time_);
  file.write("dem/started", std::int64_t{started_ ? 1 : 0});
  file.write("dem/smallest_radius", smallest_radius_);
  file.write("dem/largest_radius", largest_radius_);
  file.write("dem/moving_mass", moving_mass_);
  file.write("dem/moving_volume", moving_volume_);
  file.write("dem/one_particle_material", std::int64_t{one_particle_material_ ? 1 : 0});
  file.write("dem/any_fixed", std::int64_t{any_fixed_ ? 1 : 0});
  file.write("dem/skin_tuner", std::span(&tuner_.state, 1));
  if (n == 0) return;
  file.write("dem/position_radius", host_copy(particles_.position_radius, n));
  file.write("dem/velocity_spin", host_copy(particles_.velocity_spin, n));
  file.write("dem/mass", host_copy(particles_.mass, n));
  file.write("dem/acceleration", host_copy(particles_.acceleration, n));
  file.write("dem/angular_acceleration", host_copy(particles_.angular_acceleration, n));
  file.write("dem/touching", host_copy(result_.touching, n));
  history_.save(file);
  walls_.save(file);
  for (const Companion* companion : companions_) companion->save(file, n);
}

void Engine::load(core::CheckpointReader& file) {
  const auto n = file.read_int64("dem/count");
  allocate(static_cast<std::size_t>(n));
  walls_.forget();
  substeps_ = file.read_int64("dem/substeps");
  walls_since_ = file.read_int64("dem/walls_since");
  builds_ = file.read_int64("dem/list_builds");
  left_ = file.read_int64("dem/left");
  file.read_into("dem/left_by_side", left_by_side_);
  left_momentum_ = file.read_vec3("dem/left_momentum");
  left_mass_ = file.read_double("dem/left_mass");
  entered_mass_ = file.read_double("dem/entered_mass");
  entered_momentum_ = file.read_vec3("dem/entered_momentum");
  grown_mass_ = file.read_double("dem/grown_mass");
  grown_momentum_ = file.read_vec3("dem/grown_momentum");
  next_id_ = static_cast<std::int32_t>(file.read_int64("dem/next_id"));
  gravity_impulse_ = file.read_vec3("dem/gravity_impulse");
  volume_time_ = file.read_double("dem/volume_time");
  started_ = file.read_int64("dem/started") != 0;
  search_.clear();
  smallest_radius_ = file.read_double("dem/smallest_radius");
  largest_radius_ = file.read_double("dem/largest_radius");
  moving_mass_ = file.read_double("dem/moving_mass");
  moving_volume_ = file.read_double("dem/moving_volume");
  one_particle_material_ = file.read_int64("dem/one_particle_material") != 0;
  any_fixed_ = file.read_int64("dem/any_fixed") != 0;
  file.read_into("dem/skin_tuner", std::span(&tuner_.state, 1));
  if (largest_radius_ > 0) {
    search_.emplace_back(setup_.domain, skin(), smallest_radius_, largest_radius_);
    walls_.set_allowances(setup_.skin, setup_.time_step, smallest_radius_, largest_radius_);
  }
  if (n == 0) {
    for (Companion* companion : companions_) companion->reset(0);
    return;
  }
  const auto read = [&](const char* name, auto& array) {
    read_array(file, name, particles_.count, array, "dem::engine_checkpoint::loaded");
  };
  read("dem/position_radius", particles_.position_radius);
  read("dem/velocity_spin", particles_.velocity_spin);
  read("dem/mass", particles_.mass);
  read("dem/acceleration", particles_.acceleration);
  read("dem/angular_acceleration", particles_.angular_acceleration);
  read("dem/touching", result_.touching);
  history_.load(file);
  walls_.load(file);
  for (Companion* companion : companions_) companion->load(file, particles_.count);
  canonicalise();
}

}  // namespace pellicle::dem
