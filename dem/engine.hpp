// The DEM engine: owns particles, lists and walls, and advances them by substeps.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/checkpoint.hpp"
#include "core/timers.hpp"
#include "dem/companion.hpp"
#include "dem/contact_history.hpp"
#include "dem/contact_loop.hpp"
#include "dem/materials.hpp"
#include "dem/motion.hpp"
#include "dem/neighbour_list.hpp"
#include "dem/particles.hpp"
#include "dem/side_totals.hpp"
#include "dem/skin_tuner.hpp"
#include "dem/wall_system.hpp"

namespace pellicle::dem {

/// A particle to start with.
struct ParticleSeed {
  Vec3 position;     ///< [m]
  Vec3 velocity{};   ///< [m/s]
  Vec3 spin{};       ///< [rad/s]
  Real radius = 0;   ///< [m]
  int material = 0;  ///< index into the materials
  bool fixed = false;
};

/// Particles that will be added while the engine runs (see Engine::add_particles): their radii and number
/// size the search for partners, which must be the same after a restart, and tell which materials can meet.
struct LaterParticles {
  std::vector<int> materials;
  Real smallest_radius = 0, largest_radius = 0;  ///< [m]
  std::int64_t count = 0;                        ///< about
};

/// What an engine is made of.
struct EngineSetup {
  Domain domain;
  std::vector<Material> materials;
  std::vector<PairProperties> pairs;
  ContactOptions contacts;
  std::vector<Wall> walls;
  Vec3 gravity{};      ///< [m/s²]
  Real time_step = 0;  ///< [s]
  SkinOptions skin{};
  LaterParticles later{};
};

/// What particles gave to a wall.
struct WallLoad {
  Vec3 impulse{};          ///< [N s]
  Vec3 angular_impulse{};  ///< about the wall's torque_about [N m s]
  std::int64_t touching = 0;
};

/// Contacts since the last call of `collect_report`, and how many touch now.
struct ContactReport : ContactExtremes {
  Vec3 wall_impulse{};     ///< walls to moving particles [N s]
  Vec3 support_impulse{};  ///< contacts to fixed particles [N s]
  std::int64_t touching_pairs = 0;
  std::int64_t touching_walls = 0;
  std::int64_t bridges = 0;        ///< between particles
  std::int64_t wall_bridges = 0;   ///< between particles and walls
  std::int64_t crowded_walls = 0;  ///< times that a particle overlapped more surfaces than are compared
  std::vector<WallLoad> walls;     ///< one for each wall of the set-up
};

/// Sums over all particles, in an order that does not depend on threads.
struct ParticleTotals {
  Real mass = 0;              ///< of moving particles, as all sums here [kg]
  Real volume = 0;            ///< [m³]
  Vec3 momentum{};            ///< Σ m h, h the half-step velocity whose change is exactly Σ F Δt [kg m/s]
  Vec3 angular_momentum{};    ///< about the origin, spin included, at the half step like momentum [kg m²/s]
  Real kinetic_energy = 0;    ///< translation and spin [J]
  Real potential_energy = 0;  ///< −Σ m g·x [J]
  Real mean_height = 0;       ///< mass-weighted z [m]
  Real largest_speed = 0;     ///< [m/s]
};

/// Called in every substep with its number, from 0, in this call of Engine::advance.
using SubstepHook = std::function<void(int)>;

class Engine {
 public:
  /// Throws std::invalid_argument where the set-up cannot work.
  explicit Engine(const EngineSetup& setup);

  /// `companion` follows the particles from now on: every re-sort of memory, arrival and departure, and into checkpoints.
  /// It must outlive the engine. To be called before there are particles.
  void attach(Companion& companion) { companions_.push_back(&companion); }

  /// Replaces all particles; ids are 0, 1, … in the order given. Throws std::invalid_argument where contact properties
  /// of two materials that can meet are missing.
  void set_particles(const std::vector<ParticleSeed>& seeds);

  /// Adds particles between two outer steps, with ids that go on; a velocity is that at the time of the position. They
  /// must be as announced in `EngineSetup::later`. Memory grows by a quarter now and then.
  void add_particles(const std::vector<ParticleSeed>& seeds);

  /// Between two outer steps: gives every particle a mass [kg], in their present order. Velocities stay.
  void set_masses(const DeviceArray<Real>& mass);

  /// The same with radii [m], which do not get smaller. Centres stay, so contacts press by what the radii grow. Throws
  /// RunError where a periodic domain gets too narrow for them.
  void set_sizes(const DeviceArray<Real>& mass, const DeviceArray<Real>& radius);

  /// Before the substeps of an outer step: removes particles that left through open sides (counted), stops the run if
  /// one is where it cannot be, and re-sorts memory in space now and then. May reorder the particle arrays.
  void prepare_outer_step();

  /// Advances all particles by `count` substeps under contacts, gravity and the fluid force, a device functor
  /// `Vec3 operator()(Index p, const Vec3& velocity, Real dt) const` that is called once a particle and substep.
  /// `before_motion`, if any, is called when the lists are valid and the particles have not moved yet.
  template <class FluidForce>
  void advance(int count, const FluidForce& fluid_force, core::Timers& timers,
               const SubstepHook& before_motion = {}) {
    for (int k = 0; k < count; ++k) {
      begin_substep(timers);
      if (before_motion) before_motion(k);
      {
        const core::Timers::Scope scope(timers, core::Part::motion);
        move_particles(particles_, result_, list_, step_, fluid_force, flags_);
        Kokkos::fence("dem::engine::moved");
      }
      end_substep();
    }
  }

