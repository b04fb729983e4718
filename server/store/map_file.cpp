// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/map_file.hpp"

#include "common/io/atomic_file.hpp"
#include "common/map/delta_codec.hpp"
#include "server/store/map_records.hpp"
#include "server/store/record.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace edgesplat::store {
namespace {

constexpr std::uint32_t kMagic = 0x4D535345U;  // "ESSM"
constexpr std::uint16_t kVersion = 1;
constexpr std::size_t kFileHeader_bytes = 6;

Status write_record(const ByteSink& sink, RecordType type, std::span<const std::byte> payload) {
  EDGESPLAT_TRY_STATUS(sink(record_header(static_cast<std::uint8_t>(type), payload)));
  return sink(payload);
}

/// The quantised rows of the map in the order of the file, and the row of the cloud that each came from.
struct Ordered {
  map::QuantisedRows rows;
  std::vector<std::size_t> source;
};

Ordered ordered_rows(const gaussian::GaussianCloud& cloud) {
  std::vector<std::pair<map::ChunkId, std::size_t>> order;
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    if (map::unquantisable(cloud, row) != nullptr) continue;
    const float* m = cloud.means_m.data() + 3 * row;
    order.emplace_back(map::chunk_of({m[0], m[1], m[2]}), row);
  }
  std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    return std::pair(a.first, cloud.ids[a.second]) < std::pair(b.first, cloud.ids[b.second]);
  });
  Ordered ordered;
  ordered.rows.sh_degree = cloud.sh_degree;
  for (const auto& [chunk, row] : order) {
    map::append_quantised(cloud, row, chunk, ordered.rows);
    ordered.source.push_back(row);
  }
  return ordered;
}

/// Rows [first, end) of one chunk.
Status write_chunk(const StoredMap& map, const Ordered& ordered, std::size_t first, std::size_t end,
                   bool full_precision, const ByteSink& sink) {
  map::QuantisedRows rows;
  rows.sh_degree = ordered.rows.sh_degree;
  gaussian::GaussianCloud floats;
  floats.sh_degree = rows.sh_degree;
  for (std::size_t i = first; i < end; ++i) {
    rows.append_row(ordered.rows, i);
    if (full_precision) floats.append_row(map.gaussians, ordered.source[i]);
  }
  EDGESPLAT_TRY_STATUS(write_record(sink, RecordType::kChunk, encode_chunk(first, rows)));
  if (!full_precision) return {};
  return write_record(sink, RecordType::kFloats, encode_floats(first, floats));
}

/// What the records of a file said, before it is put together.
struct Parts {
  std::optional<Head> head;
  std::optional<std::vector<StoredPose>> poses;
  std::map<std::uint64_t, map::QuantisedRows> chunks;       ///< by the number of their first row
  std::map<std::uint64_t, gaussian::GaussianCloud> floats;  ///< the same
};

void take(const Record& record, Parts& parts) {
  switch (static_cast<RecordType>(record.type)) {
    case RecordType::kHead:
      if (auto head = decode_head(record.payload)) parts.head = *head;
      return;
    case RecordType::kPoses:
      if (auto poses = decode_poses(record.payload)) parts.poses = std::move(*poses);
      return;
    case RecordType::kChunk:
      if (auto chunk = decode_chunk(record.payload)) parts.chunks.insert(std::move(*chunk));
      return;
    case RecordType::kFloats:
      if (auto floats = decode_floats(record.payload)) parts.floats.insert(std::move(*floats));
      return;
  }
}

/// Floats that belong to these rows, or the rows themselves rounded.
gaussian::GaussianCloud best_of(const map::QuantisedRows& rows, const gaussian::GaussianCloud* floats) {
  const bool fits = floats != nullptr && floats->ids == rows.ids && floats->sh_degree == rows.sh_degree;
  if (!fits) return map::dequantise(rows);
  gaussian::GaussianCloud cloud = *floats;
  cloud.anchors = rows.anchors;
  return cloud;
}

