// A warning without {fmt}, for files that nvcc reads, which cannot compile it.
#pragma once

#include <string_view>

namespace pellicle::core {

/// The same as log().warn of a text.
void warn(std::string_view text);

}  // namespace pellicle::core
