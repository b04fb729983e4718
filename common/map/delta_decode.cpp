// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/delta_codec.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace edgesplat::map {
namespace {

tl::unexpected<Error> refuse(std::string_view kind, const char* why) {
  return fail(Errc::kCorrupt, "a delta of kind " + std::string(kind) + " is refused: " + why);
}

Result<int> read_sh_degree(ByteReader& in) {
  const auto degree = in.read<std::uint8_t>();
  if (!in.ok() || degree > 3) return fail(Errc::kCorrupt, "a delta's SH degree makes no sense");
  return static_cast<int>(degree);
}

/// Ids and fields after whatever stood before them.
Status read_rows(AttributeReader& in, std::size_t count, FieldMask fields, QuantisedRows& rows) {
  rows.resize(count);
  EDGESPLAT_TRY(rows.ids, read_ids(in, count));
  return read_fields(in, fields, rows);
}

Result<AddBody> read_add(ByteReader& in, std::size_t count) {
  AddBody body;
  EDGESPLAT_TRY(body.rows.sh_degree, read_sh_degree(in));
  AttributeReader attributes(in);
  EDGESPLAT_TRY(auto chunks, read_chunks(attributes, count));
  EDGESPLAT_TRY_STATUS(read_rows(attributes, count, kAllFields, body.rows));
  body.rows.chunks = std::move(chunks);
  return body;
}

Result<UpdateBody> read_update(ByteReader& in, std::size_t count) {
  UpdateBody body;
  EDGESPLAT_TRY(body.differences.sh_degree, read_sh_degree(in));
  body.fields = in.read<FieldMask>();
  if (body.fields > kAllFields) return refuse("update", "it names unknown fields");
  AttributeReader attributes(in);
  EDGESPLAT_TRY_STATUS(read_rows(attributes, count, body.fields, body.differences));
  return body;
}

Result<ChunkReplaceBody> read_chunk_replace(ByteReader& in, std::size_t count) {
  ChunkReplaceBody body;
  EDGESPLAT_TRY(body.rows.sh_degree, read_sh_degree(in));
  body.chunk.x = in.read<std::int32_t>();
  body.chunk.y = in.read<std::int32_t>();
  body.chunk.z = in.read<std::int32_t>();
  body.level = in.read<std::uint8_t>();
  const auto flags = in.read<std::uint8_t>();
  body.dropped = (flags & 1U) != 0;
  body.more = (flags & 2U) != 0;
  if (!in.ok() || flags > 3 || (body.dropped && count != 0))
    return refuse("chunk_replace", "its flags make no sense");
  if (!chunk_in_map(body.chunk)) return refuse("chunk_replace", "the chunk lies beyond the map");
  AttributeReader attributes(in);
  EDGESPLAT_TRY_STATUS(read_rows(attributes, count, kAllFields, body.rows));
  body.rows.chunks.assign(count, body.chunk);
  return body;
}

Result<geometry::RigidTransform> read_pose(ByteReader& in) {
  geometry::RigidTransform pose;
  for (double& v : pose.translation_m) v = static_cast<double>(in.read<float>());
  for (double& v : pose.rotation.coeffs()) v = static_cast<double>(in.read<float>());
  const double norm2 = pose.rotation.coeffs().squaredNorm();
  if (!in.ok() || !pose.is_finite() || !(std::abs(norm2 - 1.0) < 1e-2) ||
      pose.translation_m.cwiseAbs().maxCoeff() > static_cast<double>(kMapLimit_m))
    return refuse("repose", "a pose is not finite, no rotation or beyond the map");
  return pose;
}

Result<ReposeBody> read_repose(ByteReader& in, std::size_t count) {
  constexpr std::size_t kCorrection_bytes = 8 + 2 * 28;
  if (count > kMaxPoseCorrections || in.remaining() != kCorrection_bytes * count)
    return refuse("repose", "the number of poses does not match");
  ReposeBody body;
  body.corrections.resize(count);
  for (PoseCorrection& correction : body.corrections) {
    correction.keyframe = in.read<std::uint32_t>();
    correction.version = in.read<std::uint32_t>();
    EDGESPLAT_TRY(correction.old_map_from_body, read_pose(in));
    EDGESPLAT_TRY(correction.new_map_from_body, read_pose(in));
  }
  return body;
}

Result<MaskBody> read_mask(ByteReader& in, std::size_t count) {
  MaskBody body;
  body.keyframe = in.read<std::uint32_t>();
  body.version = in.read<std::uint32_t>();
  body.width_px = in.read<std::uint16_t>();
  body.height_px = in.read<std::uint16_t>();
  if (!in.ok() || body.width_px > kMaxMaskSide_px || body.height_px > kMaxMaskSide_px ||
      std::size_t{body.width_px} * body.height_px != count)
    return refuse("mask", "its sides disagree with its pixels or are over 256");
  AttributeReader attributes(in);
  EDGESPLAT_TRY(const auto pixels, attributes.bytes(count));
  for (const std::byte pixel : pixels) body.dynamic.push_back(std::to_integer<std::uint8_t>(pixel));
  return body;
}

Result<MappedBody> read_mapped(ByteReader& in, std::size_t count) {
  if (count > kMaxMappedKeyframes || in.remaining() != sizeof(std::uint32_t) * count)
    return refuse("mapped", "the number of keyframes does not match");
  MappedBody body;
  body.keyframes.resize(count);
  for (std::uint32_t& keyframe : body.keyframes) keyframe = in.read<std::uint32_t>();
  if (std::adjacent_find(body.keyframes.begin(), body.keyframes.end(), std::greater_equal<>()) !=
      body.keyframes.end())
    return refuse("mapped", "its keyframes are not in ascending order");
  return body;
}

Status read_body(ByteReader& in, Delta& delta) {
  const std::size_t count = delta.header.count;
  switch (delta.header.kind) {
    case DeltaKind::kAdd: {
      EDGESPLAT_TRY(delta.body, read_add(in, count));
      return {};
    }
    case DeltaKind::kUpdate: {
      EDGESPLAT_TRY(delta.body, read_update(in, count));
      return {};
    }
    case DeltaKind::kRemove: {
      AttributeReader attributes(in);
      EDGESPLAT_TRY(auto ids, read_ids(attributes, count));
      delta.body = RemoveBody{std::move(ids)};
      return {};
    }
    case DeltaKind::kChunkReplace: {
      EDGESPLAT_TRY(delta.body, read_chunk_replace(in, count));
      return {};
    }
    case DeltaKind::kRepose: {
      EDGESPLAT_TRY(delta.body, read_repose(in, count));
      return {};
    }
    case DeltaKind::kMask: {
      EDGESPLAT_TRY(delta.body, read_mask(in, count));
      return {};
    }
    case DeltaKind::kMapped: {
      EDGESPLAT_TRY(delta.body, read_mapped(in, count));
      return {};
    }
  }
  return fail(Errc::kCorrupt, "a delta of unknown kind");
}

}  // namespace

Result<QuantisedRows> read_whole_rows(ByteReader& in, int sh_degree, std::size_t count) {
  QuantisedRows rows;
  rows.sh_degree = sh_degree;
  AttributeReader attributes(in);
  EDGESPLAT_TRY_STATUS(read_rows(attributes, count, kAllFields, rows));
  return rows;
}

Result<Delta> decode_delta(std::span<const std::byte> bytes) {
  Delta delta;
  EDGESPLAT_TRY(delta.header, decode_delta_header(bytes));
  if (delta.header.count > kMaxDeltaRecords) return refuse(to_string(delta.header.kind), "too many records");
  ByteReader in(bytes.subspan(kDeltaHeader_bytes));
  EDGESPLAT_TRY_STATUS(read_body(in, delta));
  if (!in.ok() || in.remaining() != 0)
    return refuse(to_string(delta.header.kind), "its body has bytes left over or too few");
  return delta;
}

}  // namespace edgesplat::map
