// The order of particles in memory: neighbours in space close together.
#pragma once

#include "dem/cell_grid.hpp"

namespace pellicle::dem {

/// Orders particles, sorted into cells (sort_into_cells), by cubes of 8 x 8 x 8 cells, within them by smaller and smaller
/// cubes (Morton 1966), so that few pairs are of different blocks of particles that follow one another. memory_order(k) is
/// the particle that belongs in place k. Depends on cells and ids alone, as the order of the cells does. `cube_start` is
/// scratch, made as large as need be.
void find_memory_order(const CellGrid& grid, const DeviceArray<std::int32_t>& cell_start,
                       const DeviceArray<std::int32_t>& order, DeviceArray<std::int32_t>& cube_start,
                       const DeviceArray<std::int32_t>& memory_order);

}  // namespace pellicle::dem
