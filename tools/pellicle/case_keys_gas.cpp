// Keys of the gas and of what couples it to the particles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/pellicle/case_keys.hpp"
#include "tools/pellicle/case_keys_gas_heat.hpp"
#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {

namespace {

using core::Keys;
using core::Need;
using core::TextRule;
namespace dimension = core::dimension;
namespace range = core::range;

constexpr core::ModelInfo pressure_solver_list[] = {
    {"multigrid", "conjugate gradients with a geometric multigrid cycle"},
    {"amgcl", "conjugate gradients with the algebraic multigrid of AMGCL"}};

/// The kinds of boundaries as keys of which one is given.
struct BoundaryKinds {
  std::optional<cfd::Inlet> inlet;
  std::optional<cfd::Outlet> outlet;
  std::optional<cfd::NoSlip> wall;
  bool free_slip = false;
  bool symmetry = false;
  CarriedKeys carried;
  std::optional<cfd::InletTurbulence> turbulence;
};

BoundaryKinds take_apart(const cfd::BoundaryPatch& patch) {
  BoundaryKinds kinds;
  if (const auto* inlet = std::get_if<cfd::Inlet>(&patch.kind)) kinds.inlet = *inlet;
  if (const auto* outlet = std::get_if<cfd::Outlet>(&patch.kind)) kinds.outlet = *outlet;
  if (const auto* wall = std::get_if<cfd::NoSlip>(&patch.kind)) kinds.wall = *wall;
  kinds.free_slip = std::holds_alternative<cfd::FreeSlip>(patch.kind);
  kinds.symmetry = std::holds_alternative<cfd::Symmetry>(patch.kind);
  kinds.carried = take_carried_apart(patch.scalars);
  kinds.turbulence = patch.turbulence;
  return kinds;
}

void put_together(const BoundaryKinds& kinds, cfd::BoundaryPatch& patch) {
  if (kinds.inlet) patch.kind = *kinds.inlet;
  if (kinds.outlet) patch.kind = *kinds.outlet;
  if (kinds.wall) patch.kind = *kinds.wall;
  if (kinds.free_slip) patch.kind = cfd::FreeSlip{};
  if (kinds.symmetry) patch.kind = cfd::Symmetry{};
  patch.scalars = put_carried_together(kinds.carried);
  if (kinds.turbulence) patch.turbulence = *kinds.turbulence;
}

void describe_disc(Keys& keys, cfd::DiscRegion& disc) {
  keys.vector({"centre", "its middle; the coordinate across the side does not count", Need::required},
              {dimension::length}, disc.centre);
  describe_ring(keys, disc.radius, disc.inner_radius);
}

void check_inside(Keys& keys, const Vec3& point, const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] >= box.min[axis] && point[axis] <= box.max[axis]) continue;
    keys.problem(
        "inside",
        fmt::format("it is out of the domain; a point within [{:g}, {:g}, {:g}] to [{:g}, {:g}, {:g}] m",
                    box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z));
    return;
  }
}

void describe_inlet_turbulence(Keys& keys, const GasSpec& gas, std::optional<cfd::InletTurbulence>& held) {
  keys.section<cfd::InletTurbulence>(
      {"turbulence", "of the gas that comes in; with a model of turbulence"}, held,
      [](Keys& inner, cfd::InletTurbulence& turbulence) {
        inner.real({"intensity", "root mean square of a velocity component over the inlet velocity"},
                   {dimension::pure_number, range::non_negative}, turbulence.intensity);
        inner.real({"length_scale", "of the eddies", Need::has_default,
                    "0.07 diameters of a disc of the inlet's area"},
                   {dimension::length, range::positive}, turbulence.length_scale);
      });
  if (keys.reading() && held && !gas.options.turbulence) {
    keys.problem("turbulence", "there is no model of turbulence; gas.turbulence, or without this section");
  }
}

