// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/map/chunk_id.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::map {

/// Parts of a Gaussian that an UPDATE can name; a mask of them is on the wire.
enum class Field : std::uint8_t {
  kPosition = 1,
  kLogScale = 2,
  kRotation = 4,
  kOpacity = 8,
  kColour = 16,
  kSh = 32,
  kAnchor = 64,
};
using FieldMask = std::uint8_t;
inline constexpr FieldMask kAllFields = 127;
[[nodiscard]] constexpr bool has(FieldMask mask, Field field) {
  return (mask & static_cast<FieldMask>(field)) != 0;
}

/// A Gaussian without its higher SH bands as unsigned integers, each of the width its layout says.
inline constexpr std::size_t kChannelCount = 14;
using Channels = std::array<std::uint16_t, kChannelCount>;
struct ChannelLayout {
  Field field;
  std::size_t first;
  std::size_t count;
  unsigned bits;
};
/// Position: steps of 12/65536 m from the chunk's lower corner less its slack. Log scale: 1/16 from -10 on.
/// Rotation: the three smaller quaternion components in steps of sqrt(1/2)/255, then the largest's index.
/// Opacity: 256 equal intervals of alpha. Colour: rgb in 1/256 from -0.5 on.
inline constexpr std::array<ChannelLayout, 6> kChannelLayouts = {{{Field::kPosition, 0, 3, 16},
                                                                  {Field::kLogScale, 3, 3, 8},
                                                                  {Field::kRotation, 6, 3, 9},
                                                                  {Field::kRotation, 9, 1, 2},
                                                                  {Field::kOpacity, 10, 1, 8},
                                                                  {Field::kColour, 11, 3, 9}}};
inline constexpr double kPositionStep_m = 12.0 / 65536.0;
/// Step of the SH coefficients above degree 0; they reach 127 steps either way.
inline constexpr float kShStep = 1.0F / 64.0F;
/// The nearest of those steps.
[[nodiscard]] std::int8_t round_sh(double steps);

/// Where and how a Gaussian lies, as its channels say: every combination of integers is a valid pose.
struct DecodedPose {
  std::array<double, 3> mean_m;
  std::array<double, 4> quat_xyzw;  ///< unit length
};
[[nodiscard]] DecodedPose decode_pose(const ChunkId& chunk, const Channels& channels);
/// Puts a pose into the channels of a Gaussian of `chunk`: only + - * / sqrt and floor in double, so that
/// every machine comes to the same integers. The mean must lie in the chunk or its slack (else it is
/// clamped).
void encode_pose(const ChunkId& chunk, const DecodedPose& pose, Channels& channels);

/// First channel of each field.
inline constexpr std::size_t kLogScaleAt = 3;
inline constexpr std::size_t kRotationAt = 6;
inline constexpr std::size_t kLargestAt = 9;
inline constexpr std::size_t kOpacityAt = 10;
inline constexpr std::size_t kColourAt = 11;
[[nodiscard]] constexpr float decode_log_scale(std::uint16_t level) {
  return static_cast<float>(level) / 16.0F - 10.0F;
}
/// Opacity, 0..1 exclusive.
[[nodiscard]] constexpr float decode_alpha(std::uint16_t level) {
  return (static_cast<float>(level) + 0.5F) / 256.0F;
}
/// sRGB of SH degree 0.
[[nodiscard]] constexpr float decode_colour(std::uint16_t level) {
  return static_cast<float>(level) / 256.0F - 0.5F;
}

/// N Gaussians as they travel and as both ends keep them: integers, so that equal means equal.
struct QuantisedRows {
  int sh_degree = 0;                      ///< 0..3
  std::vector<gaussian::GaussianId> ids;  ///< [N]
  std::vector<ChunkId> chunks;            ///< [N]
  std::vector<Channels> channels;         ///< [N]
  std::vector<std::int8_t> sh_rest;       ///< [N,(sh_degree+1)^2-1,3] in steps of kShStep
  std::vector<gaussian::Anchor> anchors;  ///< [N]

  [[nodiscard]] std::size_t size() const { return ids.size(); }
  [[nodiscard]] std::size_t sh_rest_each() const {
    return static_cast<std::size_t>(3 * ((sh_degree + 1) * (sh_degree + 1) - 1));
  }
  [[nodiscard]] bool consistent() const;
  void resize(std::size_t count);
  /// Appends row `row` of `other`, which must have the same sh_degree.
  void append_row(const QuantisedRows& other, std::size_t row);
  /// Copies row `from` of `other` (same sh_degree) onto row `to`.
  void set_row(std::size_t to, const QuantisedRows& other, std::size_t from);
};

/// The reason why a Gaussian cannot be quantised (not finite, beyond the map, no rotation), or nullptr.
[[nodiscard]] const char* unquantisable(const gaussian::GaussianCloud& cloud, std::size_t row);
/// Appends row `row` of `cloud`, which unquantisable() passed, as a Gaussian of `chunk`.
void append_quantised(const gaussian::GaussianCloud& cloud, std::size_t row, const ChunkId& chunk,
                      QuantisedRows& rows);
/// All rows as floats, in the same order.
[[nodiscard]] gaussian::GaussianCloud dequantise(const QuantisedRows& rows);

}  // namespace edgesplat::map
