// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/gaussian_values.hpp"
#include "common/io/spz_packed.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>

namespace edgesplat::io::spz {
namespace {

using gaussian::GaussianCloud;

/// Turning by 180 degrees about x takes RUB to RDF and back: the signs of positions and rotations, and of the
/// SH bases 1..15 by their parity in y and z.
constexpr std::array<float, 3> kFlip = {1.0F, -1.0F, -1.0F};
constexpr std::array<float, 15> kFlipSh = {-1, -1, 1, -1, 1, 1, -1, 1, -1, 1, -1, -1, 1, -1, 1};

constexpr float kColourScale = 0.15F * 255.0F;  // leaves room below 0 and above 1
constexpr std::uint8_t kMostFractionalBits = 12;
constexpr int kSh1Bits = 5;  // kept of a byte, as the reference writer does: the rest compresses away
constexpr int kShRestBits = 4;

std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<std::uint32_t>(bytes[at]);
}

float half_to_float(std::uint32_t half) {
  return static_cast<float>(Eigen::numext::bit_cast<Eigen::half>(static_cast<std::uint16_t>(half)));
}

float fixed_to_float(std::span<const std::byte> bytes, std::size_t at, std::uint8_t fractional_bits) {
  const std::uint32_t raw = byte_at(bytes, at) | byte_at(bytes, at + 1) << 8U | byte_at(bytes, at + 2) << 16U;
  const auto value = std::bit_cast<std::int32_t>(raw << 8U) >> 8;  // carries the sign of 24 bits down
  return std::ldexp(static_cast<float>(value), -fractional_bits);
}

float position(const Packed& packed, std::size_t index) {
  const auto& bytes = packed.streams[kPositions];
  if (packed.version != 1) return fixed_to_float(bytes, 3 * index, packed.fractional_bits);
  return half_to_float(byte_at(bytes, 2 * index) | byte_at(bytes, 2 * index + 1) << 8U);
}

using Quat = std::array<float, 4>;  // x, y, z, w

/// Versions 1 and 2: x, y, z as bytes over -1..1, w >= 0 follows from the unit length.
Quat rotation_of_three(std::span<const std::byte, 3> bytes) {
  Quat q{};
  float rest = 1.0F;
  for (std::size_t i = 0; i < 3; ++i) {
    q[i] = static_cast<float>(byte_at(bytes, i)) / 127.5F - 1.0F;
    rest -= q[i] * q[i];
  }
  q[3] = std::sqrt(std::max(0.0F, rest));
  return q;
}

constexpr float kSmallestScale = 511.0F * std::numbers::sqrt2_v<float>;  // nine bits for 0..sqrt(1/2)

/// From version 3 on: which component is largest (2 bits) and the others with sign and nine bits, the last
/// one lowest.
Quat rotation_of_word(std::uint32_t word) {
  Quat q{};
  float rest = 1.0F;
  const std::size_t largest = word >> 30U;
  for (std::size_t i = 4; i-- > 0;) {
    if (i == largest) continue;
    const auto magnitude = static_cast<float>(word & 0x1FFU) / kSmallestScale;
    q[i] = (word & 0x200U) != 0 ? -magnitude : magnitude;
    rest -= q[i] * q[i];
    word >>= 10U;
  }
  q[largest] = std::sqrt(std::max(0.0F, rest));
  return q;
}

std::uint32_t word_of_rotation(const Quat& q) {
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    if (std::abs(q[i]) > std::abs(q[largest])) largest = i;
  }
  const bool negate = q[largest] < 0.0F;
  auto word = static_cast<std::uint32_t>(largest);
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == largest) continue;
    const auto magnitude =
        static_cast<std::uint32_t>(std::min(511.0F, std::abs(q[i]) * kSmallestScale + 0.5F));
    const std::uint32_t sign = (q[i] < 0.0F) != negate ? 0x200U : 0U;
    word = word << 10U | sign | magnitude;
  }
  return word;
}

Quat rotation(const Packed& packed, std::size_t row) {
  const std::span<const std::byte> bytes = packed.streams[kRotations];
  if (packed.version < 3) return rotation_of_three(bytes.subspan(3 * row).first<3>());
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word |= byte_at(bytes, 4 * row + i) << (8U * i);
  return rotation_of_word(word);
}

std::byte quantised_sh(float value, int bits) {
  const int bucket = 1 << (8 - bits);
  const int rounded = static_cast<int>(std::clamp(std::round(value * 128.0F), -128.0F, 128.0F)) + 128;
  return static_cast<std::byte>(std::clamp((rounded + bucket / 2) / bucket * bucket, 0, 255));
}

/// The most fractional bits with which every coordinate fits into 24 bits.
Result<std::uint8_t> choose_fractional_bits(const GaussianCloud& cloud) {
  float largest = 0.0F;
  for (const float value : cloud.means_m) largest = std::max(largest, std::abs(value));
  for (std::uint8_t bits = kMostFractionalBits + 1; bits-- > 0;) {
    if (std::ldexp(largest, bits) < 8388607.0F) return bits;
  }
  return fail(Errc::kInvalidArgument, "SPZ: a Gaussian lies more than 8388 km from the origin");
}

