// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/row_codec.hpp"

#include "common/base/check.hpp"
#include "common/map/varint.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace edgesplat::map {
namespace {

constexpr std::size_t kMaxVarint_bytes = 10;

std::uint64_t step(std::int64_t now, std::int64_t before) {
  return zigzag(static_cast<std::uint64_t>(now - before));
}

void add_step(std::int32_t& cell, ByteReader& in) {
  cell = static_cast<std::int32_t>(static_cast<std::uint64_t>(cell) + unzigzag(read_varint(in)));
}

void write_anchors(AttributeWriter& out, std::span<const gaussian::Anchor> anchors) {
  ByteWriter steps;
  gaussian::Anchor before;
  for (const auto& anchor : anchors) {
    write_varint(steps, step(anchor.keyframe, before.keyframe));
    write_varint(steps, step(anchor.pose_version, before.pose_version));
    before = anchor;
  }
  out.sized_bytes(steps.bytes());
}

Status read_anchors(AttributeReader& in, std::vector<gaussian::Anchor>& anchors) {
  EDGESPLAT_TRY(const auto bytes, in.sized_bytes(2 * kMaxVarint_bytes * anchors.size()));
  ByteReader steps(bytes);
  gaussian::Anchor before;
  for (auto& anchor : anchors) {
    anchor.keyframe = static_cast<std::uint32_t>(before.keyframe + unzigzag(read_varint(steps)));
    anchor.pose_version = static_cast<std::uint32_t>(before.pose_version + unzigzag(read_varint(steps)));
    before = anchor;
  }
  if (!steps.ok() || steps.remaining() != 0) return fail(Errc::kCorrupt, "a delta's anchors do not add up");
  return {};
}

}  // namespace

QuantisedRows sorted_by_chunk(const QuantisedRows& rows) {
  std::vector<std::size_t> order(rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(rows.chunks[a], rows.ids[a]) < std::tie(rows.chunks[b], rows.ids[b]);
  });
  QuantisedRows sorted;
  sorted.sh_degree = rows.sh_degree;
  sorted.resize(rows.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted.set_row(i, rows, order[i]);
  return sorted;
}

void write_ids(AttributeWriter& out, std::span<const gaussian::GaussianId> ids) {
  ByteWriter steps;
  std::uint64_t before = 0;
  for (const auto& id : ids) {
    write_varint(steps, zigzag(id.packed() - before));
    before = id.packed();
  }
  out.sized_bytes(steps.bytes());
}

Result<std::vector<gaussian::GaussianId>> read_ids(AttributeReader& in, std::size_t count) {
  EDGESPLAT_TRY(const auto bytes, in.sized_bytes(kMaxVarint_bytes * count));
  ByteReader steps(bytes);
  std::vector<gaussian::GaussianId> ids(count);
  std::uint64_t before = 0;
  for (auto& id : ids) {
    before += unzigzag(read_varint(steps));
    id = gaussian::GaussianId::from_packed(before);
  }
  if (!steps.ok() || steps.remaining() != 0) return fail(Errc::kCorrupt, "a delta's ids do not add up");
  return ids;
}

void write_chunks(AttributeWriter& out, std::span<const ChunkId> chunks) {
  ByteWriter runs;
  ChunkId before;
  for (std::size_t first = 0; first < chunks.size();) {
    std::size_t end = first;
    while (end < chunks.size() && chunks[end] == chunks[first]) ++end;
    const ChunkId& chunk = chunks[first];
    write_varint(runs, step(chunk.x, before.x));
    write_varint(runs, step(chunk.y, before.y));
    write_varint(runs, step(chunk.z, before.z));
    write_varint(runs, end - first);
    before = chunk;
    first = end;
  }
  out.sized_bytes(runs.bytes());
}

Result<std::vector<ChunkId>> read_chunks(AttributeReader& in, std::size_t count) {
  EDGESPLAT_TRY(const auto bytes, in.sized_bytes(4 * kMaxVarint_bytes * count));
  ByteReader runs(bytes);
  std::vector<ChunkId> chunks;
  chunks.reserve(count);
  ChunkId chunk;
  while (runs.remaining() > 0) {
    add_step(chunk.x, runs);
    add_step(chunk.y, runs);
    add_step(chunk.z, runs);
    const std::uint64_t rows = read_varint(runs);
    if (!chunk_in_map(chunk) || !runs.ok() || rows == 0 || rows > count - chunks.size()) break;
    chunks.insert(chunks.end(), static_cast<std::size_t>(rows), chunk);
  }
  if (!runs.ok() || runs.remaining() != 0 || chunks.size() != count)
    return fail(Errc::kCorrupt, "a delta's chunk table does not add up");
  return chunks;
}

