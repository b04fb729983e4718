// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/depth_order.hpp"

#include "common/thread/parallel_for.hpp"

#include <algorithm>
#include <array>
#include <memory>

namespace edgesplat::splat {
namespace {

constexpr unsigned kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr unsigned kPasses = 3;
/// Keys are dealt out in this many runs whatever the number of threads.
constexpr std::size_t kRuns = 8;

using Places = std::array<std::array<std::uint32_t, kDigits>, kRuns>;

std::size_t digit(const DepthKey& key, unsigned pass) {
  return key.depth_bits >> pass * kDigitBits & (kDigits - 1);
}

/// One pass of a stable radix sort: each run counts its digits, then moves its keys to places of its own.
void sort_by_digit(const std::vector<DepthKey>& from, unsigned pass, Places& places,
                   std::vector<DepthKey>& to) {
  const auto begin = [&from](std::size_t run) { return from.size() * run / kRuns; };
  thread::parallel_for(std::size_t{0}, kRuns, [&](std::size_t run) {
    places[run].fill(0);
    for (std::size_t i = begin(run); i < begin(run + 1); ++i) ++places[run][digit(from[i], pass)];
  });
  std::uint32_t next = 0;
  for (std::size_t d = 0; d < kDigits; ++d) {
    for (auto& run : places) {
      const std::uint32_t count = run[d];
      run[d] = next;
      next += count;
    }
  }
  thread::parallel_for(std::size_t{0}, kRuns, [&](std::size_t run) {
    for (std::size_t i = begin(run); i < begin(run + 1); ++i)
      to[places[run][digit(from[i], pass)]++] = from[i];
  });
}

}  // namespace

void sort_by_depth(std::vector<DepthKey>& keys, std::vector<DepthKey>& other) {
  const auto places = std::make_unique<Places>();
  other.resize(keys.size());
  for (unsigned pass = 0; pass < kPasses; ++pass) {
    sort_by_digit(keys, pass, *places, other);
    keys.swap(other);
  }
}

}  // namespace edgesplat::splat
