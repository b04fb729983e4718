// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/rigid_transform.hpp"
#include "common/map/ids.hpp"
#include "common/map/quantised.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>
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
  kMapped = 7,        ///< keyframes whose part of the map is complete
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
  std::uint64_t base_seq = 0;  ///< must have been applied before this one; 0: begins with an empty map
  DeltaKind kind = DeltaKind::kAdd;
  std::uint32_t count = 0;         ///< records in the body
  std::uint32_t length_bytes = 0;  ///< of the body
};

/// Whole Gaussians. One whose id is known already has changed its chunk: the record takes the old one's
/// place.
struct AddBody {
  QuantisedRows rows;
};

/// What known Gaussians change by: differences of the integers modulo their width; unnamed fields are 0.
/// Anchors are the new ones. `differences.chunks` is not used. Ids the map does not hold are passed over.
struct UpdateBody {
  FieldMask fields = 0;
  QuantisedRows differences;
};

struct RemoveBody {
  std::vector<gaussian::GaussianId> ids;  ///< those the map does not hold are passed over
};

/// All of one chunk at one level of detail (0 is the finest): whatever it held before is gone.
struct ChunkReplaceBody {
  ChunkId chunk;
  std::uint8_t level = 0;
  bool dropped = false;  ///< the robot gave this chunk up: no rows, and nothing of it is sent until it asks
  bool more = false;     ///< parts of a snapshot wait for the robot to ask for them
  QuantisedRows rows;    ///< all of `chunk`
};

/// A keyframe's corrected pose: what is anchored to it with an older pose version moves by new * old^-1.
struct PoseCorrection {
  std::uint32_t keyframe = 0;
  std::uint32_t version = 0;  ///< of the new pose
  geometry::RigidTransform old_map_from_body;
  geometry::RigidTransform new_map_from_body;
};
struct ReposeBody {
  std::vector<PoseCorrection> corrections;
};

/// Where things move in a keyframe's picture; only the highest version counts.
struct MaskBody {
  std::uint32_t keyframe = 0;
  std::uint32_t version = 0;
  std::uint16_t width_px = 0;
  std::uint16_t height_px = 0;
  std::vector<std::uint8_t> dynamic;  ///< [H,W] 0 static .. 255 surely moving
};

/// What the server made of these keyframes is in the deltas up to this one (but for chunks that the robot
/// gave up): what the robot made of them itself is retired. Comes again after a snapshot.
struct MappedBody {
  std::vector<std::uint32_t> keyframes;  ///< ascending, each once
};

struct Delta {
  DeltaHeader header;  ///< kind, count and length are filled in by the encoder
  std::variant<AddBody, UpdateBody, RemoveBody, ChunkReplaceBody, ReposeBody, MaskBody, MappedBody> body;

  [[nodiscard]] DeltaKind kind() const { return static_cast<DeltaKind>(body.index() + 1); }
};

}  // namespace edgesplat::map
