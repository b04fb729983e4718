// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/project.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::splat {

inline constexpr int kTilePx = 16;

/// Which splats touch which tile of the picture, nearest first in each tile.
struct TileLists {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint32_t> starts;  ///< [columns * rows + 1] into `splats`
  std::vector<std::uint32_t> splats;  ///< rows of Projected::splats
  /// For each entry of `splats` which of the tile's 16 blocks of 4x4 pixels it reaches, bit 4 row + column;
  /// never 0.
  std::vector<std::uint16_t> reached;
  /// A number for each entry of `splats` such that the entries of splat i have [splat_starts[i],
  /// splat_starts[i + 1]) in the order of tiles: where a tile leaves what only the sum over a splat's tiles
  /// gives, without locks and in a fixed order.
  std::vector<std::uint32_t> slots;
  std::vector<std::uint32_t> splat_starts;  ///< [splats given + 1]

  [[nodiscard]] std::span<const std::uint32_t> tile(int column, int row) const {
    return of_tile(splats, column, row);
  }
  [[nodiscard]] std::span<const std::uint16_t> tile_reached(int column, int row) const {
    return of_tile(reached, column, row);
  }
  [[nodiscard]] std::span<const std::uint32_t> tile_slots(int column, int row) const {
    return of_tile(slots, column, row);
  }

 private:
  template <typename T>
  [[nodiscard]] std::span<const T> of_tile(const std::vector<T>& entries, int column, int row) const {
    const auto t = static_cast<std::size_t>(row * columns + column);
    return {entries.data() + starts[t], starts[t + 1] - starts[t]};
  }
};

/// What one run of splats touches.
struct TilePart {
  std::size_t first = 0, last = 0;     ///< splats [first, last)
  std::vector<std::uint32_t> tiles;    ///< splat by splat
  std::vector<std::uint16_t> reached;  ///< blocks, one an entry of `tiles`
  std::vector<std::uint32_t> counts;   ///< of tiles, one a splat
  std::vector<std::uint32_t> places;   ///< one a tile: first how many, then where the next goes
};

/// Memory that one call leaves for the next.
struct TileListsScratch {
  std::vector<TilePart> parts;
};

/// Bins depth-sorted splats into tiles: a tile gets a splat when alpha reaches 1/255 somewhere in it (the box
/// around the ellipse, then the exact distance of the ellipse to each block of pixels). Deterministic. `out`
/// is written whole, its memory used again.
void make_tile_lists(std::span<const Splat> splats, int width_px, int height_px, TileListsScratch& scratch,
                     TileLists& out);
/// The same for once.
[[nodiscard]] TileLists make_tile_lists(std::span<const Splat> splats, int width_px, int height_px);

}  // namespace edgesplat::splat
