// Whether a checkpoint's counts of a region are those of the region at hand. Apart from the kernels: nvcc cannot read {fmt}'s
// checked format strings.
#pragma once

#include <string>

#include "core/checkpoint.hpp"

namespace pellicle::spray {

struct ZoneOptions;
struct WetnessOptions;

/// All that makes a zone another one.
std::string identity_of(const ZoneOptions& options);
/// Likewise a region of contacts.
std::string identity_of(const WetnessOptions& options);

/// Whether the checkpoint holds `identity` at `path`; if not, warns that the counts of `what` begin now.
bool goes_on(const core::CheckpointReader& file, const std::string& path, const std::string& identity,
             const std::string& what);

}  // namespace pellicle::spray
