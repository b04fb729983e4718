// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/row_change.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat::stream {
namespace {

using map::Field;

// Differences that nobody sees.
constexpr float kUnseenMean = 0.05F;  // of the smallest axis
constexpr float kUnseenLogScale = 0.05F;
constexpr float kUnseenTurn = 0.03F;  // rad times the ratio of the axes: the tips lie at three sigma
constexpr float kUnseenAlpha = 0.01F;
constexpr float kUnseenColour = 0.01F;
constexpr float kUnseenSh = map::kShStep;

struct Size {
  float least_m;
  float middle_m;  ///< geometric mean
  float aspect;
};

Size size_of(const map::Channels& channels) {
  std::array<float, 3> logs{};
  for (std::size_t k = 0; k < 3; ++k) logs[k] = map::decode_log_scale(channels[map::kLogScaleAt + k]);
  const auto [least, most] = std::minmax_element(logs.begin(), logs.end());
  const float least_m = std::max(std::exp(*least), 1e-3F);  // thinner than a millimetre looks the same
  return {least_m, std::exp((logs[0] + logs[1] + logs[2]) / 3.0F),
          std::clamp(std::exp(*most) / least_m, 1.0F, 8.0F)};
}

float mean_difference_m(const TrueRow& truth, const map::DecodedPose& held) {
  float most_m = 0.0F;
  for (std::size_t k = 0; k < 3; ++k) {
    const double is_m = truth.cloud.means_m[3 * truth.row + k];
    most_m = std::max(most_m, static_cast<float>(std::abs(is_m - held.mean_m[k])));
  }
  return most_m;
}

float turn_rad(const TrueRow& truth, const map::DecodedPose& held) {
  double dot = 0.0;
  double norm2 = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double v = truth.cloud.quats_xyzw[4 * truth.row + k];
    dot += v * held.quat_xyzw[k];
    norm2 += v * v;
  }
  return static_cast<float>(2.0 * std::sqrt(2.0 * std::max(0.0, 1.0 - std::abs(dot) / std::sqrt(norm2))));
}

float alpha_of(const TrueRow& truth) {
  return 1.0F / (1.0F + std::exp(-truth.cloud.opacity_logits[truth.row]));
}

float alpha_difference(const TrueRow& truth, const map::Channels& held) {
  return std::abs(alpha_of(truth) - map::decode_alpha(held[map::kOpacityAt]));
}

float log_scale_difference(const TrueRow& truth, const map::Channels& held) {
  float most = 0.0F;
  for (std::size_t k = 0; k < 3; ++k) {
    const float is = truth.cloud.log_scales[3 * truth.row + k];
    most = std::max(most, std::abs(is - map::decode_log_scale(held[map::kLogScaleAt + k])));
  }
  return most;
}

float colour_difference(const TrueRow& truth, const map::Channels& held) {
  const float* sh = truth.cloud.sh.data() + truth.cloud.sh_floats_each() * truth.row;
  float most = 0.0F;
  for (std::size_t k = 0; k < 3; ++k) {
    const float rgb = 0.5F + gaussian::GaussianCloud::kShC0 * sh[k];
    most = std::max(most, std::abs(rgb - map::decode_colour(held[map::kColourAt + k])));
  }
  return most;
}

float sh_difference(const TrueRow& truth, const HeldRow& held) {
  const std::size_t each = held.rows.sh_rest_each();
  const float* sh = truth.cloud.sh.data() + (each + 3) * truth.row + 3;
  const std::int8_t* held_sh = held.rows.sh_rest.data() + each * held.row;
  float most = 0.0F;
  for (std::size_t k = 0; k < each; ++k)
    most = std::max(most, std::abs(sh[k] - map::kShStep * static_cast<float>(held_sh[k])));
  return most;
}

/// Fields that are not in `fields` become the held ones again.
void set_back(const HeldRow& held, map::FieldMask fields, map::QuantisedRows& now) {
  map::Channels& channels = now.channels.back();
  const map::Channels& before = held.rows.channels[held.row];
  for (const map::ChannelLayout& layout : map::kChannelLayouts) {
    if (map::has(fields, layout.field)) continue;
    for (std::size_t k = layout.first; k < layout.first + layout.count; ++k) channels[k] = before[k];
  }
  const std::size_t each = now.sh_rest_each();
  if (map::has(fields, Field::kSh) || each == 0) return;
  std::copy_n(held.rows.sh_rest.data() + each * held.row, each, now.sh_rest.data() + each * (now.size() - 1));
}

}  // namespace

RowChange measure_change(const TrueRow& truth, const HeldRow& held, float tolerance) {
  const map::Channels& before = held.rows.channels[held.row];
  const Size size = size_of(before);
  const map::DecodedPose pose = map::decode_pose(held.rows.chunks[held.row], before);
  RowChange change;
  float sum = 0.0F;
  const auto weigh = [&](Field field, float difference, float unseen) {
    if (difference <= tolerance * unseen) return;
    sum += difference;
    change.fields |= static_cast<map::FieldMask>(field);
  };
  weigh(Field::kPosition, mean_difference_m(truth, pose) / size.least_m, kUnseenMean);
  weigh(Field::kLogScale, log_scale_difference(truth, before), kUnseenLogScale);
  weigh(Field::kRotation, turn_rad(truth, pose) * size.aspect, kUnseenTurn);
  weigh(Field::kOpacity, alpha_difference(truth, before), kUnseenAlpha);
  weigh(Field::kColour, colour_difference(truth, before), kUnseenColour);
  weigh(Field::kSh, sh_difference(truth, held), kUnseenSh);
  if (truth.cloud.anchors[truth.row] != held.rows.anchors[held.row])
    weigh(Field::kAnchor, 2.0F * tolerance + 0.01F, 1.0F);
  if (change.fields == 0) return change;
  const float alpha = std::max(alpha_of(truth), map::decode_alpha(before[map::kOpacityAt]));
  change.priority = sum * alpha * size.middle_m;
  return change;
}

bool append_settled(const TrueRow& truth, const HeldRow& held, map::FieldMask fields,
                    map::QuantisedRows& now) {
  map::append_quantised(truth.cloud, truth.row, held.rows.chunks[held.row], now);
  set_back(held, fields, now);
  const bool differs = now.channels.back() != held.rows.channels[held.row] || map::has(fields, Field::kSh) ||
                       map::has(fields, Field::kAnchor);
  if (!differs) now.resize(now.size() - 1);
  return differs;
}

}  // namespace edgesplat::stream
