// How kernels over blocks that cost differently are shared among threads.
#pragma once

#include "core/views.hpp"

namespace pellicle::dem {

#ifndef KOKKOS_ENABLE_CUDA
/// Work items in the hands of teams of one thread.
template <class Kernel>
struct BlockOfTeam {
  using Policy = Kokkos::TeamPolicy<Device, Kokkos::Schedule<Kokkos::Dynamic>>;
  Kernel kernel;
  void operator()(const typename Policy::member_type& team) const { kernel(team.league_rank()); }
};
#endif

/// Runs a kernel over blocks. On a CPU each thread begins with its own part of them, `chunk` after the other: that is what a
/// block expects that asks for the memory of the next, and no two threads write to neighbouring lines. A thread that is
/// done takes from the end of another's part.
template <class Kernel>
void run_blocks(const char* label, Index blocks, [[maybe_unused]] int chunk, const Kernel& kernel) {
#ifndef KOKKOS_ENABLE_CUDA
  using Team = BlockOfTeam<Kernel>;
  Kokkos::parallel_for(label, typename Team::Policy(blocks, 1).set_chunk_size(chunk), Team{kernel});
#else
  Kokkos::parallel_for(label, DeviceRange(0, blocks), kernel);
#endif
}

}  // namespace pellicle::dem
