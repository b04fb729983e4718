// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/delta_codec.hpp"

#include "common/base/bytes.hpp"
#include "common/base/crc32c.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace edgesplat::map {
namespace {

constexpr std::size_t kCrcOffset_bytes = kDeltaHeader_bytes - sizeof(std::uint32_t);
constexpr std::uint8_t kEncodingFloat32 = 1;
constexpr std::size_t kRun_bytes = 16;  // chunk x, y, z i32 and the number of rows u32
constexpr std::size_t kBodyStart_bytes = 8;

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

bool means_in_map(std::span<const float> means_m) {
  return std::all_of(means_m.begin(), means_m.end(), [](float v) { return std::abs(v) <= kMapLimit_m; });
}

bool unit_quaternions(std::span<const float> quats_xyzw) {
  for (std::size_t i = 0; i + 3 < quats_xyzw.size(); i += 4) {
    float squared = 0.0F;
    for (std::size_t k = 0; k < 4; ++k) squared += quats_xyzw[i + k] * quats_xyzw[i + k];
    if (std::abs(squared - 1.0F) > 2e-2F) return false;
  }
  return true;
}

/// The reason why a cloud may not enter the map, or nullptr.
const char* flaw(const gaussian::GaussianCloud& cloud) {
  if (!all_finite(cloud.means_m) || !all_finite(cloud.log_scales) || !all_finite(cloud.quats_xyzw) ||
      !all_finite(cloud.opacity_logits) || !all_finite(cloud.sh)) {
    return "a value is not finite";
  }
  if (!means_in_map(cloud.means_m)) return "a mean lies beyond the map's limit";
  if (!unit_quaternions(cloud.quats_xyzw)) return "a quaternion is not of unit length";
  return nullptr;
}

void write_header(ByteWriter& out, const DeltaHeader& header) {
  out.write(kDeltaMagic);
  out.write(kDeltaVersion);
  out.write(header.robot.value);
  out.write_bytes(header.map.bytes);
  out.write(header.epoch.value);
  out.write(header.seq);
  out.write(header.base_seq);
  out.write(static_cast<std::uint8_t>(header.kind));
  out.write(header.count);
  out.write(header.length_bytes);
  out.write(std::uint32_t{0});  // the CRC's place
}

std::vector<std::pair<ChunkId, std::uint32_t>> runs_of(const std::vector<ChunkId>& chunks) {
  std::vector<std::pair<ChunkId, std::uint32_t>> runs;
  for (const ChunkId& chunk : chunks) {
    if (runs.empty() || runs.back().first != chunk) runs.emplace_back(chunk, 0U);
    ++runs.back().second;
  }
  return runs;
}

template <typename T>
void write_array(ByteWriter& out, const std::vector<T>& values) {
  out.write_bytes(std::as_bytes(std::span<const T>(values)));
}

template <typename T>
void read_array(ByteReader& in, std::vector<T>& values) {
  const auto bytes = in.take(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
}

std::size_t record_bytes(int sh_degree) {
  const auto coefficients = static_cast<std::size_t>((sh_degree + 1) * (sh_degree + 1) * 3);
  return 8 + 4 * (3 + 3 + 4 + 1 + coefficients) + 8;
}

/// Chunks of all rows from the run table, or false where it does not add up to `count` rows.
bool read_runs(ByteReader& in, std::size_t run_count, std::size_t count, std::vector<ChunkId>& chunks) {
  chunks.reserve(count);
  for (std::size_t i = 0; i < run_count; ++i) {
    ChunkId chunk;
    chunk.x = in.read<std::int32_t>();
    chunk.y = in.read<std::int32_t>();
    chunk.z = in.read<std::int32_t>();
    const auto rows = in.read<std::uint32_t>();
    if (rows == 0 || rows > count - chunks.size()) return false;
    chunks.insert(chunks.end(), rows, chunk);
  }
  return chunks.size() == count;
}

void write_rows(ByteWriter& out, const gaussian::GaussianCloud& cloud) {
  for (const auto& id : cloud.ids) out.write(id.packed());
  write_array(out, cloud.means_m);
  write_array(out, cloud.log_scales);
  write_array(out, cloud.quats_xyzw);
  write_array(out, cloud.opacity_logits);
  write_array(out, cloud.sh);
  for (const auto& anchor : cloud.anchors) {
    out.write(anchor.keyframe);
    out.write(anchor.pose_version);
  }
}

void read_rows(ByteReader& in, std::size_t count, gaussian::GaussianCloud& cloud) {
  cloud.resize(count);
  for (auto& id : cloud.ids) id = gaussian::GaussianId::from_packed(in.read<std::uint64_t>());
  read_array(in, cloud.means_m);
  read_array(in, cloud.log_scales);
  read_array(in, cloud.quats_xyzw);
  read_array(in, cloud.opacity_logits);
  read_array(in, cloud.sh);
  for (auto& anchor : cloud.anchors) {
    anchor.keyframe = in.read<std::uint32_t>();
    anchor.pose_version = in.read<std::uint32_t>();
  }
}

}  // namespace

Result<std::vector<std::byte>> encode_add(const AddDelta& delta) {
  const auto& cloud = delta.gaussians;
  if (!cloud.consistent() || delta.chunks.size() != cloud.size() || cloud.size() > kMaxDeltaRecords) {
    return fail(Errc::kInvalidArgument,
                "an ADD of " + std::to_string(cloud.size()) +
                    " Gaussians cannot be encoded: its arrays disagree or it has more than " +
                    std::to_string(kMaxDeltaRecords) + "; split it");
  }
  if (const char* why = flaw(cloud)) {
    return fail(Errc::kInvalidArgument, std::string("an ADD cannot be encoded: ") + why);
  }
  const auto runs = runs_of(delta.chunks);
  DeltaHeader header = delta.header;
  header.kind = DeltaKind::kAdd;
  header.count = static_cast<std::uint32_t>(cloud.size());
  header.length_bytes = static_cast<std::uint32_t>(kBodyStart_bytes + kRun_bytes * runs.size() +
                                                   record_bytes(cloud.sh_degree) * cloud.size());
  ByteWriter out;
  write_header(out, header);
  out.write(kEncodingFloat32);
  out.write(static_cast<std::uint8_t>(cloud.sh_degree));
  out.write(std::uint16_t{0});
  out.write(static_cast<std::uint32_t>(runs.size()));
  for (const auto& [chunk, rows] : runs) {
    out.write(chunk.x);
    out.write(chunk.y);
    out.write(chunk.z);
    out.write(rows);
  }
  write_rows(out, cloud);
  const auto before = crc32c(out.bytes().first(kCrcOffset_bytes));
  out.patch(kCrcOffset_bytes, crc32c(out.bytes().subspan(kDeltaHeader_bytes), before));
  return out.take();
}

Result<DeltaHeader> decode_delta_header(std::span<const std::byte> bytes) {
  if (bytes.size() < kDeltaHeader_bytes || bytes.size() > kMaxDelta_bytes) {
    return fail(Errc::kCorrupt, "a delta of " + std::to_string(bytes.size()) + " bytes cannot be one");
  }
  ByteReader in(bytes);
  if (in.read<std::uint32_t>() != kDeltaMagic) return fail(Errc::kCorrupt, "not a delta: wrong magic number");
  if (const auto version = in.read<std::uint16_t>(); version != kDeltaVersion) {
    return fail(Errc::kCorrupt, "delta of version " + std::to_string(version) + ", this program reads " +
                                    std::to_string(kDeltaVersion) + ": update the older end");
  }
  DeltaHeader header;
  header.robot.value = in.read<std::uint16_t>();
  const auto uuid = in.take(16);
  std::copy(uuid.begin(), uuid.end(), header.map.bytes.begin());
  header.epoch.value = in.read<std::uint32_t>();
  header.seq = in.read<std::uint64_t>();
  header.base_seq = in.read<std::uint64_t>();
  const auto kind = in.read<std::uint8_t>();
  header.kind = static_cast<DeltaKind>(kind);
  header.count = in.read<std::uint32_t>();
  header.length_bytes = in.read<std::uint32_t>();
  const auto stated_crc = in.read<std::uint32_t>();
  if (header.length_bytes != in.remaining()) return fail(Errc::kCorrupt, "a delta's length does not match");
  const auto actual_crc = crc32c(bytes.subspan(kDeltaHeader_bytes), crc32c(bytes.first(kCrcOffset_bytes)));
  if (stated_crc != actual_crc) return fail(Errc::kCorrupt, "a delta's CRC32C does not match");
  if (kind < static_cast<std::uint8_t>(DeltaKind::kAdd) ||
      kind > static_cast<std::uint8_t>(DeltaKind::kMask)) {
    return fail(Errc::kCorrupt, "a delta of unknown kind " + std::to_string(kind));
  }
  if (header.seq == 0 || header.base_seq >= header.seq) {
    return fail(Errc::kCorrupt, "a delta's sequence numbers make no sense");
  }
  return header;
}

Result<AddDelta> decode_add(std::span<const std::byte> bytes) {
  AddDelta delta;
  EDGESPLAT_TRY(delta.header, decode_delta_header(bytes));
  if (delta.header.kind != DeltaKind::kAdd) {
    return fail(Errc::kInvalidArgument,
                std::string("not an ADD but ") + std::string(to_string(delta.header.kind)));
  }
  const std::size_t count = delta.header.count;
  ByteReader in(bytes.subspan(kDeltaHeader_bytes));
  const auto encoding = in.read<std::uint8_t>();
  const auto sh_degree = in.read<std::uint8_t>();
  in.skip(2);
  const std::size_t run_count = in.read<std::uint32_t>();
  if (!in.ok() || encoding != kEncodingFloat32 || sh_degree > 3 || count > kMaxDeltaRecords ||
      run_count > count) {
    return fail(Errc::kCorrupt, "an ADD's encoding, SH degree or counts make no sense");
  }
  if (in.remaining() != kRun_bytes * run_count + record_bytes(sh_degree) * count) {
    return fail(Errc::kCorrupt, "an ADD of " + std::to_string(count) + " Gaussians has the wrong length");
  }
  if (!read_runs(in, run_count, count, delta.chunks)) {
    return fail(Errc::kCorrupt, "an ADD's chunk table does not add up");
  }
  delta.gaussians.sh_degree = sh_degree;
  read_rows(in, count, delta.gaussians);
  if (const char* why = flaw(delta.gaussians))
    return fail(Errc::kCorrupt, std::string("an ADD is refused: ") + why);
  return delta;
}

std::string_view to_string(DeltaKind kind) {
  switch (kind) {
    case DeltaKind::kAdd:
      return "add";
    case DeltaKind::kUpdate:
      return "update";
    case DeltaKind::kRemove:
      return "remove";
    case DeltaKind::kChunkReplace:
      return "chunk_replace";
    case DeltaKind::kRepose:
      return "repose";
    case DeltaKind::kMask:
      return "mask";
  }
  return "unknown";
}

}  // namespace edgesplat::map
