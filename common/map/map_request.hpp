// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/chunk_id.hpp"
#include "common/map/ids.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace edgesplat::map {

/// What a robot asks of the server about its copy of the map. The numbers are on the wire: never reuse one.
enum class RequestKind : std::uint8_t {
  kResend = 1,    ///< the deltas after `seq` up to `until_seq`, again
  kSnapshot = 2,  ///< everything anew: the robot cannot go on from `seq` of `epoch`
  kMore = 3,      ///< `seq` is applied: the next parts of the snapshot may come
  kRelease = 4,   ///< the robot wants the memory of `chunks` back: stop sending them
  kFetch = 5,     ///< send `chunks`, given up before, again
};
[[nodiscard]] std::string_view to_string(RequestKind kind);

/// On the wire, little endian: magic u32, version u16, kind u8, robot id u16, epoch u32, seq u64, until seq
/// u64, position 3 x f32, number of chunks u16, chunks 3 x i32 each, CRC32C u32 of all before it.
struct MapRequest {
  RequestKind kind = RequestKind::kSnapshot;
  RobotId robot;
  Epoch epoch;            ///< that the robot holds; 0: none yet
  std::uint64_t seq = 0;  ///< last delta applied
  std::uint64_t until_seq = 0;
  Eigen::Vector3f robot_in_map_m = Eigen::Vector3f::Zero();  ///< what is near it comes first
  std::vector<ChunkId> chunks;
};

inline constexpr std::uint32_t kMapRequestMagic = 0x31525345U;  ///< "ESR1"
inline constexpr std::uint16_t kMapRequestVersion = 1;
inline constexpr std::size_t kMaxRequestChunks = 1024;

/// Chunks beyond kMaxRequestChunks are left out: ask again for them.
[[nodiscard]] std::vector<std::byte> encode_map_request(const MapRequest& request);
/// kCorrupt for wrong magic, version, kind, length or CRC32C, a position that is not finite or a chunk beyond
/// the map.
[[nodiscard]] Result<MapRequest> decode_map_request(std::span<const std::byte> bytes);

}  // namespace edgesplat::map