void describe_boundary(Keys& keys, const GasSpec& gas, cfd::BoundaryPatch& patch) {
  if (keys.reading()) patch.where = keys.where();
  keys.text({"name", "of the boundary", Need::required}, TextRule::name, patch.name);
  std::optional<int> on;
  if (!patch.name.empty()) on = static_cast<int>(patch.on);
  if (patch.wall) on.reset();
  keys.choice({"on", "side of the domain"}, domain_sides, on);
  keys.text(
      {"on_wall",
       "name of the wall that is an inlet, an outlet or of a temperature as a whole, in place of a side"},
      TextRule::name, patch.wall);
  keys.exactly_one({"on", "on_wall"});
  if (on) patch.on = static_cast<cfd::Side>(*on);

  std::optional<cfd::BoundaryPatch> region;
  if (patch.region || patch.disc) region = patch;
  keys.section<cfd::BoundaryPatch>(
      {"region", "the part of the side", Need::has_default, "what no other region of the side takes"}, region,
      [](Keys& inner, cfd::BoundaryPatch& held) {
        inner.section<Box>({"box", "the part of the side inside this box"}, held.region, describe_flat_box);
        inner.section<cfd::DiscRegion>({"disc", "the part of the side inside this disc, or annulus"},
                                       held.disc, describe_disc);
        inner.exactly_one({"box", "disc"});
      });
  if (keys.reading() && region) {
    patch.region = region->region;
    patch.disc = region->disc;
  }

  BoundaryKinds kinds = keys.reading() ? BoundaryKinds{} : take_apart(patch);
  keys.section<cfd::Inlet>(
      {"inlet", "gas comes in at right angles to the side"}, kinds.inlet,
      [&](Keys& inner, cfd::Inlet& inlet) {
        inner.real({"velocity", "superficial, inward, over the open area"},
                   {dimension::velocity, range::non_negative}, inlet.velocity);
        inner.real({"flow_rate", "at the inlet's own temperature and pressure"},
                   {dimension::flow_rate, range::non_negative}, inlet.flow_rate);
        inner.real({"share", "of the flow that comes through this inlet"},
                   {dimension::pure_number, {.min = 0, .max = 1}}, inlet.share);
        inner.real({"mass_flow", "at the density of the gas that comes in"},
                   {dimension::mass_flow_rate, range::non_negative}, inlet.mass_flow);
        inner.exactly_one({"velocity", "flow_rate", "mass_flow"});
        if (inner.reading() && inlet.velocity && inlet.share != 1) {
          inner.problem("share", "there is no flow rate to share; only with flow_rate or mass_flow");
        }
        describe_incoming_gas(inner, gas, true, kinds.carried);
        if (!inner.reading() && !gas.options.turbulence) kinds.turbulence.reset();
        describe_inlet_turbulence(inner, gas, kinds.turbulence);
      });
  keys.section<cfd::Outlet>({"outlet", "gas leaves"}, kinds.outlet, [&](Keys& inner, cfd::Outlet& outlet) {
    inner.real({"pressure", "at the outlet, without its hydrostatic part"}, {dimension::pressure},
               outlet.pressure);
    describe_incoming_gas(inner, gas, false, kinds.carried);
  });
  keys.section<cfd::NoSlip>(
      {"wall", "the gas sticks to it"}, kinds.wall, [&](Keys& inner, cfd::NoSlip& wall) {
        inner.vector({"velocity", "of the wall in its own plane"}, {dimension::velocity}, wall.velocity);
        describe_wall_heat(inner, gas, kinds.carried);
      });
  keys.mark({"free_slip", "a wall without shear"}, kinds.free_slip);
  keys.mark({"symmetry", "a plane of symmetry"}, kinds.symmetry);
  keys.exactly_one({"inlet", "outlet", "wall", "free_slip", "symmetry"});
  if (keys.reading()) put_together(kinds, patch);
  if (keys.reading() && patch.wall && (region || kinds.free_slip || kinds.symmetry)) {
    keys.problem("on_wall", "a wall is a boundary as a whole; inlet, outlet or wall, without region");
  }
  if (keys.reading() && patch.wall && kinds.wall && norm(kinds.wall->velocity) != 0) {
    keys.problem("wall", "the wall itself says how it moves; a temperature or heat_transfer alone");
  }
  if (keys.reading() && !patch.wall && kinds.wall && kinds.wall->velocity[cfd::axis_of(patch.on)] != 0) {
    keys.problem("wall", "its velocity leads through the side; a velocity along the side");
  }
}

