// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/quantised.hpp"

#include "common/base/check.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace edgesplat::map {
namespace {

constexpr double kSqrtHalf = 0.70710678118654752440;
constexpr double kRotationSteps = 255.0;  // for sqrt(1/2)
constexpr double kRotationMiddle = 256.0;
constexpr double kLogScaleSteps = 16.0;
constexpr double kLogScaleLow = -10.0;
constexpr double kAlphaSteps = 256.0;
constexpr double kColourSteps = 256.0;
constexpr double kColourLow = -0.5;

std::uint16_t level(double value, double highest) {
  return static_cast<std::uint16_t>(std::clamp(std::floor(value + 0.5), 0.0, highest));
}

double corner_m(std::int32_t cell) {
  return static_cast<double>(cell) * static_cast<double>(kChunkEdge_m) - static_cast<double>(kChunkSlack_m);
}

std::array<std::int32_t, 3> cells(const ChunkId& chunk) {
  return {chunk.x, chunk.y, chunk.z};
}

double squared(const std::array<double, 4>& q) {
  return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
}

void encode_rotation(std::array<double, 4> q, Channels& channels) {
  const double norm = std::sqrt(squared(q));
  for (double& v : q) v /= norm;
  std::size_t largest = 0;
  for (std::size_t k = 1; k < 4; ++k) {
    if (std::abs(q[k]) > std::abs(q[largest])) largest = k;
  }
  const double sign = q[largest] < 0.0 ? -1.0 : 1.0;
  std::size_t to = kRotationAt;
  for (std::size_t k = 0; k < 4; ++k) {
    if (k == largest) continue;
    channels[to++] = level(sign * q[k] * (kRotationSteps / kSqrtHalf) + kRotationMiddle, 511.0);
  }
  channels[kLargestAt] = static_cast<std::uint16_t>(largest);
}

std::array<double, 4> decode_rotation(const Channels& channels) {
  const std::size_t largest = channels[kLargestAt] & 3U;
  std::array<double, 4> q{};
  std::size_t from = kRotationAt;
  double sum = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (k == largest) continue;
    q[k] = (static_cast<double>(channels[from++]) - kRotationMiddle) * (kSqrtHalf / kRotationSteps);
    sum += q[k] * q[k];
  }
  q[largest] = std::sqrt(std::max(0.0, 1.0 - sum));
  const double norm = std::sqrt(squared(q));  // 1, unless hostile integers asked for more
  for (double& v : q) v /= norm;
  return q;
}

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

void copy_n_values(const std::vector<std::int8_t>& from, std::size_t row, std::size_t each,
                   std::vector<std::int8_t>::iterator to) {
  std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(row * each), each, to);
}

}  // namespace

std::int8_t round_sh(double steps) {
  return static_cast<std::int8_t>(std::clamp(std::floor(steps + 0.5), -127.0, 127.0));
}

DecodedPose decode_pose(const ChunkId& chunk, const Channels& channels) {
  DecodedPose pose{};
  const auto cell = cells(chunk);
  for (std::size_t k = 0; k < 3; ++k)
    pose.mean_m[k] = corner_m(cell[k]) + static_cast<double>(channels[k]) * kPositionStep_m;
  pose.quat_xyzw = decode_rotation(channels);
  return pose;
}

void encode_pose(const ChunkId& chunk, const DecodedPose& pose, Channels& channels) {
  const auto cell = cells(chunk);
  for (std::size_t k = 0; k < 3; ++k)
    channels[k] = level((pose.mean_m[k] - corner_m(cell[k])) / kPositionStep_m, 65535.0);
  encode_rotation(pose.quat_xyzw, channels);
}

bool QuantisedRows::consistent() const {
  const std::size_t n = ids.size();
  return sh_degree >= 0 && sh_degree <= 3 && chunks.size() == n && channels.size() == n &&
         sh_rest.size() == sh_rest_each() * n && anchors.size() == n;
}

void QuantisedRows::resize(std::size_t count) {
  ids.resize(count);
  chunks.resize(count);
  channels.resize(count);
  sh_rest.resize(sh_rest_each() * count);
  anchors.resize(count);
}

void QuantisedRows::append_row(const QuantisedRows& other, std::size_t row) {
  resize(size() + 1);
  set_row(size() - 1, other, row);
}

