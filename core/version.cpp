#include "core/version.hpp"

#include <Kokkos_Core.hpp>

#include <fmt/format.h>

#include "pellicle_build_info.hpp"

namespace pellicle {

std::string version() { return PELLICLE_VERSION; }

std::string commit() { return PELLICLE_COMMIT; }

std::string version_text() {
#if defined(__clang__)
  const std::string compiler =
      fmt::format("clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  const std::string compiler = fmt::format("gcc {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
  return fmt::format(
      "pellicle {}\ncommit   {}\nbuild    {}\nKokkos   {}.{}.{}, device {}, host {}\ncompiler {}\n",
      version(), commit(), PELLICLE_BUILD_TYPE, KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100,
      KOKKOS_VERSION % 100, Kokkos::DefaultExecutionSpace::name(), Kokkos::DefaultHostExecutionSpace::name(),
      compiler);
}

}  // namespace pellicle
