// The contact loop with the Mindlin spring.
#include "dem/contact_kernel.hpp"

namespace pellicle::dem {

template void run_contact_loop(const ContactInput&, const Mindlin&, const ContactOptions&,
                               const ContactResult&);

}  // namespace pellicle::dem