void QuantisedRows::set_row(std::size_t to, const QuantisedRows& other, std::size_t from) {
  EDGESPLAT_CHECK(sh_degree == other.sh_degree && from < other.size() && to < size(), "rows of one degree");
  ids[to] = other.ids[from];
  chunks[to] = other.chunks[from];
  channels[to] = other.channels[from];
  anchors[to] = other.anchors[from];
  const std::size_t each = sh_rest_each();
  if (each == 0) return;
  copy_n_values(other.sh_rest, from, each, sh_rest.begin() + static_cast<std::ptrdiff_t>(to * each));
}

const char* unquantisable(const gaussian::GaussianCloud& cloud, std::size_t row) {
  const std::span<const float> mean_m(cloud.means_m.data() + 3 * row, 3);
  const std::span<const float> quat(cloud.quats_xyzw.data() + 4 * row, 4);
  const std::size_t sh_each = cloud.sh_floats_each();
  if (!all_finite(mean_m) || !all_finite({cloud.log_scales.data() + 3 * row, 3}) || !all_finite(quat) ||
      !std::isfinite(cloud.opacity_logits[row]) || !all_finite({cloud.sh.data() + sh_each * row, sh_each})) {
    return "a value is not finite";
  }
  for (const float v : mean_m) {
    if (std::abs(v) > kMapLimit_m) return "a mean lies beyond the map's limit";
  }
  const double norm2 = squared({quat[0], quat[1], quat[2], quat[3]});
  return norm2 > 1e-12 && norm2 < 1e12 ? nullptr : "a quaternion is no rotation";
}

void append_quantised(const gaussian::GaussianCloud& cloud, std::size_t row, const ChunkId& chunk,
                      QuantisedRows& rows) {
  EDGESPLAT_CHECK(cloud.sh_degree == rows.sh_degree && row < cloud.size(), "rows of one SH degree");
  const auto* mean_m = cloud.means_m.data() + 3 * row;
  const auto* quat = cloud.quats_xyzw.data() + 4 * row;
  const float* sh = cloud.sh.data() + cloud.sh_floats_each() * row;
  Channels channels{};
  encode_pose(chunk, {{mean_m[0], mean_m[1], mean_m[2]}, {quat[0], quat[1], quat[2], quat[3]}}, channels);
  for (std::size_t k = 0; k < 3; ++k) {
    channels[kLogScaleAt + k] = level((cloud.log_scales[3 * row + k] - kLogScaleLow) * kLogScaleSteps, 255.0);
    const double rgb = 0.5 + static_cast<double>(gaussian::GaussianCloud::kShC0) * sh[k];
    channels[kColourAt + k] = level((rgb - kColourLow) * kColourSteps, 511.0);
  }
  const double alpha = 1.0 / (1.0 + std::exp(-static_cast<double>(cloud.opacity_logits[row])));
  channels[kOpacityAt] = level(alpha * kAlphaSteps - 0.5, kAlphaSteps - 1.0);
  rows.ids.push_back(cloud.ids[row]);
  rows.chunks.push_back(chunk);
  rows.channels.push_back(channels);
  rows.anchors.push_back(cloud.anchors[row]);
  for (std::size_t i = 3; i < cloud.sh_floats_each(); ++i)
    rows.sh_rest.push_back(round_sh(static_cast<double>(sh[i]) / kShStep));
}

gaussian::GaussianCloud dequantise(const QuantisedRows& rows) {
  gaussian::GaussianCloud cloud;
  cloud.sh_degree = rows.sh_degree;
  cloud.resize(rows.size());
  cloud.ids = rows.ids;
  cloud.anchors = rows.anchors;
  const std::size_t rest_each = rows.sh_rest_each();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const Channels& channels = rows.channels[row];
    const DecodedPose pose = decode_pose(rows.chunks[row], channels);
    float* sh = cloud.sh.data() + (rest_each + 3) * row;
    for (std::size_t k = 0; k < 4; ++k) cloud.quats_xyzw[4 * row + k] = static_cast<float>(pose.quat_xyzw[k]);
    for (std::size_t k = 0; k < 3; ++k) {
      cloud.means_m[3 * row + k] = static_cast<float>(pose.mean_m[k]);
      cloud.log_scales[3 * row + k] = decode_log_scale(channels[kLogScaleAt + k]);
      sh[k] = (decode_colour(channels[kColourAt + k]) - 0.5F) / gaussian::GaussianCloud::kShC0;
    }
    const float alpha = decode_alpha(channels[kOpacityAt]);
    cloud.opacity_logits[row] = std::log(alpha / (1.0F - alpha));
    for (std::size_t i = 0; i < rest_each; ++i)
      sh[3 + i] = static_cast<float>(rows.sh_rest[rest_each * row + i]) * kShStep;
  }
  return cloud;
}

}  // namespace edgesplat::map
