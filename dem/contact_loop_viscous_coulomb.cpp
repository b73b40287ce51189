// The contact loop with friction that does not remember.
#include "dem/contact_kernel.hpp"

namespace pellicle::dem {

template void run_contact_loop(const ContactInput&, const ViscousCoulomb&, const ContactOptions&,
                               const ContactResult&);

}  // namespace pellicle::dem
