// A small owner of an HDF5 file: arrays, numbers and text by name. HDF5 itself stays out of this header.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pellicle::core {

/// Element types that are stored: double, float, int32_t, int64_t, uint8_t.
template <class T>
concept Hdf5Element = std::same_as<T, double> || std::same_as<T, float> || std::same_as<T, std::int32_t> ||
    std::same_as<T, std::int64_t> || std::same_as<T, std::uint8_t>;

/// An open HDF5 file. Names are paths such as "gas/pressure"; groups on the way are made as needed.
/// Every failure, a full disk included, throws RunError with the file, the name and the cause.
class Hdf5File {
 public:
  enum class Mode {
    create,
    read,
    append
  };  ///< create replaces an existing file; append also makes a new one

  Hdf5File(std::filesystem::path path, Mode mode);
  ~Hdf5File();  ///< closes; a failure to write then is lost, so call close() where it matters
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Writes an array; `shape` (slowest index first) has values.size() entries in all, default one dimension.
  template <Hdf5Element T>
  void write(std::string_view name, std::span<const T> values, std::span<const std::size_t> shape = {});
  /// A number or text as a data set of its own.
  void write_number(std::string_view name, double value);
  void write_number(std::string_view name, std::int64_t value);
  void write_text(std::string_view name, const std::string& text);

  /// Values in the file's order, converted to T.
  template <Hdf5Element T>
  std::vector<T> read(std::string_view name) const;
  double read_double(std::string_view name) const;
  std::int64_t read_int64(std::string_view name) const;
  std::string read_text(std::string_view name) const;

  bool has(std::string_view name) const;
  std::vector<std::size_t> shape(std::string_view name) const;
  bool holds_integers(std::string_view name) const;
  /// Names of the members of a group ("/" for the file), sorted.
  std::vector<std::string> members(std::string_view group) const;
  /// Removes a data set or a group with all its members.
  void remove(std::string_view name);

  /// Small facts attached to a data set or group, which must exist.
  void set_attribute(std::string_view object, std::string_view name, double value);
  void set_attribute(std::string_view object, std::string_view name, std::int64_t value);
  void set_attribute(std::string_view object, std::string_view name, const std::string& text);
  bool has_attribute(std::string_view object, std::string_view name) const;
  double attribute_double(std::string_view object, std::string_view name) const;
  std::int64_t attribute_int64(std::string_view object, std::string_view name) const;

  /// Hands everything to the operating system.
  void flush();
  void close();

  const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  std::int64_t file_ = -1;  ///< hid_t
};

}  // namespace pellicle::core