void write_fields(AttributeWriter& out, const QuantisedRows& rows, FieldMask mask, Values kind) {
  EDGESPLAT_CHECK(rows.consistent(), "rows of equal number");
  const std::size_t n = rows.size();
  if (has(mask, Field::kAnchor)) write_anchors(out, rows.anchors);
  std::vector<std::uint16_t> columns;
  for (const ChannelLayout& layout : kChannelLayouts) {
    if (!has(mask, layout.field)) continue;
    columns.resize(layout.count * n);
    for (std::size_t k = 0; k < layout.count; ++k) {
      for (std::size_t row = 0; row < n; ++row) columns[k * n + row] = rows.channels[row][layout.first + k];
    }
    out.integers(columns, layout.count, layout.bits, kind);
  }
  const std::size_t each = rows.sh_rest_each();
  if (!has(mask, Field::kSh) || each == 0) return;
  columns.resize(each * n);
  for (std::size_t k = 0; k < each; ++k) {
    for (std::size_t row = 0; row < n; ++row)
      columns[k * n + row] = static_cast<std::uint8_t>(rows.sh_rest[each * row + k]);
  }
  out.integers(columns, each, 8, kind);
}

Status read_fields(AttributeReader& in, FieldMask mask, QuantisedRows& rows) {
  const std::size_t n = rows.size();
  if (has(mask, Field::kAnchor)) EDGESPLAT_TRY_STATUS(read_anchors(in, rows.anchors));
  for (const ChannelLayout& layout : kChannelLayouts) {
    if (!has(mask, layout.field)) continue;
    EDGESPLAT_TRY(const auto columns, in.integers(n, layout.count, layout.bits));
    for (std::size_t k = 0; k < layout.count; ++k) {
      for (std::size_t row = 0; row < n; ++row) rows.channels[row][layout.first + k] = columns[k * n + row];
    }
  }
  const std::size_t each = rows.sh_rest_each();
  if (!has(mask, Field::kSh) || each == 0) return {};
  EDGESPLAT_TRY(const auto columns, in.integers(n, each, 8));
  for (std::size_t k = 0; k < each; ++k) {
    for (std::size_t row = 0; row < n; ++row)
      rows.sh_rest[each * row + k] = static_cast<std::int8_t>(columns[k * n + row]);
  }
  return {};
}

void append_difference(const QuantisedRows& value, std::size_t value_row, const QuantisedRows& before,
                       std::size_t before_row, QuantisedRows& differences) {
  differences.append_row(value, value_row);
  Channels& to = differences.channels.back();
  const Channels& from = before.channels[before_row];
  for (const ChannelLayout& layout : kChannelLayouts) {
    for (std::size_t k = layout.first; k < layout.first + layout.count; ++k)
      to[k] = static_cast<std::uint16_t>((to[k] - from[k]) & ((1 << layout.bits) - 1));
  }
  const std::size_t each = value.sh_rest_each();
  std::int8_t* sh = differences.sh_rest.data() + each * (differences.size() - 1);
  for (std::size_t k = 0; k < each; ++k)
    sh[k] = static_cast<std::int8_t>(sh[k] - before.sh_rest[each * before_row + k]);
}

void apply_difference(const QuantisedRows& differences, std::size_t row, FieldMask mask, QuantisedRows& rows,
                      std::size_t to) {
  if (has(mask, Field::kAnchor)) rows.anchors[to] = differences.anchors[row];
  Channels& channels = rows.channels[to];
  for (const ChannelLayout& layout : kChannelLayouts) {
    if (!has(mask, layout.field)) continue;
    for (std::size_t k = layout.first; k < layout.first + layout.count; ++k)
      channels[k] =
          static_cast<std::uint16_t>((channels[k] + differences.channels[row][k]) & ((1 << layout.bits) - 1));
  }
  const std::size_t each = rows.sh_rest_each();
  if (!has(mask, Field::kSh) || each == 0) return;
  for (std::size_t k = 0; k < each; ++k) {
    std::int8_t& value = rows.sh_rest[each * to + k];
    value = static_cast<std::int8_t>(value + differences.sh_rest[each * row + k]);
  }
}

}  // namespace edgesplat::map
