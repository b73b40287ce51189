// Contacts with walls: the Mindlin spring.
#include "dem/wall_contact_kernel.hpp"

namespace pellicle::dem {

template void run_wall_contacts(const WallInput&, const ContactInput&, const Mindlin&, const ContactOptions&,
                                const ContactResult&);

}  // namespace pellicle::dem
