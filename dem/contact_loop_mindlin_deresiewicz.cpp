// The contact loop with the spring of Mindlin and Deresiewicz.
#include "dem/contact_kernel.hpp"

namespace pellicle::dem {

template void run_contact_loop(const ContactInput&, const MindlinDeresiewicz&, const ContactOptions&,
                               const ContactResult&);

}  // namespace pellicle::dem
