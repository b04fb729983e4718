// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/delta_stream.hpp"

#include "common/map/row_codec.hpp"
#include "server/stream/row_change.hpp"
#include "server/stream/stream_parts.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace edgesplat::stream {
namespace {

map::QuantisedRows part_of(const map::QuantisedRows& rows, std::size_t first, std::size_t end) {
  map::QuantisedRows part;
  part.sh_degree = rows.sh_degree;
  for (std::size_t row = first; row < end; ++row) part.append_row(rows, row);
  return part;
}

}  // namespace

DeltaStream::DeltaStream(const DeltaStreamConfig& config)
    : config_(config), ring_(config.ring_deltas, config.ring_bytes), plan_(config.window_bytes) {}

std::vector<Bytes> DeltaStream::publish(const gaussian::GaussianCloud& cloud,
                                        std::span<const std::uint32_t> changed_rows,
                                        std::span<const gaussian::GaussianId> removed,
                                        std::size_t byte_budget) {
  const std::lock_guard lock(mutex_);
  Outbox out{byte_budget, config_.max_deltas};
  for (const auto& id : removed) waiting_.erase(id);
  send_removed({removed.begin(), removed.end()}, out);
  if (snapshot_near_m_) begin_snapshot(cloud, out);
  send_chunks(cloud, out);
  Changes changes = sort_out(cloud, candidates(cloud, changed_rows));
  waiting_.clear();
  send_removed(std::move(changes.left), out);
  const bool complete = send_added(map::sorted_by_chunk(changes.added), out) && plan_.waiting() == 0;
  if (complete) send_mapped(out);
  send_updates(cloud, std::move(changes.updates), out);
  return std::move(out.deltas);
}

std::vector<std::uint32_t> DeltaStream::candidates(const gaussian::GaussianCloud& cloud,
                                                   std::span<const std::uint32_t> changed_rows) const {
  std::vector<char> wanted(cloud.size(), 0);
  for (const std::uint32_t row : changed_rows) {
    if (row < wanted.size()) wanted[row] = 1;
  }
  std::vector<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < wanted.size(); ++row) {
    if (wanted[row] != 0 || (!waiting_.empty() && waiting_.contains(cloud.ids[row]))) rows.push_back(row);
  }
  return rows;
}

map::ChunkId DeltaStream::place(const gaussian::GaussianCloud& cloud, std::size_t row) const {
  const float* mean_m = cloud.means_m.data() + 3 * row;
  const Eigen::Vector3f p_in_map_m(mean_m[0], mean_m[1], mean_m[2]);
  const auto held = held_.find(cloud.ids[row]);
  return held ? map::chunk_after_move(held_.rows().chunks[*held], p_in_map_m) : map::chunk_of(p_in_map_m);
}

DeltaStream::Changes DeltaStream::sort_out(const gaussian::GaussianCloud& cloud,
                                           std::span<const std::uint32_t> rows) {
  Changes changes;
  changes.added.sh_degree = cloud.sh_degree;
  for (const std::uint32_t row : rows) {
    if (map::unquantisable(cloud, row) != nullptr) {
      ++counters_.unquantisable;
      continue;
    }
    const map::ChunkId chunk = place(cloud, row);
    const auto held = held_.find(cloud.ids[row]);
    if (plan_.withheld(chunk)) {
      if (held) changes.left.push_back(cloud.ids[row]);
    } else if (!held || held_.rows().chunks[*held] != chunk) {
      map::append_quantised(cloud, row, chunk, changes.added);
    } else {
      const RowChange change = measure_change({cloud, row}, {held_.rows(), *held}, config_.tolerance);
      if (change.fields != 0) changes.updates.push_back({change.priority, change.fields, row});
    }
  }
  return changes;
}

bool DeltaStream::emit(map::Delta delta, Outbox& out) {
  delta.header.robot = config_.robot;
  delta.header.map = config_.map;
  delta.header.epoch = config_.epoch;
  delta.header.seq = seq_ + 1;
  delta.header.base_seq = begins_anew_ ? 0 : seq_;
  auto bytes = map::encode_delta(delta);
  // The robot gets what the bytes say (poses are rounded on the way), so the mirror does too.
  auto as_sent = bytes ? map::decode_delta(*bytes) : Result<map::Delta>(fail(Errc::kInvalidArgument, ""));
  if (!as_sent || !held_.apply(*as_sent)) {
    ++counters_.refused;
    return false;
  }
  begins_anew_ = false;
  ++seq_;
  out.bytes += bytes->size();
  out.last_bytes = bytes->size();
  ring_.push(seq_, *bytes);
  out.deltas.push_back(std::move(*bytes));
  return true;
}

void DeltaStream::send_removed(std::vector<gaussian::GaussianId> ids, Outbox& out) {
  std::erase_if(ids, [this](const auto& id) { return !held_.find(id); });
  std::sort(ids.begin(), ids.end());
  for (std::size_t first = 0; first < ids.size(); first += map::kMaxDeltaRecords) {
    const std::size_t end = std::min(first + map::kMaxDeltaRecords, ids.size());
    const auto begin = ids.begin() + static_cast<std::ptrdiff_t>(first);
    map::RemoveBody body{{begin, ids.begin() + static_cast<std::ptrdiff_t>(end)}};
    if (emit({{}, std::move(body)}, out)) counters_.removed += end - first;
  }
}

