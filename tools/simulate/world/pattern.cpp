// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/pattern.hpp"

#include "tools/simulate/world/texture_noise.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector2d;

Rgb mix(const Rgb& a, const Rgb& b, float share_of_b) {
  return a + share_of_b * (b - a);
}

float noise(const Material& m, const TexturePoint& at, double largest_m, float gain = 0.78F) {
  return octave_noise(at.uv_m, {largest_m, 0.004, gain, m.seed}, at.footprint_m);
}

/// Own shade of a tile, brick or board, -1..1; fades where several fall into the footprint.
float own_shade(double column, double row, std::uint32_t seed, double size_m, double footprint_m) {
  const float value = cell_value(static_cast<int>(column), static_cast<int>(row), seed);
  return (2.0F * value - 1.0F) * detail_weight(2.0 * size_m, footprint_m);
}

Rgb plaster(const Material& m, const TexturePoint& at) {
  return m.base * (1.0F + m.contrast * noise(m, at, 1.6, 0.75F));
}

/// Light and dark chips of about a centimetre, as in terrazzo and worn stone.
float chips(const Material& m, const TexturePoint& at) {
  constexpr double kChip_m = 0.022;
  const float weight = detail_weight(2.0 * kChip_m, at.footprint_m);
  if (weight <= 0.0F) return 0.0F;
  const float value = value_noise(at.uv_m / kChip_m, m.seed ^ 0xC41BU);
  const float beyond = std::max(0.0F, std::abs(value) - 0.25F);  // a third of the ground is chips
  return weight * std::copysign(std::min(3.0F * beyond, 1.0F), value);
}

struct Bond {
  double width_m;
  double height_m;
  double joint_m;
  double row_shift;  ///< of each second row, in widths
};

/// Stones in rows with joints of the accent colour.
Rgb masonry(const Material& m, const TexturePoint& at, const Bond& bond) {
  const double y = at.uv_m.y() / bond.height_m;
  const double row = std::floor(y);
  const double x = at.uv_m.x() / bond.width_m + bond.row_shift * std::fmod(std::abs(row), 2.0);
  // Half a joint on either side of each border, so that a stone's shade changes under the joint.
  const double jx = bond.joint_m / bond.width_m, jy = bond.joint_m / bond.height_m;
  const float open_x = pulse_coverage(x + jx / 2.0, jx, at.footprint_m / bond.width_m);
  const float open_y = pulse_coverage(y + jy / 2.0, jy, at.footprint_m / bond.height_m);
  const float joint = 1.0F - (1.0F - open_x) * (1.0F - open_y);
  const double smaller_m = std::min(bond.width_m, bond.height_m);
  const float shade = own_shade(std::floor(x), row, m.seed ^ 0xB0DU, smaller_m, at.footprint_m);
  const float grain = noise(m, at, 0.3) + chips(m, at);
  const Rgb stone = m.base * (1.0F + m.contrast * (0.8F * shade + grain));
  return mix(stone, m.accent * (1.0F + 0.5F * m.contrast * grain), joint);
}

Rgb wood(const Material& m, const TexturePoint& at) {
  const double board_m = std::max(0.05F, m.period_m);
  const double x = at.uv_m.x() / board_m;
  const float shade = own_shade(std::floor(x), 3, m.seed, board_m, at.footprint_m);
  // Grain is stretched along v and bent by a slow wave.
  const double bend = 0.03 * value_noise(at.uv_m * 2.5, m.seed + 7);
  const Vector2d along(at.uv_m.x() + bend, at.uv_m.y() / 9.0);
  const float grain = octave_noise(along, {0.12, 0.004, 0.75F, m.seed + 1}, at.footprint_m);
  const float gap = pulse_coverage(x, 0.004 / board_m, at.footprint_m / board_m);
  return mix(m.base * (1.0F + m.contrast * (0.5F * shade + 1.3F * grain)), m.accent, gap);
}

Rgb metal(const Material& m, const TexturePoint& at) {
  const Vector2d along(at.uv_m.x() / 12.0, at.uv_m.y());
  const float brush = octave_noise(along, {0.1, 0.004, 0.8F, m.seed}, at.footprint_m);
  return m.base * (1.0F + m.contrast * (brush + 0.4F * noise(m, at, 1.0)));
}

Rgb concrete(const Material& m, const TexturePoint& at) {
  const float blotch = noise(m, at, 2.4, 0.7F);
  const double joint = 0.012 / m.period_m;
  const float seam = pulse_coverage(at.uv_m.x() / m.period_m, joint, at.footprint_m / m.period_m);
  const float pores =
      std::max(0.0F, octave_noise(at.uv_m, {0.05, 0.006, 0.8F, m.seed + 5}, at.footprint_m) - 0.25F);
  return mix(m.base * (1.0F + m.contrast * blotch - 0.8F * pores), m.accent, seam);
}

Rgb asphalt(const Material& m, const TexturePoint& at) {
  const float stones = octave_noise(at.uv_m, {0.06, 0.004, 0.85F, m.seed + 2}, at.footprint_m);
  const float patches = octave_noise(at.uv_m, {5.0, 0.3, 0.6F, m.seed + 3}, at.footprint_m);
  return m.base * std::max(0.2F, 1.0F + m.contrast * (1.8F * stones + 0.8F * patches));
}

