// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/keyframe.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::map {

inline constexpr std::uint32_t kKeyframeMagic = 0x314B5345U;  ///< "ESK1"
inline constexpr std::uint16_t kKeyframeVersion = 1;
inline constexpr std::size_t kMaxKeyframePoints = 1U << 20U;
inline constexpr std::size_t kMaxKeyframeImage_bytes = std::size_t{16} << 20U;
inline constexpr std::size_t kMaxKeyframe_bytes = std::size_t{32} << 20U;
/// A point further than this from the body is refused by the encoder (no LiDAR sees that far).
inline constexpr float kMaxKeyframeRange_m = 1000.0F;

/// A keyframe as bytes: magic, version, section count, length, CRC32C, then sections (tag u16, length u32,
/// content). A reader skips tags it does not know, so later fields (geometric residuals, IMU pre-integration,
/// features, mask, health) are new tags and old programs go on. Points are quantised to 16 bits an axis in
/// the keyframe's own bounding box, with a step of max(1 mm, extent / 65535): off by at most 0.5 mm where the
/// box is within 64 m (all points within 32 m), 1.1 mm at 140 m, 15.3 mm at the limit of 2000 m. The rest is
/// exact (the covariance's upper triangle stands for both). Errors: kInvalidArgument for values that are not
/// finite or beyond the limits above.
[[nodiscard]] Result<std::vector<std::byte>> encode_keyframe(const Keyframe& keyframe);

/// The keyframe again. Checks magic, version, lengths, CRC32C and counts before it allocates, that every
/// number is finite, the rotation is of unit length and the camera valid; allocates at most 32 MiB beyond the
/// input. The image's bytes are handed on as they are, undecoded. kCorrupt with the reason otherwise.
[[nodiscard]] Result<Keyframe> decode_keyframe(std::span<const std::byte> bytes);

}  // namespace edgesplat::map
