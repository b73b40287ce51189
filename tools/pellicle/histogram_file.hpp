// All histograms of a run in one HDF5 file, beside their CSV files.
#pragma once

#include <filesystem>

namespace pellicle::tools {

/// Replaces histograms.h5 in the results folder by what histograms/*.csv hold. One group a file, in it `time` [times]
/// and each other column as [times, bins], with its `unit` as an attribute. Writes nothing without such files. Throws
/// RunError.
void write_histogram_file(const std::filesystem::path& folder);

}  // namespace pellicle::tools
