// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/quantised.hpp"
#include "server/store/map_file.hpp"

#include <utility>

namespace edgesplat::store {

/// What the records of a map file hold; the numbers are on the disk: never reuse one.
enum class RecordType : std::uint8_t { kHead = 1, kPoses = 2, kChunk = 3, kFloats = 4 };

/// Most Gaussians in one record; a fuller chunk has several.
inline constexpr std::size_t kMaxChunkRows = 65536;

struct Head {
  map::MapUuid map;
  map::RobotId robot;
  std::uint64_t session = 0;
  map::Epoch epoch;
  std::uint64_t next_id_counter = 0;
  std::uint64_t gaussians = 0;
  int sh_degree = 0;
  bool full_precision = false;
};

[[nodiscard]] std::vector<std::byte> encode_head(const Head& head);
[[nodiscard]] Result<Head> decode_head(std::span<const std::byte> payload);
[[nodiscard]] std::vector<std::byte> encode_poses(std::span<const StoredPose> poses);
[[nodiscard]] Result<std::vector<StoredPose>> decode_poses(std::span<const std::byte> payload);

/// Rows of one chunk, numbered from `first` in the order of the file, in the codec of the link.
[[nodiscard]] std::vector<std::byte> encode_chunk(std::uint64_t first, const map::QuantisedRows& rows);
[[nodiscard]] Result<std::pair<std::uint64_t, map::QuantisedRows>> decode_chunk(
    std::span<const std::byte> payload);
/// The same Gaussians in full precision; anchors are those of the chunk's record.
[[nodiscard]] std::vector<std::byte> encode_floats(std::uint64_t first, const gaussian::GaussianCloud& cloud);
[[nodiscard]] Result<std::pair<std::uint64_t, gaussian::GaussianCloud>> decode_floats(
    std::span<const std::byte> payload);

}  // namespace edgesplat::store