Rgb foliage(const Material& m, const TexturePoint& at) {
  const float big = octave_noise(at.uv_m, {0.35, 0.05, 0.7F, m.seed}, at.footprint_m);
  const float leaves = octave_noise(at.uv_m, {0.09, 0.006, 0.8F, m.seed + 4}, at.footprint_m);
  const float light = std::clamp(0.45F + 0.6F * big + 1.3F * leaves, 0.0F, 1.0F);
  return mix(m.base, m.accent, light);
}

Rgb bark(const Material& m, const TexturePoint& at) {
  const Vector2d along(at.uv_m.x() * 3.0, at.uv_m.y() / 2.0);
  return m.base *
         std::max(0.2F, 1.0F + m.contrast * 2.0F *
                                   octave_noise(along, {0.25, 0.008, 0.75F, m.seed}, at.footprint_m));
}

Rgb fabric(const Material& m, const TexturePoint& at) {
  const float stripe = pulse_coverage(at.uv_m.y() / m.period_m, 0.35, at.footprint_m / m.period_m);
  const float folds =
      octave_noise({at.uv_m.x(), at.uv_m.y() / 3.0}, {0.25, 0.02, 0.6F, m.seed}, at.footprint_m);
  const float weave = octave_noise(at.uv_m, {0.02, 0.003, 0.9F, m.seed + 1}, at.footprint_m);
  return mix(m.base, m.accent, stripe) * (1.0F + m.contrast * (folds + 0.6F * weave));
}

/// Seen along the tube: v runs along the tunnel, |u - line_m| is the way down from the top of the vault.
Rgb tunnel_wall(const Material& m, const TexturePoint& at) {
  constexpr double kBandTop_m = 4.9, kBandBottom_m = 5.12, kMarkTop_m = 4.1, kMarkBottom_m = 4.6;
  const double along = at.uv_m.y() / m.period_m, down_m = std::abs(at.uv_m.x() - m.line_m);
  const float paint = box_coverage(down_m, kBandBottom_m, 20.0, at.footprint_m);
  Rgb colour = mix(m.base, Rgb(1.6F * m.base), paint) * (1.0F + m.contrast * noise(m, at, 3.0, 0.7F));
  colour = mix(colour, m.accent, box_coverage(down_m, kBandTop_m, kBandBottom_m, at.footprint_m));
  const float mark = pulse_coverage(along, 0.25 / m.period_m, at.footprint_m / m.period_m) *
                     box_coverage(down_m, kMarkTop_m, kMarkBottom_m, at.footprint_m);
  colour = mix(colour, Rgb(0.75F, 0.72F, 0.65F), mark);
  const float seam = pulse_coverage(at.uv_m.y() / 2.5, 0.006, at.footprint_m / 2.5);
  return colour * (1.0F - 0.6F * seam);
}

Rgb road_marks(const Material& m, const TexturePoint& at) {
  const float dash = pulse_coverage(at.uv_m.x() / m.period_m, 0.4, at.footprint_m / m.period_m);
  const float middle = box_coverage(at.uv_m.y(), m.line_m - 0.07, m.line_m + 0.07, at.footprint_m);
  const float worn = std::clamp(0.85F + 0.4F * noise(m, at, 0.4), 0.0F, 1.0F);
  return mix(asphalt(m, at), m.accent, dash * middle * worn);
}

}  // namespace

Rgb albedo(const Material& m, const TexturePoint& at) {
  const auto colour = [&]() -> Rgb {
    switch (m.pattern) {
      case Pattern::kPlaster:
        return plaster(m, at);
      case Pattern::kTiles:
        return masonry(m, at, {m.period_m, m.period_m, 0.006, 0.0});
      case Pattern::kPavers:
        return masonry(m, at, {m.period_m, m.period_m / 2.0, 0.012, 0.5});
      case Pattern::kBricks:
        return masonry(m, at, {0.25, 0.075, 0.012, 0.5});
      case Pattern::kWood:
        return wood(m, at);
      case Pattern::kMetal:
        return metal(m, at);
      case Pattern::kConcrete:
        return concrete(m, at);
      case Pattern::kAsphalt:
        return asphalt(m, at);
      case Pattern::kFoliage:
        return foliage(m, at);
      case Pattern::kBark:
        return bark(m, at);
      case Pattern::kFabric:
        return fabric(m, at);
      case Pattern::kPoster:
        return poster_albedo(m, at);
      case Pattern::kSign:
        return sign_albedo(m, at);
      case Pattern::kTunnelWall:
        return tunnel_wall(m, at);
      case Pattern::kRoadMarks:
        return road_marks(m, at);
      case Pattern::kPaint:
      case Pattern::kLamp:
      case Pattern::kWindowView:
      case Pattern::kPane:
        break;
    }
    return m.base * (1.0F + m.contrast * noise(m, at, 0.8));
  }();
  return colour.cwiseMax(0.01F).cwiseMin(0.95F);
}

}  // namespace edgesplat::simulate
