// Which particles may touch which surfaces of the walls before the next search.
#pragma once

#include "dem/cohesion_laws.hpp"
#include "dem/neighbour_list.hpp"
#include "dem/particles.hpp"
#include "dem/wall_geometry.hpp"

namespace pellicle::dem {

/// The particles that may touch a wall, each with a row of surfaces, in compressed rows.
struct WallList {
  Index count = 0;                     ///< particles near a wall
  DeviceArray<std::int32_t> particle;  ///< their indices, ascending
  DeviceArray<std::int32_t> offset;    ///< count + 1: row k is entries offset(k) … offset(k + 1)
  DeviceArray<std::int32_t> surface;   ///< numbers of surfaces, row by row
  DeviceArray<std::uint8_t> near;      ///< of every particle: whether it is in the list
};

/// Finds the surfaces within reach of each moving particle: its radius, `allowances` times its allowance of the neighbour
/// list, the wall's allowance, and what the liquid bridges of `cohesion` span. One allowance reaches to the next build if the neighbour list has just been built,
/// two at any later moment. A fixed particle has no walls: it may stand in one as far as it likes.
void build_wall_list(const Particles& particles, const NeighbourList& neighbours, Real allowances,
                     const WallGeometry& walls, WallList& list, const Willett& cohesion = {});

}  // namespace pellicle::dem
