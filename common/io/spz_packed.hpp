// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// SPZ (github.com/nianticlabs/spz, MIT): what the container holds and what the bytes mean. Inside common/io
/// only.
namespace edgesplat::io::spz {

/// Streams in the order of the file.
enum Stream : std::uint8_t { kPositions, kAlphas, kColours, kScales, kRotations, kSh };
inline constexpr std::size_t kStreamCount = 6;

/// The quantised Gaussians, a byte stream an attribute.
struct Packed {
  std::uint32_t version = 4;  ///< 1 half-float positions; 1, 2 rotations of 3 bytes; 3, 4 of 4 bytes
  std::uint32_t count = 0;
  std::uint8_t sh_degree = 0;  ///< 0..4
  std::uint8_t fractional_bits = 12;
  std::uint8_t flags = 0;  ///< kAntialiased, kExtensions
  std::array<std::vector<std::byte>, kStreamCount> streams;

  /// Bytes that a Gaussian has in a stream.
  [[nodiscard]] std::size_t bytes_each(Stream stream) const;
};
inline constexpr std::uint8_t kAntialiased = 0x1;
inline constexpr std::uint8_t kExtensions = 0x2;

/// The container: version 4 has a plain header and zstd streams, 1 to 3 are one gzip stream. kCorrupt with
/// the reason; no memory is taken for a count that the file cannot hold.
[[nodiscard]] Result<Packed> open(std::span<const std::byte> file);
/// version 2, 3 or 4; no extensions.
[[nodiscard]] Result<std::vector<std::byte>> close(const Packed& packed);

/// Axes RUB -> those of the INRIA files (RDF): y and z change their signs.
[[nodiscard]] Result<gaussian::GaussianCloud> unpack(const Packed& packed);
/// kInvalidArgument for positions beyond +-8388 km; fractional_bits is chosen, at most 12.
[[nodiscard]] Result<Packed> pack(const gaussian::GaussianCloud& cloud, std::uint32_t version);

}  // namespace edgesplat::io::spz
