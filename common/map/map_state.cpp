// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_state.hpp"

#include "common/map/repose.hpp"
#include "common/map/row_codec.hpp"

#include <utility>

namespace edgesplat::map {
namespace {

/// The Gaussians a delta brings or changes, or nullptr where it brings none.
const QuantisedRows* rows_of(const Delta& delta) {
  if (const auto* add = std::get_if<AddBody>(&delta.body)) return &add->rows;
  if (const auto* update = std::get_if<UpdateBody>(&delta.body)) return &update->differences;
  if (const auto* replace = std::get_if<ChunkReplaceBody>(&delta.body)) return &replace->rows;
  return nullptr;
}

}  // namespace

Status MapState::apply(const Delta& delta) {
  const bool begins_anew = delta.header.base_seq == 0;
  const QuantisedRows* rows = rows_of(delta);
  const bool brings_rows = rows != nullptr && rows->size() > 0;
  if (brings_rows && !begins_anew && size() > 0 && rows->sh_degree != rows_.sh_degree)
    return fail(Errc::kCorrupt, "a delta's SH degree is not that of the map");
  if (begins_anew) clear();
  if (brings_rows && size() == 0) rows_.sh_degree = rows->sh_degree;
  std::visit([this](const auto& body) { apply_body(body); }, delta.body);
  return {};
}

void MapState::clear() {
  rows_ = {};
  index_.clear();
  hash_.clear();
  levels_.clear();
  mask_.reset();
}

std::uint64_t MapState::digest(std::size_t row) const {
  return record_digest(rows_, row);
}

void MapState::put(const QuantisedRows& from, std::size_t row) {
  const auto known = index_.find(from.ids[row]);
  const std::size_t to = known ? *known : size();
  if (known) {
    hash_.remove(rows_.chunks[to], digest(to));
    rows_.set_row(to, from, row);
  } else {
    rows_.append_row(from, row);
    index_.set(from.ids[row], static_cast<std::uint32_t>(to));
  }
  hash_.add(rows_.chunks[to], digest(to));
}

void MapState::remove_row(std::size_t row) {
  hash_.remove(rows_.chunks[row], digest(row));
  index_.erase(rows_.ids[row]);
  const std::size_t last = size() - 1;
  if (row != last) {
    rows_.set_row(row, rows_, last);
    index_.set(rows_.ids[row], static_cast<std::uint32_t>(row));
  }
  rows_.resize(last);
}

std::size_t MapState::drop_chunk(const ChunkId& chunk) {
  levels_.erase(chunk);
  if (hash_.chunk_value(chunk) == 0) return 0;
  const std::size_t before = size();
  for (std::size_t row = size(); row-- > 0;) {  // from the end: the row that moves up was looked at
    if (rows_.chunks[row] == chunk) remove_row(row);
  }
  return before - size();
}

void MapState::apply_body(const AddBody& body) {
  for (std::size_t row = 0; row < body.rows.size(); ++row) put(body.rows, row);
}

void MapState::apply_body(const UpdateBody& body) {
  for (std::size_t row = 0; row < body.differences.size(); ++row) {
    const auto to = index_.find(body.differences.ids[row]);
    if (!to) continue;
    hash_.remove(rows_.chunks[*to], digest(*to));
    apply_difference(body.differences, row, body.fields, rows_, *to);
    hash_.add(rows_.chunks[*to], digest(*to));
  }
}

void MapState::apply_body(const RemoveBody& body) {
  for (const auto& id : body.ids) {
    if (const auto row = index_.find(id)) remove_row(*row);
  }
}

void MapState::apply_body(const ChunkReplaceBody& body) {
  (void)drop_chunk(body.chunk);
  if (body.level != 0 && !body.dropped) levels_[body.chunk] = body.level;
  for (std::size_t row = 0; row < body.rows.size(); ++row) put(body.rows, row);
}

void MapState::apply_body(const ReposeBody& body) {
  const Repose repose(body.corrections);
  for (std::size_t row = 0; row < size(); ++row) {
    const ChunkId chunk_before = rows_.chunks[row];
    const std::uint64_t digest_before = digest(row);
    if (!repose.move(rows_, row)) continue;
    hash_.remove(chunk_before, digest_before);
    hash_.add(rows_.chunks[row], digest(row));
  }
}

void MapState::apply_body(const MaskBody& body) {
  if (!mask_ || body.version > mask_->version) mask_ = body;
}

std::uint8_t MapState::level(const ChunkId& chunk) const {
  const auto found = levels_.find(chunk);
  return found == levels_.end() ? std::uint8_t{0} : found->second;
}

std::size_t MapState::bytes_each() const {
  constexpr std::size_t kIndexShare_bytes = 24;  // slots of 16 bytes, between 3/8 and 3/4 full
  return sizeof(gaussian::GaussianId) + sizeof(ChunkId) + sizeof(Channels) + sizeof(gaussian::Anchor) +
         rows_.sh_rest_each() + kIndexShare_bytes;
}

std::size_t MapState::bytes() const {
  return size() * bytes_each();
}

}  // namespace edgesplat::map
