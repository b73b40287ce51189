// Mean and variance of numbers that come one after the other.
#pragma once

#include <Kokkos_Macros.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/types.hpp"

namespace pellicle::core {

/// Takes up the `samples`-th value in their mean and in the sum of the squares of their deviations from it, by Welford
/// (1962), Technometrics 4, 419; Youngs & Cramer (1971), Technometrics 13, 657. The sum of squares minus the square of
/// the sum, which is the same in exact arithmetic, loses a small fluctuation of a large mean to round-off.
KOKKOS_INLINE_FUNCTION void update_moments(Real value, std::int64_t samples, Real& mean, Real& squares) {
  const Real before = value - mean;
  mean += before / static_cast<Real>(samples);
  squares += before * (value - mean);
}

/// Moments of one series of numbers, in any unit. An outer step is as long as any other, so that a sample of each is a
/// mean over time.
struct RunningMoments {
  std::int64_t samples = 0;
  Real mean = 0;
  Real squares = 0;  ///< sum of (value - mean)^2

  KOKKOS_INLINE_FUNCTION void add(Real value) { update_moments(value, ++samples, mean, squares); }
  /// Root of the mean square deviation from the mean: the RMS of the fluctuation. Nan without samples.
  Real deviation() const {
    return samples > 0 ? std::sqrt(squares / static_cast<Real>(samples))
                       : std::numeric_limits<Real>::quiet_NaN();
  }
  /// The mean; nan without samples.
  Real mean_or_nan() const { return samples > 0 ? mean : std::numeric_limits<Real>::quiet_NaN(); }
};

}  // namespace pellicle::core
