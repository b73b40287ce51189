#include "core/hdf5_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "core/error.hpp"

namespace pellicle::core {

namespace {

static_assert(std::is_same_v<hid_t, std::int64_t>, "HDF5 1.10 or newer");

using CloseFunction = herr_t (*)(hid_t);

/// Closes an HDF5 handle at the end of its scope.
class Handle {
 public:
  Handle(hid_t id, CloseFunction closer) : id_(id), closer_(closer) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), closer_(other.closer_) {}
  ~Handle() {
    if (id_ >= 0) closer_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  bool ok() const { return id_ >= 0; }
  /// Closes now, so that a failure can be seen.
  bool close() { return closer_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_;
  CloseFunction closer_;
};

template <class T>
hid_t memory_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
}

/// The deepest message of the error stack: the cause, with the system's text for a full disk.
std::string cause() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned depth, const H5E_error2_t* error, void* out) -> herr_t {
        if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(out) = error->desc;
        return 0;
      },
      &text);
  // The low-level text lists buffer addresses and offsets after the system's message.
  const auto system = text.find("error message = '");
  if (system != std::string::npos) {
    const auto begin = system + std::strlen("error message = '");
    text = text.substr(begin, text.find('\'', begin) - begin);
  }
  return text.empty() ? "unknown cause" : text;
}

Handle link_properties() {
  Handle properties(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(properties, 1);
  return properties;
}

/// Without the library's file locks: somebody who looks at a running simulation must not make it fail.
Handle access_properties() {
  Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(properties, false, true);
  return properties;
}

}  // namespace

Hdf5File::Hdf5File(std::filesystem::path path, Mode mode) : path_(std::move(path)) {
  // Failures are reported by exceptions; HDF5 would print its own stack besides.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const std::string name = path_.string();
  const bool exists = std::filesystem::exists(path_);
  const Handle unlocked = access_properties();
  if (mode == Mode::create || (mode == Mode::append && !exists)) {
    file_ = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, unlocked);
  } else {
    file_ = H5Fopen(name.c_str(), mode == Mode::read ? H5F_ACC_RDONLY : H5F_ACC_RDWR, unlocked);
  }
  if (file_ < 0) fail(mode == Mode::create ? "cannot be created" : "cannot be opened");
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::fail(const std::string& what) const {
  throw RunError(fmt::format("{}: {}: {}", path_.string(), what, cause()));
}

