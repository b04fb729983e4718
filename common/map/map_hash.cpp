// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_hash.hpp"

#include "common/base/check.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <vector>

namespace edgesplat::map {
namespace {

constexpr std::uint64_t kFieldSet = 1;  // version of what a digest covers; change it with the record

}  // namespace

std::uint64_t record_digest(const gaussian::GaussianCloud& cloud, std::size_t row) {
  // id, anchor, then mean 3, log scale 3, quaternion 4, opacity 1 and up to 48 SH coefficients.
  std::array<float, 11 + 48> floats{};
  const std::size_t sh_floats = cloud.sh_floats_each();
  float* to = floats.data();
  to = std::copy_n(cloud.means_m.data() + 3 * row, 3, to);
  to = std::copy_n(cloud.log_scales.data() + 3 * row, 3, to);
  to = std::copy_n(cloud.quats_xyzw.data() + 4 * row, 4, to);
  *to++ = cloud.opacity_logits[row];
  to = std::copy_n(cloud.sh.data() + sh_floats * row, sh_floats, to);
  const auto& anchor = cloud.anchors[row];
  const std::uint64_t anchored = (static_cast<std::uint64_t>(anchor.keyframe) << 32U) | anchor.pose_version;
  const std::uint64_t seed =
      cloud.ids[row].packed() ^ (anchored * 0x9E3779B97F4A7C15ULL) ^ (kFieldSet << 56U);
  return XXH3_64bits_withSeed(floats.data(), sizeof(float) * static_cast<std::size_t>(to - floats.data()),
                              seed);
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
