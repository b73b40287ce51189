// Liquid bridges between particles: forces, and when bridges form and break.
#pragma once

#include "dem/cohesion_laws.hpp"
#include "dem/contact_loop.hpp"

namespace pellicle::dem {

/// How far apart two particles can be and still be bridged, as a share for each particle: the
/// gap at rupture is the sum of the two, exactly, (1 + θ/2)(V^⅓/2 + V^⅔/(20 R)) [m].
Real bridge_reach(const Willett& law, Real radius);

/// Adds the attraction of all bridges at this moment to the forces, and keeps account of them in `result.springs.bridge`: a
/// bridge forms where two particles touch and lasts until the gap exceeds its rupture distance. `result.report` gets
/// their number, and what they gave to fixed particles. The list must reach as far as bridges do.
void add_bridge_forces(const ContactInput& input, const Willett& law, const ContactResult& result);

}  // namespace pellicle::dem