LoadedMap put_together(Parts parts, std::size_t damaged_bytes) {
  LoadedMap loaded;
  loaded.report.damaged_bytes = damaged_bytes;
  loaded.report.poses_lost = !parts.poses.has_value();
  StoredMap& map = loaded.map;
  const Head& head = *parts.head;
  map = {head.map, head.robot, head.session, head.epoch, head.next_id_counter, {}, {}};
  if (parts.poses) map.poses = std::move(*parts.poses);
  map.gaussians.sh_degree = head.sh_degree;
  for (const auto& [first, rows] : parts.chunks) {
    if (rows.sh_degree != head.sh_degree) continue;
    const auto floats = parts.floats.find(first);
    const bool has_floats = floats != parts.floats.end();
    const auto cloud = best_of(rows, has_floats ? &floats->second : nullptr);
    if (head.full_precision && !has_floats) loaded.report.gaussians_rounded += rows.size();
    for (std::size_t row = 0; row < cloud.size(); ++row) map.gaussians.append_row(cloud, row);
  }
  const std::size_t expected = static_cast<std::size_t>(head.gaussians);
  loaded.report.gaussians_lost = expected - std::min(expected, map.gaussians.size());
  return loaded;
}

}  // namespace

Status write_map(const StoredMap& map, const MapFileOptions& options, const ByteSink& sink) {
  if (!map.gaussians.consistent())
    return fail(Errc::kInvalidArgument, "a map cannot be saved: its arrays disagree");
  const Ordered ordered = ordered_rows(map.gaussians);
  ByteWriter file_header;
  file_header.write(kMagic);
  file_header.write(kVersion);
  EDGESPLAT_TRY_STATUS(sink(file_header.bytes()));
  const Head head{map.map,
                  map.robot,
                  map.session,
                  map.epoch,
                  map.next_id_counter,
                  ordered.rows.size(),
                  map.gaussians.sh_degree,
                  options.full_precision};
  const auto head_bytes = encode_head(head);
  EDGESPLAT_TRY_STATUS(write_record(sink, RecordType::kHead, head_bytes));
  EDGESPLAT_TRY_STATUS(write_record(sink, RecordType::kPoses, encode_poses(map.poses)));
  const auto& chunks = ordered.rows.chunks;
  for (std::size_t first = 0; first < chunks.size();) {
    std::size_t end = first;
    while (end < chunks.size() && chunks[end] == chunks[first] && end - first < kMaxChunkRows) ++end;
    EDGESPLAT_TRY_STATUS(write_chunk(map, ordered, first, end, options.full_precision, sink));
    first = end;
  }
  return write_record(sink, RecordType::kHead, head_bytes);  // again: without a head nothing can be recovered
}

Result<LoadedMap> read_map(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  if (in.read<std::uint32_t>() != kMagic) return fail(Errc::kCorrupt, "not a map file: wrong magic number");
  if (const auto version = in.read<std::uint16_t>(); !in.ok() || version != kVersion) {
    return fail(Errc::kCorrupt, "map file of version " + std::to_string(version) + ", this program reads " +
                                    std::to_string(kVersion) + ": update it");
  }
  RecordReader records(bytes, kFileHeader_bytes);
  Parts parts;
  while (const auto record = records.next()) take(*record, parts);
  if (!parts.head) {
    return fail(
        Errc::kCorrupt,
        "both copies of the map file's head are damaged: restore a copy, or move it away to start anew");
  }
  return put_together(std::move(parts), records.damaged_bytes());
}

Status save_map(const std::filesystem::path& path, const StoredMap& map, const MapFileOptions& options) {
  EDGESPLAT_TRY(io::AtomicFile file, io::AtomicFile::create(path));
  EDGESPLAT_TRY_STATUS(
      write_map(map, options, [&](std::span<const std::byte> bytes) { return file.append(bytes); }));
  return file.commit();
}

Result<LoadedMap> load_map(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto bytes, io::read_file(path, kMaxMapFile_bytes));
  auto loaded = read_map(bytes);
  if (!loaded) return fail(loaded.error().code, path.string() + ": " + loaded.error().context);
  return loaded;
}

}  // namespace edgesplat::store
