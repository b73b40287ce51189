// summary.json: what a run did, in numbers.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/ledger.hpp"
#include "core/timers.hpp"
#include "core/types.hpp"
#include "tools/pellicle/gas_boundary_figures.hpp"
#include "tools/pellicle/gas_convergence.hpp"
#include "tools/pellicle/spray_figures.hpp"
#include "tools/pellicle/wall_figures.hpp"

namespace pellicle::tools {

/// Everything that summary.json says; docs/results.md explains each entry. Written at the start (status running), at
/// every checkpoint and at the end, so that a run that was killed leaves one too.
struct Summary {
  std::string status = "running";  ///< running, done, stopped, failed
  std::string message;             ///< of a failed run
  std::string title, program_version, program_commit;
  double simulated_seconds = 0;
  double setup_seconds = 0;     ///< before the time loop: walls read, particles placed; over all resumes
  double wall_seconds = 0;      ///< of the time loop, over all resumes
  double settling_seconds = 0;  ///< of these, before t = 0
  std::array<double, core::part_count> wall_by_part{};
  int threads = 0;
  std::int64_t particles = 0;
  double particle_steps = 0;  ///< particles x substeps, over all resumes
  double contacts_per_particle = 0;
  double largest_overlap = 0;        ///< [m]
  double largest_overlap_ratio = 0;  ///< overlap / radius
  double largest_impact_speed = 0;   ///< [m/s]
  std::int64_t peak_memory_bytes = 0;
  std::int64_t engine_bytes = 0;  ///< of particles, neighbours and contacts alone
  std::array<double, core::conserved_count> defects{};
  double instantaneous_momentum_defect =
      0;  ///< momentum given to the particles and not yet to the gas, over gross
  std::int64_t lost_particles = 0;
  std::int64_t particles_left_through_open_sides = 0;
  double mass_left = 0;        ///< with them [kg]
  SideFigures left_by_side{};  ///< the same for each side
  std::int64_t particles_fed = 0;
  double mass_fed = 0;         ///< [kg]
  std::int64_t gas_steps = 0;  ///< outer steps with gas
  GasConvergence gas;
  std::vector<WallFigures> walls;  ///< what each wall received
  std::vector<GasBoundaryFigures> gas_boundaries;
  SprayFigures spray;

  /// Particles x substeps / (contacts + neighbours + motion), all threads; 0 without particles.
  double particle_steps_per_second() const;
  double wall_seconds_per_simulated_second() const;

  void set_times(const core::Timers& timers);
  void set_defects(const core::Ledger& ledger);
};

/// Replaces the file; throws RunError.
void write_summary(const std::filesystem::path& path, const Summary& summary);

/// Throws RunError if it cannot be read or is no summary.
Summary read_summary(const std::filesystem::path& path);

/// The text that `pellicle report` prints: one line a fact, with units.
std::string report_text(const Summary& summary);

/// Largest resident memory of this process so far [bytes].
std::int64_t peak_memory_bytes();

}  // namespace pellicle::tools
