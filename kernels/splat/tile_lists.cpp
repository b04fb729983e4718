// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/tile_lists.hpp"
#include "common/thread/parallel_for.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

/// Splats are dealt out in this many runs whatever the number of threads; the result does not depend on it.
constexpr std::size_t kParts = 32;

/// What one run of splats touches.
struct Part {
  std::size_t first = 0, last = 0;    ///< splats [first, last)
  std::vector<std::uint32_t> tiles;   ///< splat by splat
  std::vector<std::uint32_t> counts;  ///< of tiles, one a splat
  std::vector<std::uint32_t> places;  ///< one a tile: first how many, then where the next goes
};

void find_tiles(std::span<const Splat> splats, const TileLists& lists, Part& part) {
  part.places.assign(static_cast<std::size_t>(lists.columns * lists.rows), 0);
  part.counts.reserve(part.last - part.first);
  for (std::size_t i = part.first; i < part.last; ++i) {
    const Splat& s = splats[i];
    const Range columns = tiles_touched(s.u_px, s.half_width_px, lists.columns);
    const Range rows = tiles_touched(s.v_px, s.half_height_px, lists.rows);
    // A hair more than the blend's own threshold, so that rounding never loses a pixel.
    const float reach2 = s.reach2 * 1.0001F + 1e-4F;
    const std::size_t before = part.tiles.size();
    for (int row = rows.first; row < rows.last; ++row) {
      for (int column = columns.first; column < columns.last; ++column) {
        if (!touches(s, column, row, reach2)) continue;
        const auto tile = static_cast<std::uint32_t>(row * lists.columns + column);
        part.tiles.push_back(tile);
        ++part.places[tile];
      }
    }
    part.counts.push_back(static_cast<std::uint32_t>(part.tiles.size() - before));
  }
}

/// Fills lists.starts and turns the counts per part and tile into places: tile by tile, in each tile part by
/// part, so that a tile keeps the order of the splats.
void lay_out(std::vector<Part>& parts, TileLists& lists) {
  const auto tiles = static_cast<std::size_t>(lists.columns * lists.rows);
  lists.starts.resize(tiles + 1);
  std::uint32_t next = 0;
  for (std::size_t t = 0; t < tiles; ++t) {
    lists.starts[t] = next;
    for (Part& part : parts) next += std::exchange(part.places[t], next);
  }
  lists.starts[tiles] = next;
  lists.splats.resize(next);
  lists.slots.resize(next);
}

void number_slots(const std::vector<Part>& parts, TileLists& lists) {
  std::uint32_t next = 0;
  for (const Part& part : parts) {
    for (const std::uint32_t count : part.counts) {
      lists.splat_starts.push_back(next);
      next += count;
    }
  }
  lists.splat_starts.push_back(next);
}

void deal_out(Part& part, TileLists& lists) {
  std::uint32_t slot = lists.splat_starts[part.first];
  auto tile = part.tiles.begin();
  for (std::size_t i = part.first; i < part.last; ++i) {
    for (std::uint32_t k = 0; k < part.counts[i - part.first]; ++k, ++tile, ++slot) {
      const std::uint32_t place = part.places[*tile]++;
      lists.splats[place] = static_cast<std::uint32_t>(i);
      lists.slots[place] = slot;
    }
  }
}

}  // namespace

TileLists make_tile_lists(std::span<const Splat> splats, int width_px, int height_px) {
  TileLists lists;
  lists.columns = (width_px + kTilePx - 1) / kTilePx;
  lists.rows = (height_px + kTilePx - 1) / kTilePx;
  std::vector<Part> parts(kParts);
  thread::parallel_for(std::size_t{0}, kParts, [&](std::size_t p) {
    parts[p].first = splats.size() * p / kParts;
    parts[p].last = splats.size() * (p + 1) / kParts;
    find_tiles(splats, lists, parts[p]);
  });
  lists.splat_starts.reserve(splats.size() + 1);
  number_slots(parts, lists);
  lay_out(parts, lists);
  thread::parallel_for(std::size_t{0}, kParts, [&](std::size_t p) { deal_out(parts[p], lists); });
  return lists;
}

}  // namespace edgesplat::splat
