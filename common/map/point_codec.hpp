// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/keyframe.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace edgesplat::map {

/// A keyframe's points, quantised to 16 bits an axis in their bounding box (accuracy: see encode_keyframe),
/// in the same order, one zstd stream over x, y, z, r, g, b and a bit for has_colour. kInvalidArgument: a
/// point that is not finite or beyond kMaxKeyframeRange_m on an axis, or too many.
[[nodiscard]] Result<std::vector<std::byte>> encode_points(std::span<const ColouredPoint> points);
/// kCorrupt with the reason for anything that encode_points would not write; allocates nothing before the
/// count and the uncompressed length are checked.
[[nodiscard]] Result<std::vector<ColouredPoint>> decode_points(std::span<const std::byte> bytes);

}  // namespace edgesplat::map
