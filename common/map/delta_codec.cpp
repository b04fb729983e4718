// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/delta_codec.hpp"

#include "common/map/varint.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace edgesplat::map {
namespace {

tl::unexpected<Error> refuse(DeltaKind kind, const char* why) {
  return fail(Errc::kInvalidArgument,
              "a delta of kind " + std::string(to_string(kind)) + " cannot be encoded: " + why);
}

/// Writes one body; returns the number of records in it.
struct BodyWriter {
  ByteWriter& out;
  DeltaKind kind;

  Result<std::size_t> operator()(const AddBody& body) {
    if (const char* why = flaw(body.rows)) return refuse(kind, why);
    AttributeWriter attributes(out);
    out.write(static_cast<std::uint8_t>(body.rows.sh_degree));
    write_chunks(attributes, body.rows.chunks);
    write_whole_rows(attributes, body.rows);
    return body.rows.size();
  }
  Result<std::size_t> operator()(const UpdateBody& body) {
    if (const char* why = flaw(body.differences)) return refuse(kind, why);
    if (body.fields > kAllFields) return refuse(kind, "it names unknown fields");
    AttributeWriter attributes(out);
    out.write(static_cast<std::uint8_t>(body.differences.sh_degree));
    out.write(body.fields);
    write_ids(attributes, body.differences.ids);
    write_fields(attributes, body.differences, body.fields, Values::kDifferences);
    return body.differences.size();
  }
  Result<std::size_t> operator()(const RemoveBody& body) {
    if (body.ids.size() > kMaxDeltaRecords) return refuse(kind, "too many ids; split it");
    AttributeWriter attributes(out);
    write_ids(attributes, body.ids);
    return body.ids.size();
  }
  Result<std::size_t> operator()(const ChunkReplaceBody& body) {
    if (const char* why = flaw(body.rows)) return refuse(kind, why);
    for (const ChunkId& chunk : body.rows.chunks) {
      if (chunk != body.chunk) return refuse(kind, "a row is of another chunk");
    }
    if (body.dropped && body.rows.size() != 0) return refuse(kind, "a dropped chunk has rows");
    out.write(static_cast<std::uint8_t>(body.rows.sh_degree));
    out.write(body.chunk.x);
    out.write(body.chunk.y);
    out.write(body.chunk.z);
    out.write(body.level);
    out.write(static_cast<std::uint8_t>((body.dropped ? 1U : 0U) | (body.more ? 2U : 0U)));
    AttributeWriter attributes(out);
    write_whole_rows(attributes, body.rows);
    return body.rows.size();
  }
  Result<std::size_t> operator()(const ReposeBody& body) {
    if (body.corrections.size() > kMaxPoseCorrections) return refuse(kind, "too many poses; split it");
    for (const PoseCorrection& correction : body.corrections) {
      out.write(correction.keyframe);
      out.write(correction.version);
      if (!write_pose(correction.old_map_from_body) || !write_pose(correction.new_map_from_body))
        return refuse(kind, "a pose is not finite, no rotation or beyond the map");
    }
    return body.corrections.size();
  }
  Result<std::size_t> operator()(const MaskBody& body) {
    const std::size_t pixels = std::size_t{body.width_px} * body.height_px;
    if (body.width_px > kMaxMaskSide_px || body.height_px > kMaxMaskSide_px || body.dynamic.size() != pixels)
      return refuse(kind, "its sides disagree with its pixels or are over 256");
    out.write(body.keyframe);
    out.write(body.version);
    out.write(body.width_px);
    out.write(body.height_px);
    AttributeWriter attributes(out);
    attributes.bytes(std::as_bytes(std::span(body.dynamic)));
    return pixels;
  }
  Result<std::size_t> operator()(const MappedBody& body) {
    if (body.keyframes.size() > kMaxMappedKeyframes) return refuse(kind, "too many keyframes; split it");
    if (std::adjacent_find(body.keyframes.begin(), body.keyframes.end(), std::greater_equal<>()) !=
        body.keyframes.end())
      return refuse(kind, "its keyframes are not in ascending order");
    for (const std::uint32_t keyframe : body.keyframes) out.write(keyframe);
    return body.keyframes.size();
  }

 private:
  static const char* flaw(const QuantisedRows& rows) {
    if (!rows.consistent()) return "its arrays disagree";
    return rows.size() > kMaxDeltaRecords ? "too many Gaussians; split it" : nullptr;
  }
  bool write_pose(const geometry::RigidTransform& pose) {
    const Eigen::Vector4d q = pose.rotation.coeffs();
    if (!pose.is_finite() || std::abs(q.squaredNorm() - 1.0) > 1e-3 ||
        pose.translation_m.cwiseAbs().maxCoeff() > static_cast<double>(kMapLimit_m))
      return false;
    for (const double v : pose.translation_m) out.write(static_cast<float>(v));
    for (const double v : q) out.write(static_cast<float>(v));
    return true;
  }
};

}  // namespace

void write_whole_rows(AttributeWriter& out, const QuantisedRows& rows) {
  write_ids(out, rows.ids);
  write_fields(out, rows, kAllFields, Values::kAbsolute);
}

Result<std::vector<std::byte>> encode_delta(const Delta& delta) {
  DeltaHeader header = delta.header;
  header.kind = delta.kind();
  ByteWriter body;
  EDGESPLAT_TRY(const std::size_t count, std::visit(BodyWriter{body, header.kind}, delta.body));
  header.count = static_cast<std::uint32_t>(count);
  return seal_delta(header, body.bytes());
}

}  // namespace edgesplat::map