  /// The same without a fluid.
  void advance(int count, core::Timers& timers, const SubstepHook& before_motion = {});

  /// Walls move from the first substep on. `hold_walls` makes them rest in the place where they begin, until
  /// `start_walls` starts their clock.
  void hold_walls() { walls_since_ = -1; }
  void start_walls() { walls_since_ = substeps_; }
  /// Time since walls began to move [s]; negative before.
  Real wall_time() const;

  /// Contact figures since the last call; stops the run if an overlap went beyond the limit or a particle broke.
  ContactReport collect_report();

  /// Puts memory into the canonical order and drops the lists, as resuming does. Called when a checkpoint is written.
  void canonicalise();

  void save(core::CheckpointWriter& file) const;
  void load(core::CheckpointReader& file);

  const Particles& particles() const { return particles_; }
  const EngineSetup& setup() const { return setup_; }
  /// Cells of the last list build and the particles sorted into them: visit_runs around a place finds all particles that
  /// may be near it now, as long as lists are valid (within before_motion). Null before there are particles.
  const NeighbourSearch* search() const { return search_.empty() ? nullptr : &search_.front(); }
  /// The pairs that may touch, as of the last substep; indices are those of the particles until they are reordered.
  const NeighbourList& neighbours() const { return list_; }
  /// Where walls are in this substep, and what they are made of.
  const WallSystem& walls() const { return walls_; }
  ParticleTotals compute_totals() const;
  std::int64_t left_through_open_sides() const { return left_; }
  /// The same for each side; a particle beyond two is counted for the first.
  const std::array<SideTotals, domain_side_count>& left_by_side() const { return left_by_side_; }
  /// Mass of the moving particles that were added and that left through open sides so far [kg].
  Real entered_mass() const { return entered_mass_; }
  Real left_mass() const { return left_mass_; }
  /// What changes of mass have added to the moving particles so far [kg], and to their momentum, like that of the totals.
  Real grown_mass() const { return grown_mass_; }
  const Vec3& grown_momentum() const { return grown_momentum_; }
  /// Momentum that added particles brought in so far, like that of the totals [kg m/s].
  const Vec3& entered_momentum() const { return entered_momentum_; }
  /// Momentum that particles took out through open sides so far [kg m/s].
  const Vec3& left_momentum() const { return left_momentum_; }
  /// Impulse of gravity on the moving particles so far [N s].
  const Vec3& gravity_impulse() const { return gravity_impulse_; }
  /// Volume of the moving particles, integrated over the time that forces acted on them [m³ s].
  Real volume_time() const { return volume_time_; }
  std::int64_t substeps() const { return substeps_; }
  std::int64_t list_builds() const { return builds_; }
  /// Entries of the neighbour list now, over particles.
  Real neighbours_per_particle() const;
  /// Device memory of all arrays: particles, forces, lists, what the search needs [bytes].
  std::size_t bytes() const;

 private:
  void allocate(std::size_t n);
  void reserve(std::size_t capacity);
  void begin_substep(core::Timers& timers);
  void end_substep();
  void build_lists();
  SkinOptions skin() const;
  /// Lets the tuner see the substep that has ended.
  void tune_skin(bool outdated);
  void sort_memory();
  void reorder(const DeviceArray<std::int32_t>& order, Index count);
  void remove_left();
  void book_growth(const Vec3& momentum_before);
  void take_stock(const std::vector<ParticleSeed>& seeds);
  Real mass_of(const ParticleSeed& seed) const;
  /// Writes seeds to the arrays from entry `first` on, with the next ids.
  void put_particles(const std::vector<ParticleSeed>& seeds, Index first);
  [[noreturn]] void stop_for_overlap(Real overlap) const;

  EngineSetup setup_;
  std::vector<Companion*> companions_;
  Particles particles_;
  WallSystem walls_;
  DeviceArray<PairParameters> table_;
  std::vector<NeighbourSearch> search_;  // none before there are particles
  SkinTuner tuner_;
  NeighbourList list_;
  ContactResult result_;
  ContactHistory history_;
  // Holds force and torque; while neither is needed, what the list search or a re-sort needs.
  DeviceArray<Real> work_;                // loads by contact; free between substeps
  DeviceArray<std::int32_t> free_order_;  // free between uses
  MotionStep step_;
  MotionFlagsView flags_;
  bool list_valid_ = false;
  bool one_particle_material_ = true;
  bool any_fixed_ = false;
  bool started_ = false;
  std::int64_t substeps_ = 0;
  std::int64_t walls_since_ = 0;  // substep at which walls began to move; -1: not yet
  std::int64_t builds_ = 0;
  std::int32_t next_id_ = 0;
  std::int64_t left_ = 0;
  std::array<SideTotals, domain_side_count> left_by_side_{};
  DeviceArray<SideTotals> leaving_;        // of one outer step
  Real entered_mass_ = 0, left_mass_ = 0;  // [kg]
  Vec3 entered_momentum_{};
  Real grown_mass_ = 0;  // [kg]
  Vec3 grown_momentum_{};
  Vec3 left_momentum_{};
  Vec3 gravity_impulse_{};
  Real volume_time_ = 0;
  Real moving_mass_ = 0, moving_volume_ = 0;  // [kg], [m³], of the particles present
  // Of the particles at the start: they size the search for partners, which must be the same after a restart.
  Real smallest_radius_ = 0, largest_radius_ = 0;  // [m]
  std::int64_t outer_steps_since_sort_ = 0;
  std::int64_t steps_since_build_ = 0;
};

}  // namespace pellicle::dem
