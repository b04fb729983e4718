// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/map/chunk_id.hpp"
#include "common/map/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace edgesplat::map {

/// What a delta does to the resident map. The numbers are on the wire: never reuse one.
enum class DeltaKind : std::uint8_t {
  kAdd = 1,           ///< new Gaussians
  kUpdate = 2,        ///< some fields of known Gaussians
  kRemove = 3,        ///< ids that are gone
  kChunkReplace = 4,  ///< all of one chunk, at one LoD level
  kRepose = 5,        ///< keyframe poses corrected; anchored Gaussians move with them
  kMask = 6,          ///< newest dynamic mask, low resolution
};
[[nodiscard]] std::string_view to_string(DeltaKind kind);

/// What every delta starts with. On the wire, little endian, in this order: magic u32, version u16, robot id
/// u16, map uuid 16 bytes, epoch u32, seq u64, base seq u64, kind u8, count u32, length u32, CRC32C u32 (of
/// the header before it and the body).
struct DeltaHeader {
  RobotId robot;
  MapUuid map;
  Epoch epoch;
  std::uint64_t seq = 0;       ///< 1, 2, 3... within an epoch
  std::uint64_t base_seq = 0;  ///< must have been applied before this one; 0: builds on an empty map
  DeltaKind kind = DeltaKind::kAdd;
  std::uint32_t count = 0;         ///< records in the body
  std::uint32_t length_bytes = 0;  ///< of the body
};

/// New Gaussians with the chunk each is born in.
struct AddDelta {
  DeltaHeader header;  ///< kind kAdd, count = gaussians.size()
  gaussian::GaussianCloud gaussians;
  std::vector<ChunkId> chunks;  ///< [N]
};

}  // namespace edgesplat::map