bool DeltaStream::send_added(map::QuantisedRows rows, Outbox& out) {
  std::size_t first = 0;
  while (first < rows.size() && !out.full()) {
    const std::size_t end = std::min(first + config_.max_rows, rows.size());
    if (!emit({{}, map::AddBody{part_of(rows, first, end)}}, out)) break;
    counters_.added += end - first;
    counters_.add_bytes += out.last_bytes;
    first = end;
  }
  waiting_.insert(rows.ids.begin() + static_cast<std::ptrdiff_t>(first), rows.ids.end());
  return first >= rows.size();
}

void DeltaStream::mapped(std::span<const std::uint32_t> keyframes) {
  const std::lock_guard lock(mutex_);
  mapped_.insert(keyframes.begin(), keyframes.end());
  untold_mapped_.insert(keyframes.begin(), keyframes.end());
}

void DeltaStream::send_mapped(Outbox& out) {
  while (!untold_mapped_.empty()) {
    map::MappedBody body;
    auto end = untold_mapped_.begin();
    while (end != untold_mapped_.end() && body.keyframes.size() < map::kMaxMappedKeyframes)
      body.keyframes.push_back(*end++);
    if (!emit({{}, std::move(body)}, out)) return;
    untold_mapped_.erase(untold_mapped_.begin(), end);
  }
}

void DeltaStream::send_updates(const gaussian::GaussianCloud& cloud, std::vector<Update> updates,
                               Outbox& out) {
  std::size_t fitting = 0;
  if (!out.full()) {
    const double room_bytes = static_cast<double>(out.budget_bytes - out.bytes);
    fitting = std::min(updates.size(), static_cast<std::size_t>(room_bytes / bytes_per_update_));
  }
  const auto middle = updates.begin() + static_cast<std::ptrdiff_t>(fitting);
  std::nth_element(updates.begin(), middle, updates.end(),
                   [](const auto& a, const auto& b) { return a.priority > b.priority; });
  for (auto left = middle; left != updates.end(); ++left) waiting_.insert(cloud.ids[left->row]);
  updates.erase(middle, updates.end());
  std::sort(updates.begin(), updates.end(),
            [&](const auto& a, const auto& b) { return cloud.ids[a.row] < cloud.ids[b.row]; });
  for (std::size_t first = 0; first < updates.size(); first += config_.max_rows) {
    const std::size_t count = std::min(config_.max_rows, updates.size() - first);
    if (!send_update(cloud, std::span(updates).subspan(first, count), out)) return;
  }
}

bool DeltaStream::send_update(const gaussian::GaussianCloud& cloud, std::span<const Update> updates,
                              Outbox& out) {
  map::UpdateBody body;
  body.differences.sh_degree = cloud.sh_degree;
  map::QuantisedRows now;
  now.sh_degree = cloud.sh_degree;
  for (const Update& update : updates) {
    const HeldRow held{held_.rows(), *held_.find(cloud.ids[update.row])};
    if (!append_settled({cloud, update.row}, held, update.fields, now)) continue;
    map::append_difference(now, now.size() - 1, held.rows, held.row, body.differences);
    body.fields |= update.fields;
  }
  if (now.size() == 0) return true;
  if (!emit({{}, std::move(body)}, out)) return false;
  counters_.updated += now.size();
  counters_.update_bytes += out.last_bytes;
  const double each = static_cast<double>(out.last_bytes) / static_cast<double>(now.size());
  bytes_per_update_ += 0.5 * (std::min(each, 64.0) - bytes_per_update_);
  return true;
}

std::vector<Bytes> DeltaStream::repose(std::span<const map::PoseCorrection> corrections) {
  const std::lock_guard lock(mutex_);
  Outbox out{0, 0};
  for (std::size_t first = 0; first < corrections.size(); first += map::kMaxPoseCorrections) {
    const auto part =
        corrections.subspan(first, std::min(map::kMaxPoseCorrections, corrections.size() - first));
    (void)emit({{}, map::ReposeBody{{part.begin(), part.end()}}}, out);
  }
  return std::move(out.deltas);
}

std::vector<Bytes> DeltaStream::mask(const map::MaskBody& mask) {
  const std::lock_guard lock(mutex_);
  Outbox out{0, 0};
  (void)emit({{}, mask}, out);
  return std::move(out.deltas);
}

StreamPosition DeltaStream::position() const {
  const std::lock_guard lock(mutex_);
  return {seq_, held_.hash(), held_.size()};
}

DeltaStreamCounters DeltaStream::counters() const {
  const std::lock_guard lock(mutex_);
  DeltaStreamCounters counters = counters_;
  counters.waiting = waiting_.size();
  counters.waiting_chunks = plan_.waiting();
  return counters;
}

}  // namespace edgesplat::stream
