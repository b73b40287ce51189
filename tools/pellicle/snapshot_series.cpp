#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/hdf5_file.hpp"
#include "core/log.hpp"
#include "tools/pellicle/snapshots.hpp"

namespace pellicle::tools {

namespace {

constexpr const char* group_prefix = "step";

std::string group_name(std::int64_t step) { return fmt::format("{}{:010}", group_prefix, step); }

}  // namespace

std::vector<SnapshotArray> arrays_of(const core::Hdf5File& file, const std::string& group) {
  std::vector<SnapshotArray> arrays;
  for (const auto& name : file.members(group)) {
    const std::string path = group + "/" + name;
    arrays.push_back({name, file.shape(path), file.holds_integers(path)});
  }
  return arrays;
}

SnapshotSeries::SnapshotSeries(const std::filesystem::path& folder, const std::string& name,
                               DescribeSnapshot describe, std::optional<std::int64_t> resume_step)
    : h5_(folder / (name + ".h5")), describe_(std::move(describe)) {
  if (resume_step && std::filesystem::exists(h5_)) {
    try {
      resume(*resume_step);
    } catch (const RunError& error) {
      std::filesystem::path aside = h5_;
      aside += ".damaged";
      std::filesystem::rename(h5_, aside);
      core::log().warn("{}; it is kept as {}, and a new file holds the snapshots from now on", error.what(),
                       aside.filename().string());
      records_.clear();
    }
  } else {
    std::filesystem::remove(h5_);
    std::filesystem::remove(std::filesystem::path(h5_).replace_extension(".xdmf"));
  }
}

void SnapshotSeries::resume(std::int64_t step) {
  core::Hdf5File file(h5_, core::Hdf5File::Mode::append);
  for (const auto& group : file.members("/")) {
    if (!group.starts_with(group_prefix)) continue;
    // A group without its attributes is the one that was being written when the run was killed.
    const bool complete = file.has_attribute(group, "step") && file.has_attribute(group, "time");
    if (!complete || file.attribute_int64(group, "step") > step) {
      file.remove(group);
      continue;
    }
    records_.push_back({group, file.attribute_int64(group, "step"), file.attribute_double(group, "time"),
                        arrays_of(file, group)});
  }
  file.close();
  std::sort(records_.begin(), records_.end(), [](const auto& a, const auto& b) { return a.step < b.step; });
}

void SnapshotSeries::write_once(const std::string& name, const std::function<void(core::Hdf5File&)>& write) {
  core::Hdf5File file(h5_, core::Hdf5File::Mode::append);
  if (!file.has(name)) write(file);
  file.close();
}

std::vector<std::size_t> SnapshotSeries::shape(const std::string& name) const {
  if (!std::filesystem::exists(h5_)) return {};
  const core::Hdf5File file(h5_, core::Hdf5File::Mode::read);
  return file.has(name) ? file.shape(name) : std::vector<std::size_t>{};
}

void SnapshotSeries::add(std::int64_t step, Real time,
                         const std::function<void(core::Hdf5File&, const std::string& group)>& write) {
  const std::string group = group_name(step);
  core::Hdf5File file(h5_, core::Hdf5File::Mode::append);
  if (file.has(group)) {
    file.remove(group);
    std::erase_if(records_, [&](const auto& record) { return record.group == group; });
  }
  write(file, group);
  file.set_attribute(group, "step", step);
  file.set_attribute(group, "time", time);
  records_.push_back({group, step, time, arrays_of(file, group)});
  file.close();
  write_xdmf();
}

void write_xdmf(const std::filesystem::path& h5, const std::vector<SnapshotRecord>& records,
                const DescribeSnapshot& describe) {
  std::string text =
      "<?xml version=\"1.0\" ?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
      "<Grid Name=\"series\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  const std::string h5_name = h5.filename().string();
  for (const auto& record : records) {
    text += fmt::format("<Grid Name=\"{}\" GridType=\"Uniform\">\n<Time Value=\"{:.12g}\"/>\n{}</Grid>\n",
                        record.group, record.time, describe(h5_name, record));
  }
  text += "</Grid>\n</Domain>\n</Xdmf>\n";
  core::write_file_atomically(std::filesystem::path(h5).replace_extension(".xdmf"), text);
}

}  // namespace pellicle::tools