void describe_k_epsilon(Keys& keys, cfd::KEpsilonOptions& options) {
  keys.real({"initial_k", "turbulent kinetic energy at the start", Need::has_default,
             "5 % intensity at the largest of initial velocity and inlet velocities"},
            {dimension::turbulent_energy, range::positive}, options.initial_k);
  keys.real({"initial_epsilon", "its dissipation at the start", Need::has_default,
             "eddies of ten times the viscosity of the gas"},
            {dimension::turbulent_dissipation, range::positive}, options.initial_epsilon);
  keys.real({"prandtl_number", "eddy viscosity over eddy diffusivity of heat"},
            {dimension::pure_number, range::positive}, options.prandtl_number);
  keys.real({"schmidt_number", "eddy viscosity over eddy diffusivity of vapour"},
            {dimension::pure_number, range::positive}, options.schmidt_number);
  keys.real({"largest_viscosity_ratio", "eddy viscosity over that of the gas, at most"},
            {dimension::pure_number, range::positive}, options.largest_viscosity_ratio);
}

void describe_turbulence(Keys& keys, std::optional<cfd::KEpsilonOptions>& options) {
  cfd::Turbulence model = options ? cfd::Turbulence::k_epsilon : cfd::Turbulence::none;
  keys.choice({"turbulence", "model of eddies that the grid does not resolve"}, cfd::turbulence_models,
              model);
  std::optional<cfd::KEpsilonOptions> held = options;
  keys.section<cfd::KEpsilonOptions>({"k_epsilon", "of that model: start, numbers, limit"}, held,
                                     describe_k_epsilon);
  if (!keys.reading()) return;
  if (held && model == cfd::Turbulence::none) {
    keys.problem("k_epsilon", "of no use without the model; turbulence: k_epsilon, or without this section");
  }
  options.reset();
  if (model == cfd::Turbulence::k_epsilon) options = held.value_or(cfd::KEpsilonOptions{});
}

void describe_solver(Keys& keys, cfd::GasSolverOptions& solver) {
  constexpr core::RealRule tolerance{dimension::pure_number, {.min = 0, .max = 1, .min_excluded = true}};
  keys.real({"pressure_tolerance",
             "of the last pressure solve of a step: sum of mass residuals over the gas throughput"},
            tolerance, solver.pressure_tolerance);
  keys.real({"loose_pressure_tolerance", "of the pressure solves before the last: reduction of the residual"},
            tolerance, solver.loose_pressure_tolerance);
  keys.real({"momentum_tolerance", "relative to the momentum that the gas exchanges in the step"}, tolerance,
            solver.momentum_tolerance);
  keys.real({"outer_tolerance", "relative change of the face velocities that ends the outer iterations"},
            tolerance, solver.outer_tolerance);
  keys.whole({"max_outer_iterations", "of the SIMPLEC loop of a step"}, {1, 10'000},
             solver.max_outer_iterations);
  keys.whole({"max_linear_iterations", "of one linear solve"}, {1, 1'000'000}, solver.max_linear_iterations);
  keys.real({"velocity_relaxation", "below 1 only for steps of many Courant numbers"},
            {dimension::pure_number, {.min = 0, .max = 1, .min_excluded = true}}, solver.velocity_relaxation);
  keys.flag({"require_convergence",
             "a step whose outer iterations do not come down to outer_tolerance stops the run"},
            solver.require_convergence);
  keys.choice({"pressure_solver", "both give the same answer to within the tolerance"}, pressure_solver_list,
              solver.pressure_solver);
}

}  // namespace

