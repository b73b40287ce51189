// The gas's part of a checkpoint: every field that a step starts from, and the running totals.
#include <string>

#include "cfd/gas_solver_impl.hpp"
#include "core/checkpoint.hpp"
#include "core/error.hpp"

namespace pellicle::cfd {

namespace {

const char* const velocity_names[] = {"gas/superficial_velocity_x", "gas/superficial_velocity_y",
                                      "gas/superficial_velocity_z"};

// Calls visit(name, vector) for all running totals.
template <class Balance, class Visit>
void for_totals(Balance& b, Visit&& visit) {
  visit("gas/balance/momentum_initial", b.momentum_initial);
  visit("gas/balance/convected", b.convected);
  visit("gas/balance/boundary_pressure", b.boundary_pressure);
  visit("gas/balance/boundary_shear", b.boundary_shear);
  visit("gas/balance/body_force", b.body_force);
  visit("gas/balance/drag", b.drag);
  visit("gas/balance/particle_pressure", b.particle_pressure);
  visit("gas/balance/vapour", b.vapour);
  visit("gas/balance/gross", b.gross);
}

}  // namespace

void GasSolver::save(core::CheckpointWriter& writer) const {
  const Impl& s = *impl_;
  writer.write("gas/time", s.state.time);
  writer.write("gas/velocity", s.state.velocity);
  writer.write("gas/pressure", s.state.pressure);
  writer.write("gas/pressure_gradient", s.state.pressure_gradient);
  writer.write("gas/void_fraction", s.state.void_fraction);
  writer.write("gas/void_fraction_old", s.state.void_fraction_old);
  for (std::size_t a = 0; a < 3; ++a) writer.write(velocity_names[a], s.fields.superficial[a]);
  writer.write("gas/boundary_flow", s.fields.piece_flow);
  std::vector<Real> in, out;
  for (const PatchBalance& patch : s.balance.patches) {
    in.push_back(patch.mass_in);
    out.push_back(patch.mass_out);
  }
  writer.write("gas/balance/mass_initial", s.balance.mass_initial);
  writer.write("gas/balance/mass_given", s.balance.mass_given);
  writer.write("gas/balance/mass_in", in);
  writer.write("gas/balance/mass_out", out);
  for_totals(s.balance, [&](const char* name, const Vec3& total) { writer.write(name, total); });
  s.scalars.save(writer, s.fields);
  if (s.turbulence) s.turbulence->save(writer);
}

void GasSolver::load(core::CheckpointReader& reader) {
  Impl& s = *impl_;
  s.state.time = reader.read_double("gas/time");
  reader.read_into("gas/velocity", s.state.velocity);
  reader.read_into("gas/pressure", s.state.pressure);
  reader.read_into("gas/pressure_gradient", s.state.pressure_gradient);
  reader.read_into("gas/void_fraction", s.state.void_fraction);
  reader.read_into("gas/void_fraction_old", s.state.void_fraction_old);
  for (std::size_t a = 0; a < 3; ++a) reader.read_into(velocity_names[a], s.fields.superficial[a]);
  reader.read_into("gas/boundary_flow", s.fields.piece_flow);
  s.scalars.load(reader, s.fields);
  const Index n = s.fields.cells;
  for (Index c = 0; c < n; ++c) {
    for (int a = 0; a < 3; ++a) s.fields.velocity(c + a * n) = s.state.velocity(c)[a];
  }
  if (s.turbulence) s.turbulence->load(reader, s.fields);
  s.update_mass_flux();
  s.copy_velocity_to_state();
  const std::vector<Real> in = reader.read_doubles("gas/balance/mass_in");
  const std::vector<Real> out = reader.read_doubles("gas/balance/mass_out");
  if (in.size() != s.balance.patches.size() || out.size() != s.balance.patches.size()) {
    throw RunError("gas/balance: the checkpoint has another number of boundaries than the case");
  }
  for (std::size_t p = 0; p < in.size(); ++p) {
    s.balance.patches[p].mass_in = in[p];
    s.balance.patches[p].mass_out = out[p];
  }
  s.balance.mass_initial = reader.read_double("gas/balance/mass_initial");
  s.balance.mass_given = reader.read_double("gas/balance/mass_given");
  for_totals(s.balance, [&](const char* name, Vec3& total) { total = reader.read_vec3(name); });
  s.update_stocks();
  s.pressure_solver.drop();
  s.still_steps = 0;
}

}  // namespace pellicle::cfd
