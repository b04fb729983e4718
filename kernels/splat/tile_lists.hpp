// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/project.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::splat {

/// Tiles of the CPU backend: wide, so that what is done once for a splat in a tile is done seldom, yet the
/// pixels of a tile fit the first cache beside its splats.
inline constexpr int kTileWidthPx = 32;
inline constexpr int kTileHeightPx = 16;

/// One splat in one tile.
struct TileEntry {
  std::uint32_t splat;  ///< row of Projected::splats
  /// A number such that the entries of splat i have [splat_starts[i], splat_starts[i + 1]) in the order of
  /// tiles: where a tile leaves what only the sum over a splat's tiles gives, without locks and in a fixed
  /// order.
  std::uint32_t slot;
  /// Which of the tile's blocks of 4x4 pixels it reaches, bit 8 row + column; never 0.
  std::uint32_t reached;
};

/// Which splats touch which tile of the picture, nearest first in each tile.
struct TileLists {
  int columns = 0;
  int rows = 0;
  std::vector<std::uint32_t> starts;  ///< [columns * rows + 1] into `entries`
  std::vector<TileEntry> entries;
  std::vector<std::uint32_t> splat_starts;  ///< [splats given + 1]

  [[nodiscard]] int tiles() const { return columns * rows; }
  /// Row by row.
  [[nodiscard]] std::span<const TileEntry> tile(int t) const {
    const auto i = static_cast<std::size_t>(t);
    return {entries.data() + starts[i], starts[i + 1] - starts[i]};
  }
};

/// What one run of splats touches.
struct TilePart {
  std::size_t first = 0, last = 0;     ///< splats [first, last)
  std::vector<std::uint32_t> tiles;    ///< splat by splat
  std::vector<std::uint32_t> reached;  ///< blocks, one an entry of `tiles`
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
