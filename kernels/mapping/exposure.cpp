// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/exposure.hpp"
#include "common/thread/parallel_for.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace edgesplat::mapping {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 14U;  ///< pixels

std::size_t block_count(std::size_t floats) {
  return (floats / 3 + kBlock - 1) / kBlock;
}

}  // namespace

Exposure ExposureTable::of(std::uint32_t key) const {
  const auto found = entries_.find(key);
  return found == entries_.end() ? Exposure{} : found->second.exposure;
}

void ExposureTable::learn(std::uint32_t key, std::span<const float> drawn, std::span<float> by_seen) {
  Entry& entry = entries_[key];
  std::vector<std::array<double, 6>> parts(block_count(drawn.size()));
  thread::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t b) {
    std::array<double, 6> sum{};
    const std::size_t last = std::min(drawn.size(), 3 * kBlock * (b + 1));
    for (std::size_t i = 3 * kBlock * b; i < last; i += 3) {
      for (std::size_t c = 0; c < 3; ++c) {
        sum[c] += static_cast<double>(by_seen[i + c] * drawn[i + c]);
        sum[3 + c] += static_cast<double>(by_seen[i + c]);
        by_seen[i + c] *= entry.exposure.gain[c];
      }
    }
    parts[b] = sum;
  });
  std::array<double, 6> gradient{};
  for (const auto& part : parts)
    for (std::size_t k = 0; k < 6; ++k) gradient[k] += part[k];
  step(gradient, entry);
}

void ExposureTable::learn(std::uint32_t key, const std::array<double, 6>& gradient) {
  step(gradient, entries_[key]);
}

void ExposureTable::step(const std::array<double, 6>& gradient, Entry& entry) const {
  constexpr double kBeta1 = 0.9, kBeta2 = 0.999;
  ++entry.steps;
  const double correction1 = 1.0 - std::pow(kBeta1, entry.steps);
  const double correction2 = 1.0 - std::pow(kBeta2, entry.steps);
  for (std::size_t k = 0; k < 6; ++k) {
    float& value = k < 3 ? entry.exposure.gain[k] : entry.exposure.offset[k - 3];
    const double away = static_cast<double>(value) - (k < 3 ? 1.0 : 0.0);
    const double g = gradient[k] + static_cast<double>(options_.pull) * away;
    entry.first[k] = kBeta1 * entry.first[k] + (1.0 - kBeta1) * g;
    entry.second[k] = kBeta2 * entry.second[k] + (1.0 - kBeta2) * g * g;
    const double move = entry.first[k] / correction1 / (std::sqrt(entry.second[k] / correction2) + 1e-12);
    const double next = static_cast<double>(value) - static_cast<double>(options_.rate) * move;
    if (std::isfinite(next))
      value = static_cast<float>(k < 3 ? std::clamp(next, 0.1, 10.0) : std::clamp(next, -1.0, 1.0));
  }
}

void apply(const Exposure& exposure, std::span<const float> drawn, std::span<float> seen) {
  thread::parallel_for(std::size_t{0}, block_count(drawn.size()), [&](std::size_t b) {
    const std::size_t last = std::min(drawn.size(), 3 * kBlock * (b + 1));
    for (std::size_t i = 3 * kBlock * b; i < last; i += 3) {
      for (std::size_t c = 0; c < 3; ++c) seen[i + c] = exposure.gain[c] * drawn[i + c] + exposure.offset[c];
    }
  });
}

}  // namespace edgesplat::mapping
