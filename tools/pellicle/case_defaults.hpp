// Defaults of a case that follow from other keys.
#pragma once

#include "core/key_reader.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// Fills in what a case file may leave out because it follows from other keys, and reports steps that are missing.
void fill_in_defaults(CaseSpec& spec, core::InputProblems& problems);

}  // namespace pellicle::tools
