// Where the gas's large fields lie: side by side in few allocations in huge pages. A loop over the gas goes through
// twenty or thirty fields at once; with pages of 4 kB it spends half its time looking up where they are.
#pragma once

#include <string>
#include <tuple>

#include "core/types.hpp"
#include "core/views.hpp"

namespace pellicle::cfd {

/// Memory for the fields made on this thread from its construction until `close` or its end. The fields share in the
/// memory and may outlive it.
class FieldMemory {
 public:
  FieldMemory();
  ~FieldMemory() { close(); }
  FieldMemory(const FieldMemory&) = delete;
  FieldMemory& operator=(const FieldMemory&) = delete;
  void close();

  /// `count` zeros; T is Real or float.
  template <class T>
  HostArray<T> take(std::size_t count);
  static FieldMemory* current();

 private:
  template <class T>
  struct Slab {
    HostArray<T> memory;
    std::size_t used = 0;
  };
  std::tuple<Slab<Real>, Slab<float>> slabs_;
  FieldMemory* before_ = nullptr;
};

/// A field of `count` zeros: of the memory at hand if it is large, else an allocation of its own with this label.
template <class T>
HostArray<T> make_field(const std::string& label, std::size_t count);

}  // namespace pellicle::cfd
