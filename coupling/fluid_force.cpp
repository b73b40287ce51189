#include "coupling/fluid_force.hpp"

#include "dem/motion.hpp"

namespace pellicle::dem {

// The kernel that moves particles in gas is used from tools/, which the CUDA check does not compile: here it does.
template void move_particles(const Particles&, const ContactResult&, const NeighbourList&, const Domain&,
                             const MotionStep&, const coupling::FixedCoefficientForce&, const MotionFlagsView&);
template void move_particles(const Particles&, const ContactResult&, const NeighbourList&, const Domain&,
                             const MotionStep&, const coupling::FollowingCoefficientForce&, const MotionFlagsView&);

}  // namespace pellicle::dem
