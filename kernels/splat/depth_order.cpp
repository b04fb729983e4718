// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/depth_order.hpp"
#include "common/thread/parallel_for.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace edgesplat::splat {
namespace {

constexpr unsigned kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr unsigned kPasses = 3;

/// A splat's place in the input by its depth: positive floats sort as their bits do.
struct Key {
  std::uint32_t depth_bits;
  std::uint32_t index;
};

std::size_t digit(const Key& key, unsigned pass) {
  return key.depth_bits >> pass * kDigitBits & (kDigits - 1);
}

/// Stable radix sort, least digit first. A few passes over a small array beat comparing.
void sort_keys(std::vector<Key>& keys) {
  std::array<std::array<std::uint32_t, kDigits>, kPasses> places{};
  for (const Key& key : keys) {
    for (unsigned pass = 0; pass < kPasses; ++pass) ++places[pass][digit(key, pass)];
  }
  std::vector<Key> other(keys.size());
  for (unsigned pass = 0; pass < kPasses; ++pass) {
    std::uint32_t next = 0;
    for (std::uint32_t& place : places[pass]) {
      const std::uint32_t count = place;
      place = next;
      next += count;
    }
    for (const Key& key : keys) other[places[pass][digit(key, pass)]++] = key;
    keys.swap(other);
  }
}

}  // namespace

std::vector<Splat> sorted_by_depth(const std::vector<Splat>& splats) {
  constexpr std::size_t kBlock = 8192;
  std::vector<Key> keys(splats.size());
  for (std::size_t i = 0; i < splats.size(); ++i)
    keys[i] = {std::bit_cast<std::uint32_t>(splats[i].depth_m), static_cast<std::uint32_t>(i)};
  sort_keys(keys);
  std::vector<Splat> sorted(splats.size());
  thread::parallel_for(std::size_t{0}, (keys.size() + kBlock - 1) / kBlock, [&](std::size_t b) {
    for (std::size_t i = b * kBlock; i < std::min(keys.size(), (b + 1) * kBlock); ++i)
      sorted[i] = splats[keys[i].index];
  });
  return sorted;
}

}  // namespace edgesplat::splat
