// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/row_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace edgesplat::stream {
namespace {

using map::Field;

/// What a step of each channel layout (map::kChannelLayouts) weighs, and how many nobody sees.
struct Weight {
  float step;
  float unseen_steps;
};

float scale_m(const map::Channels& channels, std::size_t axis) {
  return std::exp(static_cast<float>(channels[3 + axis]) / 64.0F - 10.0F);
}

constexpr float kTurnStep_rad = 0.001F;

/// Angle between two rotations; which component is the largest does not matter.
int turn_steps(const map::Channels& a, const map::Channels& b) {
  if (std::equal(a.begin() + 6, a.begin() + 10, b.begin() + 6)) return 0;
  const auto p = map::decode_pose({}, a).quat_xyzw;
  const auto q = map::decode_pose({}, b).quat_xyzw;
  const double dot = std::abs(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]);
  const double angle_rad = 2.0 * std::sqrt(2.0 * std::max(0.0, 1.0 - dot));
  return static_cast<int>(std::lround(angle_rad / static_cast<double>(kTurnStep_rad)));
}

struct Size {
  float least_m;
  float middle_m;  ///< geometric mean
  float most_m;
};

Size size_of(const map::Channels& channels) {
  const std::array<float, 3> axes_m = {scale_m(channels, 0), scale_m(channels, 1), scale_m(channels, 2)};
  const auto [least, most] = std::minmax_element(axes_m.begin(), axes_m.end());
  return {std::max(*least, 1e-3F), std::cbrt(axes_m[0] * axes_m[1] * axes_m[2]), *most};
}

std::array<Weight, map::kChannelLayouts.size()> weights(const Size& size) {
  const float position_step = static_cast<float>(map::kPositionStep_m) / size.least_m;
  const float aspect = std::clamp(size.most_m / size.least_m, 1.0F, 8.0F);
  // Rotations are compared in the large: see turn_steps().
  const float rotation_step = kTurnStep_rad * aspect;
  return {{{position_step, 0.05F / position_step},
           {1.0F / 64.0F, 2.0F},
           {rotation_step, 0.03F / rotation_step},
           {rotation_step, 0.03F / rotation_step},
           {1.0F / 256.0F, 2.0F},
           {1.0F / 512.0F, 4.0F}}};
}

/// Largest difference of one layout's channels, in steps.
int difference(const map::Channels& a, const map::Channels& b, const map::ChannelLayout& layout) {
  if (layout.field == Field::kRotation) return layout.count > 1 ? turn_steps(a, b) : 0;
  int most = 0;
  for (std::size_t k = layout.first; k < layout.first + layout.count; ++k)
    most = std::max(most, std::abs(static_cast<int>(a[k]) - static_cast<int>(b[k])));
  return most;
}

void set_back(map::Channels& to, const map::Channels& from, Field field) {
  for (const map::ChannelLayout& layout : map::kChannelLayouts) {
    if (layout.field != field) continue;
    std::copy_n(from.begin() + layout.first, layout.count, to.begin() + layout.first);
  }
}

int settle_sh(map::QuantisedRows& now, std::size_t row, const map::QuantisedRows& held, std::size_t held_row,
              float tolerance) {
  const std::size_t each = now.sh_rest_each();
  int most = 0;
  for (std::size_t k = 0; k < each; ++k)
    most = std::max(most, std::abs(now.sh_rest[each * row + k] - held.sh_rest[each * held_row + k]));
  if (static_cast<float>(most) > tolerance) return most;
  for (std::size_t k = 0; k < each; ++k) now.sh_rest[each * row + k] = held.sh_rest[each * held_row + k];
  return 0;
}

}  // namespace

RowChange settle_change(map::QuantisedRows& now, std::size_t row, const map::QuantisedRows& held,
                        std::size_t held_row, float tolerance) {
  RowChange change;
  map::Channels& channels = now.channels[row];
  const map::Channels& before = held.channels[held_row];
  const Size size = size_of(before);
  const auto weight = weights(size);
  float sum = 0.0F;
  for (std::size_t i = 0; i < map::kChannelLayouts.size(); ++i) {
    const auto steps = static_cast<float>(difference(channels, before, map::kChannelLayouts[i]));
    if (steps <= tolerance * weight[i].unseen_steps) continue;
    sum += steps * weight[i].step;
    change.fields |= static_cast<map::FieldMask>(map::kChannelLayouts[i].field);
  }
  for (const map::ChannelLayout& layout : map::kChannelLayouts) {
    if (!map::has(change.fields, layout.field)) set_back(channels, before, layout.field);
  }
  if (const int steps = settle_sh(now, row, held, held_row, tolerance); steps > 0) {
    sum += static_cast<float>(steps) * map::kShStep * 0.3F;
    change.fields |= static_cast<map::FieldMask>(Field::kSh);
  }
  if (now.anchors[row] != held.anchors[held_row]) {
    sum += 0.01F;
    change.fields |= static_cast<map::FieldMask>(Field::kAnchor);
  }
  const auto alpha = static_cast<float>(std::max(channels[10], before[10])) / 256.0F;
  change.priority = sum * alpha * size.middle_m;
  return change;
}

}  // namespace edgesplat::stream
