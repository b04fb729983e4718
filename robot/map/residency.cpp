// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/map/residency.hpp"

#include <algorithm>
#include <variant>

namespace edgesplat::map {
namespace {

constexpr std::size_t kMaxFetch = 8;
constexpr auto kPatience = std::chrono::seconds(1);

std::size_t tenths(std::size_t bytes, std::size_t count) {
  return bytes / 10 * count;
}

bool due(const std::optional<HostTime>& asked, HostTime now) {
  return !asked || now - *asked >= kPatience;
}

}  // namespace

float Residency::distance_m(const ChunkId& chunk) const {
  const Eigen::Vector3f cell(static_cast<float>(chunk.x), static_cast<float>(chunk.y),
                             static_cast<float>(chunk.z));
  return (kChunkEdge_m * (cell + Eigen::Vector3f::Constant(0.5F)) - robot_in_map_m_).norm();
}

Residency::Ranked Residency::farthest_first(const MapState& state) const {
  Ranked ranked;
  for (const auto& held : state.chunks().counts()) ranked.emplace_back(distance_m(held.first), held);
  std::sort(ranked.begin(), ranked.end(), std::greater<>());
  return ranked;
}

void Residency::applied(const Delta& delta) {
  if (delta.header.base_seq == 0) {
    absent_.clear();
    alone_.clear();
    asked_.clear();
  }
  const auto* replace = std::get_if<ChunkReplaceBody>(&delta.body);
  if (replace == nullptr) return;
  if (replace->dropped) {
    const auto alone = alone_.find(replace->chunk);
    const auto asked = asked_.find(replace->chunk);
    absent_[replace->chunk] = alone != alone_.end()   ? alone->second
                              : asked != asked_.end() ? asked->second
                                                      : 0;
    alone_.erase(replace->chunk);
    asked_.erase(replace->chunk);
  } else {
    absent_.erase(replace->chunk);
  }
}

std::vector<ChunkId> Residency::overflow(const MapState& state, std::size_t bytes_each) const {
  std::size_t held_bytes = state.size() * bytes_each;
  if (held_bytes <= budget_bytes_) return {};
  std::vector<ChunkId> chunks;
  for (const auto& [distance, held] : farthest_first(state)) {
    if (held_bytes <= tenths(budget_bytes_, 9)) break;
    chunks.push_back(held.first);
    held_bytes -= held.second * bytes_each;
  }
  return chunks;
}

void Residency::dropped_alone(const ChunkId& chunk, std::size_t gaussians) {
  alone_[chunk] = gaussians;
}

bool Residency::has_room(const MapState& state, std::size_t bytes_each) const {
  return state.size() * bytes_each < tenths(budget_bytes_, 8);
}

std::vector<ChunkId> Residency::to_fetch(const MapState& state, std::size_t bytes_each) const {
  std::vector<std::pair<float, std::pair<ChunkId, std::size_t>>> ranked;
  ranked.reserve(absent_.size());
  for (const auto& chunk : absent_) ranked.emplace_back(distance_m(chunk.first), chunk);
  std::sort(ranked.begin(), ranked.end());
  std::size_t expected_bytes = state.size() * bytes_each;
  std::vector<ChunkId> chunks;
  for (const auto& [distance, chunk] : ranked) {
    expected_bytes += chunk.second * bytes_each;
    if (expected_bytes > tenths(budget_bytes_, 8) || chunks.size() == kMaxFetch) break;
    chunks.push_back(chunk.first);
  }
  return chunks;
}

std::vector<MapRequest> Residency::requests(const MapState& state, std::size_t bytes_each, HostTime now) {
  std::vector<MapRequest> requests;
  std::size_t held_bytes = state.size() * bytes_each;
  std::set<ChunkId> release;
  for (const auto& [chunk, count] : alone_) release.insert(chunk);
  const bool full = held_bytes > tenths(budget_bytes_, 9);
  if (due(release_asked_, now) && (full || !absent_.empty())) {
    const Ranked ranked = farthest_first(state);
    float nearest_absent_m = std::numeric_limits<float>::infinity();
    for (const auto& [chunk, count] : absent_)
      nearest_absent_m = std::min(nearest_absent_m, distance_m(chunk));
    for (const auto& [distance, held] : ranked) {
      const bool must = full && held_bytes > tenths(budget_bytes_, 8);
      // Room for what the robot nears: at most one chunk at a time, and only for one much nearer.
      const bool swap = !must && held_bytes > tenths(budget_bytes_, 6) && release.empty() &&
                        distance > nearest_absent_m + kChunkEdge_m;
      if (!must && !swap) break;
      asked_[held.first] = held.second;
      release.insert(held.first);
      held_bytes -= held.second * bytes_each;
    }
  }
  if (!release.empty() && due(release_asked_, now)) {
    release_asked_ = now;
    MapRequest request;
    request.kind = RequestKind::kRelease;
    request.chunks = {release.begin(), release.end()};
    requests.push_back(std::move(request));
  } else if (!absent_.empty() && due(fetch_asked_, now)) {
    MapRequest request;
    request.kind = RequestKind::kFetch;
    request.chunks = to_fetch(state, bytes_each);
    if (!request.chunks.empty()) {
      fetch_asked_ = now;
      requests.push_back(std::move(request));
    }
  }
  return requests;
}

}  // namespace edgesplat::map
