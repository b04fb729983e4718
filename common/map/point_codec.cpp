// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/point_codec.hpp"

#include "common/base/bytes.hpp"
#include "common/map/keyframe_codec.hpp"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace edgesplat::map {
namespace {

constexpr std::uint8_t kEncodingQuantised16 = 1;
constexpr int kZstdLevel = 1;
constexpr float kLeastStep_m = 0.001F;
constexpr float kLevels = 65535.0F;

std::size_t raw_bytes(std::size_t count) {
  return 9 * count + (count + 7) / 8;
}

struct Box {
  Eigen::Vector3f low_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f step_m = Eigen::Vector3f::Constant(kLeastStep_m);
};

Box box_around(std::span<const ColouredPoint> points) {
  Box box;
  if (points.empty()) return box;
  Eigen::Vector3f low = points.front().p_in_body_m;
  Eigen::Vector3f high = low;
  for (const auto& point : points) {
    low = low.cwiseMin(point.p_in_body_m);
    high = high.cwiseMax(point.p_in_body_m);
  }
  box.low_m = low;
  box.step_m = ((high - low) / kLevels).cwiseMax(kLeastStep_m);
  return box;
}

void put_u16(std::byte* to, std::uint16_t value) {
  std::memcpy(to, &value, sizeof(value));
}

std::vector<std::byte> quantise(std::span<const ColouredPoint> points, const Box& box) {
  const std::size_t n = points.size();
  std::vector<std::byte> raw(raw_bytes(n), std::byte{0});
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      const float level = std::round((points[i].p_in_body_m[k] - box.low_m[k]) / box.step_m[k]);
      put_u16(&raw[2 * (axis * n + i)], static_cast<std::uint16_t>(std::clamp(level, 0.0F, kLevels)));
      raw[6 * n + axis * n + i] = std::byte{points[i].rgb[axis]};
    }
    if (points[i].has_colour) raw[9 * n + i / 8] |= std::byte{1} << (i % 8);
  }
  return raw;
}

std::vector<ColouredPoint> restore(std::span<const std::byte> raw, std::size_t n, const Box& box) {
  std::vector<ColouredPoint> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      std::uint16_t level = 0;
      std::memcpy(&level, &raw[2 * (axis * n + i)], sizeof(level));
      points[i].p_in_body_m[k] = box.low_m[k] + box.step_m[k] * static_cast<float>(level);
      points[i].rgb[axis] = std::to_integer<std::uint8_t>(raw[6 * n + axis * n + i]);
    }
    points[i].has_colour = (raw[9 * n + i / 8] & (std::byte{1} << (i % 8))) != std::byte{0};
  }
  return points;
}

}  // namespace

Result<std::vector<std::byte>> encode_points(std::span<const ColouredPoint> points) {
  if (points.size() > kMaxKeyframePoints) {
    return fail(Errc::kInvalidArgument, "a keyframe of " + std::to_string(points.size()) +
                                            " points is over the limit of " +
                                            std::to_string(kMaxKeyframePoints) + ": downsample it");
  }
  for (const auto& point : points) {
    // Written so that NaN fails too.
    if (!(point.p_in_body_m.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= kMaxKeyframeRange_m)) {
      return fail(Errc::kInvalidArgument, "a keyframe's point is not finite or over 1000 m away");
    }
  }
  const Box box = box_around(points);
  const auto raw = quantise(points, box);
  std::vector<std::byte> packed(ZSTD_compressBound(raw.size()));
  const std::size_t packed_bytes =
      ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), kZstdLevel);
  if (ZSTD_isError(packed_bytes) != 0)
    return fail(Errc::kInvalidArgument, "zstd cannot compress a keyframe's points");
  ByteWriter out;
  out.write(kEncodingQuantised16);
  out.write(static_cast<std::uint32_t>(points.size()));
  for (int i = 0; i < 3; ++i) out.write(box.low_m[i]);
  for (int i = 0; i < 3; ++i) out.write(box.step_m[i]);
  out.write_bytes(std::span<const std::byte>(packed).first(packed_bytes));
  return out.take();
}

Result<std::vector<ColouredPoint>> decode_points(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  const auto encoding = in.read<std::uint8_t>();
  const std::size_t count = in.read<std::uint32_t>();
  Box box;
  for (int i = 0; i < 3; ++i) box.low_m[i] = in.read<float>();
  for (int i = 0; i < 3; ++i) box.step_m[i] = in.read<float>();
  if (!in.ok() || encoding != kEncodingQuantised16 || count > kMaxKeyframePoints) {
    return fail(Errc::kCorrupt, "a keyframe's points are cut short, too many or of an unknown encoding");
  }
  const Eigen::Vector3f high_m = box.low_m + kLevels * box.step_m;
  if (!box.low_m.allFinite() || !high_m.allFinite() || box.step_m.minCoeff() <= 0.0F ||
      box.low_m.cwiseAbs().maxCoeff() > 2 * kMaxKeyframeRange_m ||
      high_m.cwiseAbs().maxCoeff() > 2 * kMaxKeyframeRange_m) {
    return fail(Errc::kCorrupt, "a keyframe's bounding box makes no sense");
  }
  const auto packed = in.take(in.remaining());
  if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != raw_bytes(count)) {
    return fail(Errc::kCorrupt, "a keyframe's points do not unpack to their stated number");
  }
  std::vector<std::byte> raw(raw_bytes(count));
  if (ZSTD_decompress(raw.data(), raw.size(), packed.data(), packed.size()) != raw.size()) {
    return fail(Errc::kCorrupt, "a keyframe's points do not unpack");
  }
  return restore(raw, count, box);
}

}  // namespace edgesplat::map
