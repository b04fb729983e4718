// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_hash.hpp"

#include "common/base/check.hpp"

#define XXH_INLINE_ALL  // NOLINT(readability-identifier-naming): the library's own switch
#include <xxhash.h>

#include <array>
#include <cstring>

namespace edgesplat::map {
namespace {

constexpr std::uint64_t kFieldSet = 2;  // version of what a digest covers; change it with the record

}  // namespace

std::uint64_t record_digest(const QuantisedRows& rows, std::size_t row) {
  constexpr std::size_t kMaxShRest = 45;
  std::array<std::byte, sizeof(Channels) + kMaxShRest> record{};
  const std::size_t sh_rest = rows.sh_rest_each();
  std::memcpy(record.data(), rows.channels[row].data(), sizeof(Channels));
  if (sh_rest > 0)
    std::memcpy(record.data() + sizeof(Channels), rows.sh_rest.data() + sh_rest * row, sh_rest);
  const auto& anchor = rows.anchors[row];
  const std::uint64_t anchored = (static_cast<std::uint64_t>(anchor.keyframe) << 32U) | anchor.pose_version;
  const std::uint64_t seed = rows.ids[row].packed() ^ (anchored * 0x9E3779B97F4A7C15ULL) ^ (kFieldSet << 56U);
  return XXH3_64bits_withSeed(record.data(), sizeof(Channels) + sh_rest, seed);
}

void MapHash::add(const ChunkId& chunk, std::uint64_t record_digest) {
  Sum& sum = chunks_[chunk];
  ++sum.count;
  sum.digests += record_digest;  // modulo 2^64: the order does not matter
}

void MapHash::remove(const ChunkId& chunk, std::uint64_t record_digest) {
  const auto found = chunks_.find(chunk);
  EDGESPLAT_CHECK(found != chunks_.end(), "only what was added can be removed");
  found->second.digests -= record_digest;
  if (--found->second.count == 0) chunks_.erase(found);
}

std::uint64_t MapHash::chunk_value(const ChunkId& chunk) const {
  const auto found = chunks_.find(chunk);
  if (found == chunks_.end()) return 0;
  const std::array<std::uint64_t, 2> words = {found->second.count, found->second.digests};
  return XXH3_64bits(words.data(), sizeof(words));
}

std::vector<std::pair<ChunkId, std::size_t>> MapHash::counts() const {
  std::vector<std::pair<ChunkId, std::size_t>> all;
  all.reserve(chunks_.size());
  for (const auto& [chunk, sum] : chunks_) all.emplace_back(chunk, static_cast<std::size_t>(sum.count));
  return all;
}

std::uint64_t MapHash::value() const {
  std::vector<std::uint64_t> words;
  words.reserve(4 * chunks_.size());
  for (const auto& [chunk, sum] : chunks_) {
    const auto x = static_cast<std::uint64_t>(static_cast<std::uint32_t>(chunk.x));
    const auto y = static_cast<std::uint64_t>(static_cast<std::uint32_t>(chunk.y));
    words.push_back((x << 32U) | y);
    words.push_back(static_cast<std::uint64_t>(static_cast<std::uint32_t>(chunk.z)));
    words.push_back(sum.count);
    words.push_back(sum.digests);
  }
  return XXH3_64bits(words.data(), words.size() * sizeof(std::uint64_t));
}

}  // namespace edgesplat::map
