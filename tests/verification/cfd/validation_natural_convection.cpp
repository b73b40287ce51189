// The heated cavity at a Rayleigh number that takes longer.
#include "tests/verification/cfd/heated_cavity.hpp"

namespace pellicle::cfd {
namespace {

TEST(NaturalConvection, MatchesDeVahlDavisAtRa1e5) {
  compare_cavity({1e5, 34.73, 68.59, 4.509}, 64, 0.4, 800, 0.02);
}

}  // namespace
}  // namespace pellicle::cfd
