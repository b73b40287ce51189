// Contacts with walls: the spring of Mindlin and Deresiewicz.
#include "dem/wall_contact_kernel.hpp"

namespace pellicle::dem {

template void run_wall_contacts(const WallInput&, const ContactInput&, const MindlinDeresiewicz&,
                                const ContactOptions&, const ContactResult&);

}  // namespace pellicle::dem
