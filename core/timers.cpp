#include "core/timers.hpp"

#include <numeric>
#include <type_traits>

#include "core/views.hpp"

namespace pellicle::core {

namespace {

void wait_for_device() {
  if constexpr (!std::is_same_v<Device, Host>) Kokkos::fence("core::timers::scope");
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

Timers::Scope::Scope(Timers& timers, Part part) : timers_(timers), outer_(timers.current_), part_(part) {
  wait_for_device();
  timers_.current_ = this;
  begin_ = std::chrono::steady_clock::now();
}

Timers::Scope::~Scope() {
  wait_for_device();
  const double seconds = seconds_since(begin_);
  timers_.add(part_, seconds - inner_seconds_);
  if (outer_ != nullptr) outer_->inner_seconds_ += seconds;
  timers_.current_ = outer_;
}

double Timers::total() const { return std::accumulate(seconds_.begin(), seconds_.end(), 0.0); }

double wall_clock() {
  static const auto begin = std::chrono::steady_clock::now();
  return seconds_since(begin);
}

}  // namespace pellicle::core
