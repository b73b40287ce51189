// Contacts with walls: friction without history.
#include "dem/wall_contact_kernel.hpp"

namespace pellicle::dem {

template void run_wall_contacts(const WallInput&, const ContactInput&, const ViscousCoulomb&,
                                const ContactOptions&, const ContactResult&);

}  // namespace pellicle::dem
