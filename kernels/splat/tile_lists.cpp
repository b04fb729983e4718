// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/tile_lists.hpp"

#include "kernels/splat/splat_one.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgesplat::splat {
namespace {

struct Range {
  int first, last;  ///< [first, last)
};

Range tiles_touched(float centre_px, float half_px, int tiles) {
  const auto clamp_tile = [tiles](float px) {
    return static_cast<int>(std::clamp(px / static_cast<float>(kTilePx), -1.0F, static_cast<float>(tiles)));
  };
  // Tile t covers pixel centres [16 t, 16 t + 15], so edges [16 t - 0.5, 16 t + 15.5].
  const float low = centre_px - half_px + 0.5F;
  const float high = centre_px + half_px + 0.5F;
  return {std::max(0, low < 0 ? 0 : clamp_tile(low)), high < 0 ? 0 : std::min(tiles, clamp_tile(high) + 1)};
}

/// Smallest Mahalanobis distance squared between a splat's centre and the pixel centres' box of a tile: the
/// minimum of a convex quadratic over a rectangle, taken on the rectangle's edges when the centre lies
/// outside.
float least_distance2(const Splat& s, float x0, float y0, float x1, float y1) {
  const float a = s.conic[0], b = s.conic[1], c = s.conic[2];
  const auto value = [&](float dx, float dy) { return a * dx * dx + 2.0F * b * dx * dy + c * dy * dy; };
  const bool inside_x = s.u_px >= x0 && s.u_px <= x1;
  const bool inside_y = s.v_px >= y0 && s.v_px <= y1;
  if (inside_x && inside_y) return 0.0F;
  float least = std::numeric_limits<float>::infinity();
  if (!inside_x) {
    const float dx = (s.u_px < x0 ? x0 : x1) - s.u_px;
    const float dy = std::clamp(-b / c * dx, y0 - s.v_px, y1 - s.v_px);
    least = std::min(least, value(dx, dy));
  }
  if (!inside_y) {
    const float dy = (s.v_px < y0 ? y0 : y1) - s.v_px;
    const float dx = std::clamp(-b / a * dy, x0 - s.u_px, x1 - s.u_px);
    least = std::min(least, value(dx, dy));
  }
  return least;
}

bool touches(const Splat& s, int column, int row, float reach2) {
  const auto x0 = static_cast<float>(column * kTilePx);
  const auto y0 = static_cast<float>(row * kTilePx);
  constexpr auto kSpan = static_cast<float>(kTilePx - 1);
  return least_distance2(s, x0, y0, x0 + kSpan, y0 + kSpan) <= reach2;
}

/// The splats of one row of tiles, nearest first.
using RowList = std::vector<std::uint32_t>;

/// One pass over all splats, so that a row need not look at those of the others.
std::vector<RowList> bin_by_row(std::span<const Splat> splats, int rows) {
  std::vector<RowList> lists(static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < splats.size(); ++i) {
    const Range range = tiles_touched(splats[i].v_px, splats[i].half_height_px, rows);
    for (int row = range.first; row < range.last; ++row)
      lists[static_cast<std::size_t>(row)].push_back(static_cast<std::uint32_t>(i));
  }
  return lists;
}

void fill_row(std::span<const Splat> splats, const RowList& of_row, int row, TileLists& lists,
              std::vector<std::vector<std::uint32_t>>& tiles) {
  for (const std::uint32_t i : of_row) {
    const Splat& s = splats[i];
    const Range columns = tiles_touched(s.u_px, s.half_width_px, lists.columns);
    // A hair more than the blend's own threshold, so that rounding never loses a pixel.
    const float reach2 = 2.0F * std::log(s.opacity / kMinAlpha) * 1.0001F + 1e-4F;
    for (int column = columns.first; column < columns.last; ++column) {
      if (touches(s, column, row, reach2))
        tiles[static_cast<std::size_t>(row * lists.columns + column)].push_back(i);
    }
  }
}

}  // namespace

TileLists make_tile_lists(std::span<const Splat> splats, int width_px, int height_px) {
  TileLists lists;
  lists.columns = (width_px + kTilePx - 1) / kTilePx;
  lists.rows = (height_px + kTilePx - 1) / kTilePx;
  std::vector<std::vector<std::uint32_t>> tiles(static_cast<std::size_t>(lists.columns * lists.rows));
  const std::vector<RowList> by_row = bin_by_row(splats, lists.rows);
  tbb::parallel_for(0, lists.rows, [&](int row) {
    fill_row(splats, by_row[static_cast<std::size_t>(row)], row, lists, tiles);
  });
  lists.starts.reserve(tiles.size() + 1);
  lists.starts.push_back(0);
  for (const auto& tile : tiles)
    lists.starts.push_back(lists.starts.back() + static_cast<std::uint32_t>(tile.size()));
  lists.splats.resize(lists.starts.back());
  tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) {
    std::copy(tiles[t].begin(), tiles[t].end(), lists.splats.begin() + lists.starts[t]);
  });
  return lists;
}

}  // namespace edgesplat::splat
