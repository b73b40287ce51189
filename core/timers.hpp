// Where the wall time goes.
#pragma once

#include <array>
#include <chrono>
#include <string_view>

namespace pellicle::core {

/// Parts of the time loop, as in summary.json's wall_by_part.
enum class Part { contacts, neighbours, motion, coupling, gas, spray, heat, output };
inline constexpr int part_count = 8;
inline constexpr std::array<std::string_view, part_count> part_names{
    "contacts", "neighbours", "motion", "coupling", "gas", "spray", "heat", "output"};

/// Wall-clock seconds of each part. Scopes may nest: the inner part's time is then not counted for the outer one.
/// Costs two clock readings a scope (about 50 ns); on a GPU the scope waits for its kernels, else it would time
/// their launch only.
class Timers {
 public:
  class Scope {
   public:
    Scope(Timers& timers, Part part);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Timers& timers_;
    Scope* outer_;
    Part part_;
    std::chrono::steady_clock::time_point begin_;
    double inner_seconds_ = 0;
  };

  double seconds(Part part) const { return seconds_[static_cast<std::size_t>(part)]; }
  double total() const;
  void add(Part part, double seconds) { seconds_[static_cast<std::size_t>(part)] += seconds; }
  void reset() { seconds_.fill(0); }

 private:
  std::array<double, part_count> seconds_{};
  Scope* current_ = nullptr;
};

/// Seconds of wall time since a moment that stays the same through the program.
double wall_clock();

}  // namespace pellicle::core
