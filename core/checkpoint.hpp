// The state of a run on disk, and getting it back. A checkpoint holds the state to the last bit and nothing that
// depends on a clock or on the number of threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::core {

/// Anything contiguous with data() and size(): std::vector, a host View of rank 1.
template <class A>
concept ContiguousArray = requires(const A& a) {
  a.data();
  a.size();
}
&&!std::is_convertible_v<A, std::string_view>;

/// Writes a checkpoint. Everything goes to PATH.tmp, which replaces PATH on close(): whatever happens before that,
/// a crash or a full disk (RunError), leaves the previous checkpoint as it was. Names look like "gas/pressure".
class CheckpointWriter {
 public:
  explicit CheckpointWriter(std::filesystem::path path);
  ~CheckpointWriter();  ///< without close() before: discards what was written
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  void write(std::string_view name, std::span<const double> values);
  void write(std::string_view name, std::span<const std::int32_t> values);
  void write(std::string_view name, std::span<const std::int64_t> values);
  void write(std::string_view name, std::span<const Vec3> values);  ///< stored as n x 3
  void write(std::string_view name, double value);
  void write(std::string_view name, std::int64_t value);
  void write(std::string_view name, std::int32_t value) { write(name, std::int64_t{value}); }
  void write(std::string_view name, const Vec3& value) { write(name, std::span<const Vec3>(&value, 1)); }
  void write(std::string_view name, const std::string& text);
  void write(std::string_view name, const char* text) { write(name, std::string(text)); }
  /// Raw bytes, for arrays of structs without padding; the struct's layout is then part of the format.
  void write_bytes(std::string_view name, std::span<const std::byte> bytes);

  template <ContiguousArray A>
  void write(std::string_view name, const A& array) {
    using T = std::remove_cvref_t<decltype(*array.data())>;
    if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::int32_t> ||
                  std::is_same_v<T, std::int64_t> || std::is_same_v<T, Vec3>) {
      write(name, std::span<const T>(array.data(), array.size()));
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      write_bytes(name, std::as_bytes(std::span<const T>(array.data(), array.size())));
    }
  }

  /// Flushes to disk and replaces the old checkpoint.
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads a checkpoint. A file that is missing, damaged or of another format throws InputError, a name that is
/// missing or of another size RunError.
class CheckpointReader {
 public:
  explicit CheckpointReader(std::filesystem::path path);
  ~CheckpointReader();

  std::vector<double> read_doubles(std::string_view name) const;
  std::vector<std::int32_t> read_int32s(std::string_view name) const;
  std::vector<std::int64_t> read_int64s(std::string_view name) const;
  std::vector<Vec3> read_vec3s(std::string_view name) const;
  double read_double(std::string_view name) const;
  std::int64_t read_int64(std::string_view name) const;
  Vec3 read_vec3(std::string_view name) const;
  std::string read_string(std::string_view name) const;
  std::vector<std::byte> read_bytes(std::string_view name) const;
  bool has(std::string_view name) const;

  /// Fills an array that has the right size already; throws RunError with both sizes if it has not.
  template <ContiguousArray A>
  void read_into(std::string_view name, A&& array) const {
    using T = std::remove_cvref_t<decltype(*array.data())>;
    const auto take = [&](const auto& values) {
      copy(name, std::as_bytes(std::span(values.data(), values.size())), array.data(),
           array.size() * sizeof(T));
    };
    if constexpr (std::is_same_v<T, double>) {
      take(read_doubles(name));
    } else if constexpr (std::is_same_v<T, std::int32_t>) {
      take(read_int32s(name));
    } else if constexpr (std::is_same_v<T, std::int64_t>) {
      take(read_int64s(name));
    } else if constexpr (std::is_same_v<T, Vec3>) {
      take(read_vec3s(name));
    } else {
      static_assert(std::is_trivially_copyable_v<T>);
      take(read_bytes(name));
    }
  }

 private:
  void copy(std::string_view name, std::span<const std::byte> from, void* to, std::size_t size) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Refuses to go on with another case: compares two resolved case files (YAML text) key by key and throws InputError
/// naming the first keys that differ, with both values. What may change is `title`, `time.end` and all of `output`.
void require_same_case(const std::string& checkpoint_case, const std::string& present_case);

}  // namespace pellicle::core
