#include "dem/motion.hpp"

namespace pellicle::dem {

// Compiled once, here, where the CUDA check sees it too.
template void move_particles(const Particles&, const ContactResult&, const NeighbourList&, const Domain&,
                             const MotionStep&, const NoFluid&, const MotionFlagsView&);

}  // namespace pellicle::dem