void describe_gas(Keys& keys, CaseSpec& spec) {
  keys.section<GasSpec>(
      {"gas", "the gas; without it the case is particles alone"}, spec.gas, [&](Keys& inner, GasSpec& gas) {
        describe_gas_properties(inner, gas);
        inner.vector({"velocity", "initial"}, {dimension::velocity}, gas.velocity);
        inner.vector({"inside", "a point in the gas, where walls divide the domain", Need::has_default,
                      "a point of the first inlet that has a region, else of the first inlet"},
                     {dimension::length}, gas.inside);
        if (inner.reading() && gas.inside) check_inside(inner, *gas.inside, spec.domain.box);
        inner.vector({"body_force", "on the gas besides gravity"}, {dimension::force_per_volume},
                     gas.options.body_force);
        inner.section<GridSpec>({"grid", "cells of the domain", Need::required}, gas.grid,
                                [&](Keys& k, GridSpec& grid) { describe_gas_grid(k, grid, spec.domain); });
        inner.choice({"convection", "how the convected velocity gets from cells to faces"},
                     cfd::convection_models, gas.options.convection);
        describe_turbulence(inner, gas.options.turbulence);
        inner.list<cfd::BoundaryPatch>(
            {"boundaries", "regions on the sides; what none takes is a wall that the gas sticks to"}, {},
            gas.boundaries, [&](Keys& k, cfd::BoundaryPatch& patch) { describe_boundary(k, gas, patch); });
        inner.section<cfd::GasSolverOptions>({"solver", "tolerances and limits"}, gas.options.solver,
                                             describe_solver);
        if (inner.reading()) gas.options.gravity = spec.gravity;
      });
}

void describe_coupling(Keys& keys, CaseSpec& spec) {
  std::optional<CouplingSpec> held;
  if (!keys.reading() && spec.gas && !spec.particles.empty()) held = spec.coupling;
  keys.section<CouplingSpec>(
      {"coupling", "how gas and particles act on each other"}, held, [&](Keys& inner, CouplingSpec& options) {
        inner.choice({"drag", "law of the drag force"}, drag_laws, options.drag);
        inner.choice({"deposition", "how a particle's volume is shared among cells"}, depositions,
                     options.deposition);
        std::optional<GridSpec> grid;
        if (options.transfer_grid.cells.x > 0) grid = options.transfer_grid;
        inner.section<GridSpec>(
            {"transfer_grid", "cells in which the void fraction is counted", Need::has_default,
             "the gas grid"},
            grid, [&](Keys& k, GridSpec& transfer) { describe_transfer_grid(k, transfer, spec.domain); });
        if (inner.reading() && grid) options.transfer_grid = *grid;
        inner.choice({"exchange", "how the gas gets the momentum that particles lose"},
                     coupling::exchange_models, options.exchange);
        inner.flag({"pressure_gradient_force", "particles feel the gradient of the gas pressure"},
                   options.pressure_gradient_force);
        inner.choice({"coefficients", "how often the momentum exchange coefficients are computed"},
                     coupling::coefficients_models, options.coefficients);
        inner.real({"minimum_void_fraction",
                    "where particles leave less, the excess is spread to neighbouring cells"},
                   {dimension::pure_number, {.min = 0, .max = 1, .min_excluded = true, .max_excluded = true}},
                   options.minimum_void_fraction);
        inner.real(
            {"pending_release",
             "share of the momentum carried over that the gas gets back a step; large ones are unstable"},
            {dimension::pure_number, {.min = 0, .max = 1, .min_excluded = true}}, options.pending_release);
        inner.real(
            {"smoothing_length",
             "b: solids and forces of particles are spread by diffusion, about as exp(-r2/b2); 0: they "
             "are not"},
            {dimension::length, range::non_negative}, options.smoothing_length);
      });
  if (keys.reading() && held) spec.coupling = *held;
}

}  // namespace pellicle::tools
