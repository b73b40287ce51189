// The whole simulation: owns all states and the loop.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cfd/gas_solver.hpp"
#include "core/ledger.hpp"
#include "core/time_control.hpp"
#include "core/timers.hpp"
#include "core/types.hpp"
#include "coupling/momentum_exchange.hpp"
#include "dem/engine.hpp"
#include "dem/feed.hpp"
#include "heat/contact_conduction.hpp"
#include "heat/heat_exchange.hpp"
#include "heat/surface_state.hpp"
#include "spray/droplet_gas.hpp"
#include "spray/spray.hpp"
#include "tools/pellicle/case_spec.hpp"
#include "tools/pellicle/outputs.hpp"
#include "tools/pellicle/results_folder.hpp"
#include "tools/pellicle/summary.hpp"

namespace pellicle::tools {

struct RunOptions {
  std::string output_folder;  ///< exists or may be made; whether it may be used has been checked
  std::optional<Real> until;  ///< stop here with a checkpoint, before time.end [s]
  bool resume = false;        ///< go on from the checkpoint in output_folder
  bool overwrite = false;
  int threads = 0;
  std::string case_yaml_text;  ///< the case with all defaults filled in
};

/// Runs the case and returns the exit code (0 done, 130 interrupted); throws InputError before anything was computed
/// or RunError after leaving a checkpoint and a summary. Kokkos must be initialised.
int run_simulation(const CaseSpec& spec, const RunOptions& options);

/// Asks the running simulation to stop after the present outer step, with a checkpoint. Safe in a signal handler.
void request_stop() noexcept;

/// All states of a run and the loop over its outer steps. Either engine may be absent: a case without `particles:` is
/// pure CFD, one without `gas:` pure DEM.
class Simulation {
 public:
  Simulation(const CaseSpec& spec, const RunOptions& options);

  /// Runs to the end, or to `until`, or to a requested stop; returns the exit code.
  int run();

 private:
  void start();
  void resume();

  // One outer step, in the order of docs/theory: particles enter, the gas is sampled, parcels leave the nozzles,
  // particles and parcels move, films take what was captured, the particles are deposited, heat and vapour are exchanged, the gas moves.
  void advance_outer_step();
  void feed_particles();
  int choose_parts() const;
  void sample_gas();
  const spray::ParcelGas& parcel_gas() const { return droplet_gas_ ? droplet_gas_->gas() : no_gas_; }
  void inject_spray(int part, int parts);
  void move_particles(int parts);
  void collect_spray(int parts);
  void deposit_particles(int parts);
  void exchange_heat(int parts);
  void move_gas(int parts);
  void add_gas_forces(Real dt);
  void release_gas();
  void watch_settling();

  Vec3 impulse_through_walls() const;
  void watch_contacts();
  void watch_zones();
  void update_ledger();
  void update_heat_ledger();
  SprayFigures spray_figures() const;
  void note_heat_to_walls();
  Real heat_to_walls() const;
  void open_spray_ledger();
  void update_spray_ledger();
  dem::SubstepHook substep_hook(int substeps);
  heat::Film films_that_came() const;
  bool has_vapour() const { return gas_ && gas_->balance(cfd::Scalar::moisture) != nullptr; }
  Real energy_stock() const;
  Real water_stock() const;
  void write_outputs(bool last = false);
  Real contacts_per_particle() const;
  ParticleColumns particle_columns() const;
  void write_checkpoint();
  void report_numerics() const;
  void write_summary(const std::string& status, const std::string& message = {});
  std::string describe_progress() const;
  bool coupled() const { return exchange_.has_value() && !time_.settling(); }

  CaseSpec spec_;
  RunOptions options_;
  core::TimeControl time_;
  std::optional<ResultsFolder> folder_;

  std::optional<heat::SurfaceState> surface_;  // follows the particles, and outlives them
  std::optional<spray::Spray> spray_;          // its hit records likewise
  Zones zones_;                                // likewise
  std::vector<spray::ContactWetness> wetness_;
  std::optional<dem::Engine> particles_;
  std::vector<dem::Feed> feeds_;
  std::optional<cfd::GasSolver> gas_;
  std::optional<coupling::MomentumExchange> exchange_;
  std::optional<heat::HeatExchange> heat_;
  std::optional<spray::DropletGas> droplet_gas_;
  spray::ParcelGas no_gas_;  // without gas there is no drag
  std::optional<heat::ContactConduction> conduction_;
  DeviceArray<Real> parcel_gas_temperature_;  // with heat [K]
  std::optional<Outputs> outputs_;

  core::Timers timers_;
  core::Ledger ledger_;
  core::Schedule checkpoints_;
  std::int64_t crowded_steps_ = 0;  // in which the bound of the void fraction could not be kept
  std::int64_t crowded_walls_ = 0;  // times that a particle met more triangles than are compared
  Summary summary_;
  cfd::ParticleExchange no_particles_;        // what a gas without particles feels
  dem::ContactReport contacts_;               // of the last outer step
  Vec3 wall_impulse_{}, support_impulse_{};   // since the start [N s]
  std::vector<WallFigures> walls_;            // of each wall
  Vec3 settled_gravity_{}, settled_wall_{};   // gravity and impulse_through_walls before t = 0 [N s]
  Real settled_volume_time_ = 0;              // [m3 s]
  heat::SurfaceTotals settled_left_surface_;  // what left with particles before t = 0
  std::int64_t quiet_steps_ = 0;              // since the particles moved faster than time.settle.speed
  Real settled_left_mass_ = 0;                // [kg]
  Real settled_grown_mass_ = 0;               // [kg]
  Vec3 settled_grown_momentum_{};             // [N s]
  double made_ = core::wall_clock();          // when this process began to set up [s]
  double wall_begin_ = 0, wall_before_ = 0;   // of this process, and of those before it [s]
  double setup_before_ = 0;                   // of the processes before this one [s]
};

}  // namespace pellicle::tools
