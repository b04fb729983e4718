// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/stream_parts.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace edgesplat::stream {
namespace {

constexpr std::size_t kMaxResend_bytes = std::size_t{1} << 20U;
/// A robot that asks again so soon has not seen the beginning of the snapshot it asked for.
constexpr double kSnapshotPatience_s = 10.0;

}  // namespace

std::vector<Bytes> DeltaStream::answer(const map::MapRequest& request, HostTime now) {
  const std::lock_guard lock(mutex_);
  if (request.kind != map::RequestKind::kSnapshot && request.epoch != config_.epoch) return {};
  switch (request.kind) {
    case map::RequestKind::kResend: {
      if (request.seq >= seq_) return {};
      if (ring_.holds(request.seq + 1)) return resend(request.seq + 1, std::min(request.until_seq, seq_));
      // The first deltas of a snapshot stand for everything before them.
      if (snapshot_seq_ > request.seq && ring_.holds(snapshot_seq_))
        return resend(snapshot_seq_, snapshot_seq_);
      ask_snapshot(request);
      return {};
    }
    case map::RequestKind::kSnapshot: {
      const bool begun = request.epoch == config_.epoch ? snapshot_seq_ > request.seq : snapshot_seq_ > 0;
      const bool lately = now - snapshot_asked_ < from_seconds(kSnapshotPatience_s);
      if (begun && lately && ring_.holds(snapshot_seq_)) return resend(snapshot_seq_, snapshot_seq_);
      snapshot_asked_ = now;
      ask_snapshot(request);
      return {};
    }
    case map::RequestKind::kMore:
      plan_.confirmed(request.seq);
      return {};
    case map::RequestKind::kRelease:
      for (const auto& chunk : request.chunks) {
        if (to_drop_.size() < map::kMaxRequestChunks) to_drop_.insert(chunk);
      }
      return {};
    case map::RequestKind::kFetch:
      for (const auto& chunk : request.chunks) (void)plan_.fetch(chunk);
      return {};
  }
  return {};
}

void DeltaStream::confirmed(map::Epoch epoch, std::uint64_t seq) {
  const std::lock_guard lock(mutex_);
  if (epoch == config_.epoch) plan_.confirmed(seq);
}

void DeltaStream::ask_snapshot(const map::MapRequest& request) {
  snapshot_near_m_ = request.robot_in_map_m;
}

std::vector<Bytes> DeltaStream::resend(std::uint64_t first, std::uint64_t last) {
  std::vector<Bytes> deltas;
  std::size_t bytes = 0;
  for (std::uint64_t seq = first; seq <= last && ring_.holds(seq) && bytes < kMaxResend_bytes; ++seq) {
    const auto delta = ring_.at(seq);
    bytes += delta.size();
    deltas.emplace_back(delta.begin(), delta.end());
  }
  counters_.resent += deltas.size();
  return deltas;
}

void DeltaStream::begin_snapshot(const gaussian::GaussianCloud& cloud, Outbox& out) {
  const Eigen::Vector3f near_m = *std::exchange(snapshot_near_m_, std::nullopt);
  ++counters_.snapshots;
  to_drop_.clear();
  held_.clear();  // now, so that every Gaussian is placed afresh
  std::set<map::ChunkId> chunks;
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    if (map::unquantisable(cloud, row) == nullptr) chunks.insert(place(cloud, row));
  }
  plan_.restart(std::vector<map::ChunkId>(chunks.begin(), chunks.end()), near_m);
  begins_anew_ = true;
  untold_mapped_ = mapped_;
  snapshot_seq_ = seq_ + 1;
  map::AddBody nothing;
  nothing.rows.sh_degree = cloud.sh_degree;
  (void)emit({{}, std::move(nothing)}, out);
}

void DeltaStream::send_chunks(const gaussian::GaussianCloud& cloud, Outbox& out) {
  for (const map::ChunkId& chunk : std::exchange(to_drop_, {})) {
    if (!plan_.release(chunk)) continue;
    map::ChunkReplaceBody body;
    body.chunk = chunk;
    body.dropped = true;
    (void)emit({{}, std::move(body)}, out);
  }
  if (!plan_.may_send()) return;
  const std::set<map::ChunkId> wanted(plan_.queue().begin(), plan_.queue().end());
  std::map<map::ChunkId, std::vector<std::uint32_t>> rows;
  for (std::uint32_t row = 0; row < cloud.size(); ++row) {
    if (map::unquantisable(cloud, row) != nullptr) continue;
    const map::ChunkId chunk = place(cloud, row);
    if (wanted.contains(chunk)) rows[chunk].push_back(row);
  }
  while (plan_.may_send() && !out.full()) {
    const map::ChunkId chunk = plan_.take();
    send_chunk(cloud, chunk, rows[chunk], out);
  }
}

void DeltaStream::send_chunk(const gaussian::GaussianCloud& cloud, const map::ChunkId& chunk,
                             std::span<const std::uint32_t> rows, Outbox& out) {
  map::QuantisedRows all;
  all.sh_degree = cloud.sh_degree;
  for (const std::uint32_t row : rows) map::append_quantised(cloud, row, chunk, all);
  all = map::sorted_by_chunk(all);
  map::ChunkReplaceBody body;
  body.chunk = chunk;
  body.more = true;
  body.rows.sh_degree = cloud.sh_degree;
  const std::size_t first_rows = std::min(all.size(), map::kMaxDeltaRecords);
  for (std::size_t row = 0; row < first_rows; ++row) body.rows.append_row(all, row);
  const std::size_t before_bytes = out.bytes;
  ++counters_.chunks;
  if (!emit({{}, std::move(body)}, out)) return;
  map::QuantisedRows rest;
  rest.sh_degree = cloud.sh_degree;
  for (std::size_t row = first_rows; row < all.size(); ++row) rest.append_row(all, row);
  if (rest.size() > 0) (void)emit({{}, map::AddBody{std::move(rest)}}, out);
  plan_.sent(seq_, out.bytes - before_bytes);
}

}  // namespace edgesplat::stream