void pack_row(const GaussianCloud& cloud, std::size_t row, Packed& packed) {
  const auto put = [&packed](Stream stream, std::uint32_t value) {
    packed.streams[stream].push_back(static_cast<std::byte>(value & 0xFFU));
  };
  const float* sh = &cloud.sh[row * cloud.sh_floats_each()];
  Quat q{};
  float norm = 0.0F;
  for (std::size_t i = 0; i < 4; ++i) norm += cloud.quats_xyzw[4 * row + i] * cloud.quats_xyzw[4 * row + i];
  for (std::size_t i = 0; i < 4; ++i) {
    q[i] = cloud.quats_xyzw[4 * row + i] / std::sqrt(norm) * (i < 3 ? kFlip[i] : 1.0F);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const float scaled = std::ldexp(kFlip[i] * cloud.means_m[3 * row + i], packed.fractional_bits);
    const auto fixed = static_cast<std::uint32_t>(std::lround(scaled));
    for (const unsigned shift : {0U, 8U, 16U}) put(kPositions, fixed >> shift);
    put(kColours, to_byte(sh[i] * kColourScale + 127.5F));
    put(kScales, to_byte((cloud.log_scales[3 * row + i] + 10.0F) * 16.0F));
  }
  put(kAlphas, byte_of_logit(cloud.opacity_logits[row]));
  if (packed.version >= 3) {
    const std::uint32_t word = word_of_rotation(q);
    for (const unsigned shift : {0U, 8U, 16U, 24U}) put(kRotations, word >> shift);
  } else {
    for (std::size_t i = 0; i < 3; ++i)
      put(kRotations, to_byte((q[3] < 0.0F ? -q[i] : q[i]) * 127.5F + 127.5F));
  }
  for (std::size_t i = 3; i < cloud.sh_floats_each(); ++i) {
    const std::size_t basis = i / 3 - 1;
    packed.streams[kSh].push_back(quantised_sh(kFlipSh[basis] * sh[i], basis < 3 ? kSh1Bits : kShRestBits));
  }
}

}  // namespace

Result<GaussianCloud> unpack(const Packed& packed) {
  GaussianCloud cloud;
  cloud.sh_degree = std::min<int>(packed.sh_degree, 3);  // the cloud has no fourth band
  cloud.resize(packed.count);
  const std::size_t sh_bytes = packed.bytes_each(kSh);
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    cloud.ids[row] = gaussian::GaussianId(0, row);
    float* sh = &cloud.sh[row * cloud.sh_floats_each()];
    for (std::size_t i = 0; i < 3; ++i) {
      cloud.means_m[3 * row + i] = kFlip[i] * position(packed, 3 * row + i);
      const auto scale = static_cast<float>(byte_at(packed.streams[kScales], 3 * row + i));
      cloud.log_scales[3 * row + i] = scale / 16.0F - 10.0F;
      const auto colour = static_cast<float>(byte_at(packed.streams[kColours], 3 * row + i));
      sh[i] = (colour - 127.5F) / kColourScale;
    }
    Quat q = rotation(packed, row);
    const float norm = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    for (std::size_t i = 0; i < 4; ++i) {
      cloud.quats_xyzw[4 * row + i] = q[i] / norm * (i < 3 ? kFlip[i] : 1.0F);
    }
    cloud.opacity_logits[row] = logit_of_byte(std::to_integer<std::uint8_t>(packed.streams[kAlphas][row]));
    for (std::size_t i = 3; i < cloud.sh_floats_each(); ++i) {
      const auto value = static_cast<float>(byte_at(packed.streams[kSh], row * sh_bytes + i - 3));
      sh[i] = kFlipSh[i / 3 - 1] * (value - 128.0F) / 128.0F;
    }
  }
  for (const float value : cloud.means_m) {
    if (!std::isfinite(value)) return fail(Errc::kCorrupt, "SPZ: a position is not finite");
  }
  return cloud;
}

Result<Packed> pack(const GaussianCloud& cloud, std::uint32_t version) {
  EDGESPLAT_TRY_STATUS(check_writable(cloud));
  if (cloud.size() > 0x7FFFFFFFU) return fail(Errc::kInvalidArgument, "SPZ holds at most 2^31 - 1 Gaussians");
  Packed packed;
  packed.version = version;
  packed.count = static_cast<std::uint32_t>(cloud.size());
  packed.sh_degree = static_cast<std::uint8_t>(cloud.sh_degree);
  EDGESPLAT_TRY(packed.fractional_bits, choose_fractional_bits(cloud));
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    packed.streams[i].reserve(cloud.size() * packed.bytes_each(static_cast<Stream>(i)));
  }
  for (std::size_t row = 0; row < cloud.size(); ++row) pack_row(cloud, row, packed);
  return packed;
}

}  // namespace edgesplat::io::spz