template <Hdf5Element T>
void Hdf5File::write(std::string_view name, std::span<const T> values, std::span<const std::size_t> shape) {
  std::vector<hsize_t> extent(shape.begin(), shape.end());
  if (extent.empty()) extent = {values.size()};
  const std::string key(name);
  const Handle space(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
  const Handle properties = link_properties();
  Handle data(H5Dcreate2(file_, key.c_str(), memory_type<T>(), space, properties, H5P_DEFAULT, H5P_DEFAULT),
              H5Dclose);
  if (!data.ok()) fail(fmt::format("{} cannot be created", key));
  if (!values.empty() && H5Dwrite(data, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    fail(fmt::format("{} cannot be written", key));
  }
  if (!data.close()) fail(fmt::format("{} cannot be written", key));
}

template <Hdf5Element T>
std::vector<T> Hdf5File::read(std::string_view name) const {
  const std::string key(name);
  const Handle data(H5Dopen2(file_, key.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.ok()) fail(fmt::format("{} is missing", key));
  const Handle space(H5Dget_space(data), H5Sclose);
  std::vector<T> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (!values.empty() && H5Dread(data, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    fail(fmt::format("{} cannot be read", key));
  }
  return values;
}

template void Hdf5File::write(std::string_view, std::span<const double>, std::span<const std::size_t>);
template void Hdf5File::write(std::string_view, std::span<const float>, std::span<const std::size_t>);
template void Hdf5File::write(std::string_view, std::span<const std::int32_t>, std::span<const std::size_t>);
template void Hdf5File::write(std::string_view, std::span<const std::int64_t>, std::span<const std::size_t>);
template void Hdf5File::write(std::string_view, std::span<const std::uint8_t>, std::span<const std::size_t>);
template std::vector<double> Hdf5File::read(std::string_view) const;
template std::vector<float> Hdf5File::read(std::string_view) const;
template std::vector<std::int32_t> Hdf5File::read(std::string_view) const;
template std::vector<std::int64_t> Hdf5File::read(std::string_view) const;
template std::vector<std::uint8_t> Hdf5File::read(std::string_view) const;

void Hdf5File::write_number(std::string_view name, double value) { write<double>(name, {&value, 1}); }
void Hdf5File::write_number(std::string_view name, std::int64_t value) {
  write<std::int64_t>(name, {&value, 1});
}

void Hdf5File::write_text(std::string_view name, const std::string& text) {
  // Bytes, since a fixed-length HDF5 string cannot be empty.
  write<std::uint8_t>(name, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

double Hdf5File::read_double(std::string_view name) const {
  const auto values = read<double>(name);
  if (values.size() != 1) fail(fmt::format("{} is not one number", name));
  return values.front();
}

std::int64_t Hdf5File::read_int64(std::string_view name) const {
  const auto values = read<std::int64_t>(name);
  if (values.size() != 1) fail(fmt::format("{} is not one number", name));
  return values.front();
}

std::string Hdf5File::read_text(std::string_view name) const {
  const auto bytes = read<std::uint8_t>(name);
  return {bytes.begin(), bytes.end()};
}

bool Hdf5File::has(std::string_view name) const {
  // H5Lexists fails where a group on the way is missing, so ask for each in turn.
  const std::string key(name);
  for (std::size_t end = key.find('/', 1);; end = key.find('/', end + 1)) {
    if (key.substr(0, end) == "/") return true;
    if (H5Lexists(file_, key.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<std::size_t> Hdf5File::shape(std::string_view name) const {
  const std::string key(name);
  const Handle data(H5Dopen2(file_, key.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.ok()) fail(fmt::format("{} is missing", key));
  const Handle space(H5Dget_space(data), H5Sclose);
  std::vector<hsize_t> extent(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  return {extent.begin(), extent.end()};
}

bool Hdf5File::holds_integers(std::string_view name) const {
  const Handle data(H5Dopen2(file_, std::string(name).c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.ok()) fail(fmt::format("{} is missing", name));
  const Handle type(H5Dget_type(data), H5Tclose);
  return H5Tget_class(type) == H5T_INTEGER;
}

std::vector<std::string> Hdf5File::members(std::string_view group) const {
  const Handle id(H5Gopen2(file_, std::string(group).c_str(), H5P_DEFAULT), H5Gclose);
  if (!id.ok()) fail(fmt::format("group {} is missing", group));
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  if (H5Literate(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0) {
    fail(fmt::format("group {} cannot be read", group));
  }
  return names;
}

void Hdf5File::remove(std::string_view name) {
  if (H5Ldelete(file_, std::string(name).c_str(), H5P_DEFAULT) < 0)
    fail(fmt::format("{} cannot be removed", name));
}

namespace {

bool write_attribute(hid_t file, std::string_view object, std::string_view name, hid_t type, hid_t space,
                     const void* value) {
  const std::string owner(object), key(name);
  if (H5Aexists_by_name(file, owner.c_str(), key.c_str(), H5P_DEFAULT) > 0) {
    H5Adelete_by_name(file, owner.c_str(), key.c_str(), H5P_DEFAULT);
  }
  const Handle attribute(
      H5Acreate_by_name(file, owner.c_str(), key.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  return attribute.ok() && H5Awrite(attribute, type, value) >= 0;
}

bool read_attribute(hid_t file, std::string_view object, std::string_view name, hid_t type, void* value) {
  const Handle attribute(
      H5Aopen_by_name(file, std::string(object).c_str(), std::string(name).c_str(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  return attribute.ok() && H5Aread(attribute, type, value) >= 0;
}

}  // namespace

void Hdf5File::set_attribute(std::string_view object, std::string_view name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  if (!write_attribute(file_, object, name, H5T_NATIVE_DOUBLE, space, &value)) {
    fail(fmt::format("attribute {} of {} cannot be written", name, object));
  }
}

void Hdf5File::set_attribute(std::string_view object, std::string_view name, std::int64_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  if (!write_attribute(file_, object, name, H5T_NATIVE_INT64, space, &value)) {
    fail(fmt::format("attribute {} of {} cannot be written", name, object));
  }
}

void Hdf5File::set_attribute(std::string_view object, std::string_view name, const std::string& text) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(text.size(), 1));
  if (!write_attribute(file_, object, name, type, space, text.c_str())) {
    fail(fmt::format("attribute {} of {} cannot be written", name, object));
  }
}

bool Hdf5File::has_attribute(std::string_view object, std::string_view name) const {
  return H5Aexists_by_name(file_, std::string(object).c_str(), std::string(name).c_str(), H5P_DEFAULT) > 0;
}

double Hdf5File::attribute_double(std::string_view object, std::string_view name) const {
  double value = 0;
  if (!read_attribute(file_, object, name, H5T_NATIVE_DOUBLE, &value)) {
    fail(fmt::format("attribute {} of {} is missing", name, object));
  }
  return value;
}

std::int64_t Hdf5File::attribute_int64(std::string_view object, std::string_view name) const {
  std::int64_t value = 0;
  if (!read_attribute(file_, object, name, H5T_NATIVE_INT64, &value)) {
    fail(fmt::format("attribute {} of {} is missing", name, object));
  }
  return value;
}

void Hdf5File::flush() {
  if (H5Fflush(file_, H5F_SCOPE_GLOBAL) < 0) fail("cannot be written");
}

void Hdf5File::close() {
  if (file_ < 0) return;
  // Flushing first tells a full disk apart; closing alone may report it too late to name the file.
  flush();
  if (H5Fclose(std::exchange(file_, -1)) < 0) fail("cannot be closed");
}

}  // namespace pellicle::core
