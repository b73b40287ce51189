// Basic scalar types of the whole project.
#pragma once

#include <cstdint>

namespace pellicle {

/// Floating-point type of all physics. SI units throughout.
using Real = double;

/// Index of a cell, face or particle; a single run holds fewer than 2^31 of each.
using Index = std::int32_t;

}  // namespace pellicle
