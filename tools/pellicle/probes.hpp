// Time series: at a point of the gas, over a plane, of one particle, of a wall, of an open side, of the whole bed (probes/NAME.csv), and
// distributions of a particle quantity (histograms/NAME.csv).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/checkpoint.hpp"
#include "core/csv.hpp"
#include "core/time_control.hpp"
#include "tools/pellicle/bed.hpp"
#include "tools/pellicle/case_spec.hpp"
#include "tools/pellicle/coating_figures.hpp"
#include "tools/pellicle/find_particle.hpp"
#include "tools/pellicle/gas_fields.hpp"
#include "tools/pellicle/plane_section.hpp"
#include "tools/pellicle/probe_average.hpp"
#include "tools/pellicle/results_folder.hpp"
#include "tools/pellicle/wall_figures.hpp"
#include "tools/pellicle/zone_outputs.hpp"

namespace pellicle::spray {
class ContactWetness;
class Spray;
}  // namespace pellicle::spray

namespace pellicle::tools {

/// The state that outputs look at, after an outer step. `host_particles()` copies the particles once a step at most,
/// and only if an output of that step asks for them.
struct OutputState {
  std::int64_t step = 0;
  Real time = 0;                               ///< [s]
  const ParticleColumns* particles = nullptr;  ///< null without particles
  const GasFields* gas = nullptr;              ///< null without gas
  ContactFigures contacts{};
  const std::vector<WallFigures>* walls = nullptr;              ///< of all walls of the case
  const SideFigures* sides = nullptr;                           ///< null without particles
  const Zones* zones = nullptr;                                 ///< null without particles
  const spray::Spray* spray = nullptr;                          ///< null without a spray
  const std::vector<spray::ContactWetness>* wetness = nullptr;  ///< null without particles

  /// Empty without particles.
  const HostParticles& host_particles() const;
  mutable std::optional<HostParticles> copied_particles{};
};

/// All probes of a case.
class Probes {
 public:
  /// With `resume_time` the files that are there are continued. Throws InputError for an unknown quantity, or a point
  /// probe without gas or outside its grid.
  Probes(const std::vector<ProbeSpec>& specs, core::TimeControl& time, const ResultsFolder& folder,
         const Box& domain, const CartesianGrid* gas_grid, std::optional<Real> resume_time);

  void sample(const OutputState& state);
  /// Hands all rows to the operating system and replaces the averages.
  void flush();

  /// What walls had received, and what had left, when their last rows were written; the averages.
  void save(core::CheckpointWriter& checkpoint) const;
  void load(const core::CheckpointReader& checkpoint);

 private:
  /// What a wall had received, or what had left through a side, at an earlier time.
  struct Past {
    WallFigures wall{};
    dem::SideTotals left{};
    Real time = 0;  ///< [s]
  };
  struct Probe {
    ProbeSpec spec;
    core::Schedule schedule;
    std::vector<int> quantities;  ///< positions in the list of the probe's kind
    Index cell = 0;               ///< of a point
    std::optional<PlaneSection> plane;
    core::CsvSeries file;
    Past row{};  ///< at the last row
    std::optional<ProbeAverage> average{};
    std::optional<Past> step =
        Past{};  ///< at the last outer step, with an average; unset if that is not known
  };
  /// One value a quantity; rates are means since `past`.
  std::vector<double> values(const Probe& probe, const OutputState& state, const Past& past) const;
  static void save(core::CheckpointWriter& checkpoint, const std::string& path, const Probe& probe,
                   const Past& past);
  static Past load(const core::CheckpointReader& checkpoint, const std::string& path, const Probe& probe);

  const ResultsFolder& folder_;
  std::vector<Probe> probes_;
  ParticleFinder finder_;
  Real floor_;
};

/// All histograms of a case: rows time, from, to, count or mass, density (share of the total per unit of the quantity); a
/// joint one has the second quantity's from and to behind those of the first, and the density per both units.
class Histograms {
 public:
  Histograms(const std::vector<HistogramSpec>& specs, core::TimeControl& time, const ResultsFolder& folder,
             std::optional<Real> resume_time);

  /// Those without `every` are taken at the end of the run alone (`last`).
  void sample(const OutputState& state, bool last = false);
  void flush();

 private:
  struct Histogram {
    HistogramSpec spec;
    core::Schedule schedule;
    int quantity = 0;
    int against = -1;  ///< -1: none
    core::CsvSeries file;
  };
  static void append(Histogram& histogram, const OutputState& state);
  std::vector<Histogram> histograms_;
};

}  // namespace pellicle::tools
