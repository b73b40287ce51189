#include <Kokkos_Core.hpp>
#include <cstdio>
#include <cstdlib>
#include "core/error.hpp"
#include "tools/pellicle/simulation.hpp"
using namespace pellicle;
int main(int argc, char** argv) {
  Kokkos::ScopeGuard g(argc, argv);
  tools::CaseSpec s;
  s.title = "spout";
  s.domain.box = {{0, 0, 0}, {0.145, 0.02, 0.5}};
  s.time.end = std::atof(argv[1]);
  s.time.gas_step = 1e-4; s.time.particle_step = 1e-5; s.time.settle = std::atof(argv[2]);
  s.materials = {{"glass", false, 2505, 1e7, 0.22}, {"wall", true, 0, 0, 0}};
  s.contacts.pairs.push_back({"", 0, 0, 0.97, 0.3, 0.0});
  s.contacts.pairs.push_back({"", 0, 1, 0.97, 0.3, 0.0});
  tools::PopulationSpec p; p.count = 12000; p.diameter = 0.003;
  p.fill = tools::FillSpec{}; p.fill->box = Box{{0, 0, 0}, {0.145, 0.02, 0.2}};
  s.particles.push_back(p);
  tools::WallSpec w; w.name = "sides"; w.box = true; w.material = 1; s.walls.push_back(w);
  tools::GasSpec gas; gas.options.density = 1.149; gas.options.viscosity = 1.87e-5;
  CartesianGrid grid(s.domain.box, {29, 2, 64});
  gas.grid.cells = {29, 2, 64};
  for (int a = 0; a < 3; ++a) gas.grid.faces[a] = grid.faces(a);
  cfd::BoundaryPatch sp; sp.name = "spout"; sp.on = cfd::Side::z_min; sp.region = Box{{0.07, 0, 0}, {0.075, 0.02, 0}}; sp.kind = cfd::Inlet{43.5, {}};
  cfd::BoundaryPatch bg; bg.name = "background"; bg.on = cfd::Side::z_min; bg.kind = cfd::Inlet{2.4, {}};
  cfd::BoundaryPatch top; top.name = "top"; top.on = cfd::Side::z_max; top.kind = cfd::Outlet{0};
  gas.boundaries = {sp, bg, top};
  s.gas = gas;
  s.coupling.transfer_grid = gas.grid;
  if (argc > 4) s.coupling.drag = argv[4];
  s.output.snapshots.every = 0.02; s.output.snapshots.particles = {"velocity", "speed", "radius"}; s.output.snapshots.gas = {"velocity", "pressure", "void_fraction"};
  tools::ProbeSpec bed; bed.name = "bed"; bed.bed = true; bed.every = 1e-3; bed.quantities = {"bed_height", "pressure_drop", "mean_speed", "largest_speed", "contacts_per_particle"};
  s.output.probes = {bed};
  s.output.checkpoint_every = 0.1;
  tools::RunOptions o; o.output_folder = argv[3]; o.overwrite = true; o.case_yaml_text = "title: x\n";
  try { return tools::run_simulation(s, o); } catch (const std::exception& e) { std::printf("ERROR %s\n", e.what()); return 3; }
}
