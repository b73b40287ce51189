// Where droplets go within the cone of a nozzle.
#pragma once

namespace pellicle::spray {

/// Full: everywhere in it. Hollow: between it and a narrower one.
enum class SprayPattern { full, hollow };

}  // namespace pellicle::spray
