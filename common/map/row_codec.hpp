// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/attribute_stream.hpp"
#include "common/map/quantised.hpp"

#include <span>

namespace edgesplat::map {

/// Largest number of rows in one body, bounds what a reader allocates.
inline constexpr std::size_t kMaxDeltaRecords = 65536;

/// The order in which rows travel shortest: by chunk, then id.
[[nodiscard]] QuantisedRows sorted_by_chunk(const QuantisedRows& rows);

/// Ids in ascending runs as differences: a byte or less each where they are dense.
void write_ids(AttributeWriter& out, std::span<const gaussian::GaussianId> ids);
[[nodiscard]] Result<std::vector<gaussian::GaussianId>> read_ids(AttributeReader& in, std::size_t count);

/// Chunks as a table of runs.
void write_chunks(AttributeWriter& out, std::span<const ChunkId> chunks);
/// kCorrupt too for a chunk beyond the map.
[[nodiscard]] Result<std::vector<ChunkId>> read_chunks(AttributeReader& in, std::size_t count);

/// The fields of `mask`, one stream each; `rows` must be consistent.
void write_fields(AttributeWriter& out, const QuantisedRows& rows, FieldMask mask, Values kind);
/// Into `rows`, already resized to the right number; fields that are not in `mask` stay.
[[nodiscard]] Status read_fields(AttributeReader& in, FieldMask mask, QuantisedRows& rows);

/// `value - before` channel by channel, each modulo its width; SH alike. Anchor and id are `value`'s.
void append_difference(const QuantisedRows& value, std::size_t value_row, const QuantisedRows& before,
                       std::size_t before_row, QuantisedRows& differences);
/// Adds one row of differences to row `to` of `rows`.
void apply_difference(const QuantisedRows& differences, std::size_t row, FieldMask mask, QuantisedRows& rows,
                      std::size_t to);

}  // namespace edgesplat::map
