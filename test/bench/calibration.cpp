// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/bench/calibration.hpp"

#include "common/thread/parallel_for.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <limits>
#include <vector>

namespace edgesplat::bench {
namespace {

constexpr std::size_t kChains = 64;  // enough in flight for the latency of a multiply-add
constexpr std::size_t kRounds = (std::size_t{1} << 28U) / kChains;
constexpr std::size_t kCopyFloats = std::size_t{2} << 20U;
constexpr int kCopies = 4;

struct Work {
  std::array<float, kChains> chains;
  std::vector<float> from, to;
};

#if defined(__x86_64__)
[[gnu::target("avx2,fma")]]
#endif
void multiply_add(Work& work) {
  std::array<float, kChains> sums = work.chains;
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (float& sum : sums) sum = sum * 0.999F + 0.001F;
  }
  work.chains = sums;
}

}  // namespace

double calibration_ms() {
  static std::array<Work, 2> works = [] {
    std::array<Work, 2> made;
    for (Work& work : made) {
      work.chains.fill(0.5F);
      work.from.assign(kCopyFloats, 1.0F);
      work.to.assign(kCopyFloats, 0.0F);
    }
    return made;
  }();
  double best_ms = std::numeric_limits<double>::infinity();
  for (int attempt = 0; attempt < 3; ++attempt) {
    const auto begin = std::chrono::steady_clock::now();
    thread::parallel_for(std::size_t{0}, works.size(), [](std::size_t i) {
      multiply_add(works[i]);
      for (int copy = 0; copy < kCopies; ++copy)
        std::copy(works[i].from.begin(), works[i].from.end(), works[i].to.begin());
    });
    const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - begin;
    best_ms = std::min(best_ms, passed.count());
  }
  return best_ms;
}

}  // namespace edgesplat::bench
