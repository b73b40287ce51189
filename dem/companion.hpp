// State of other folders that belongs to the particles and must follow them through memory.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "core/checkpoint.hpp"
#include "core/types.hpp"
#include "core/views.hpp"
#include "dem/engine_arrays.hpp"
#include "dem/permute.hpp"

namespace pellicle::dem {

/// What an engine tells those that keep something per particle, in the order of its own arrays: entry p belongs to the
/// particle p of now. See Engine::attach.
class Companion {
 public:
  virtual ~Companion() = default;
  /// All particles are new; the entries of `count` of them begin anew.
  virtual void reset(Index count) = 0;
  /// Particles `first` to `first + count - 1` have been added behind the others; their entries begin anew.
  virtual void add(Index first, Index count) = 0;
  /// Entry p becomes what was entry order(p), for p below `count`; there were `before`. The particles order(count) to
  /// order(before - 1) leave. The engine's own arrays are still in the old order. `scratch` holds 48 bytes a particle and starts on a cache line.
  virtual void reorder(const DeviceArray<std::int32_t>& order, Index before, Index count,
                       const DeviceArray<Real>& scratch) = 0;
  /// With the engine's own arrays, in the same order.
  virtual void save(core::CheckpointWriter& file, Index count) const = 0;
  virtual void load(const core::CheckpointReader& file, Index count) = 0;
  /// Device memory [bytes].
  virtual std::size_t bytes() const = 0;

 protected:
  Companion() = default;
  Companion(const Companion&) = default;
  Companion& operator=(const Companion&) = default;
};

/// One value a particle. T has no padding and at most 48 bytes.
template <class T>
class FollowingArray final : public Companion {
 public:
  static_assert(sizeof(T) <= 6 * sizeof(Real) && std::is_trivially_copyable_v<T>);

  /// `label` names its memory, `checkpoint_name` its entry in a checkpoint; new particles have `initial`.
  FollowingArray(std::string label, std::string checkpoint_name, const T& initial = {})
      : label_(std::move(label)), checkpoint_name_(std::move(checkpoint_name)), initial_(initial) {}

  /// At least as long as there are particles.
  const DeviceArray<T>& values() const { return values_; }
  const T& initial() const { return initial_; }

  void reset(Index count) override {
    values_ = DeviceArray<T>(Kokkos::view_alloc(label_, Kokkos::WithoutInitializing),
                             static_cast<std::size_t>(count));
    fill(0, count);
  }

  void add(Index first, Index count) override {
    const auto total = static_cast<std::size_t>(first) + static_cast<std::size_t>(count);
    if (values_.extent(0) < total) {
      const DeviceArray<T> before = values_;
      values_ = DeviceArray<T>(Kokkos::view_alloc(label_, Kokkos::WithoutInitializing), total + total / 4);
      const std::pair<Index, Index> kept(0, first);
      if (first > 0) Kokkos::deep_copy(Kokkos::subview(values_, kept), Kokkos::subview(before, kept));
    }
    fill(first, count);
  }

  void reorder(const DeviceArray<std::int32_t>& order, Index /*before*/, Index count,
               const DeviceArray<Real>& scratch) override {
    permute_array(values_, order, count, scratch);
  }

  void save(core::CheckpointWriter& file, Index count) const override {
    if (count > 0) file.write(checkpoint_name_, host_copy(values_, count));
  }

  void load(const core::CheckpointReader& file, Index count) override {
    reset(count);
    if (count > 0) read_array(file, checkpoint_name_.c_str(), count, values_, "dem::companion::loaded");
  }

  std::size_t bytes() const override { return bytes_of(values_); }

 private:
  void fill(Index first, Index count) {
    const std::pair<Index, Index> range(first, first + count);
    if (count > 0) Kokkos::deep_copy(Kokkos::subview(values_, range), initial_);
  }

  std::string label_, checkpoint_name_;
  T initial_;
  DeviceArray<T> values_;
};

}  // namespace pellicle::dem
