// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>

namespace edgesplat::mapping {

/// What a camera made of the scene's colours: seen = gain * colour + offset, a channel.
struct Exposure {
  std::array<float, 3> gain{1.0F, 1.0F, 1.0F};
  std::array<float, 3> offset{};
};

struct ExposureOptions {
  float rate = 2e-3F;  ///< of Adam, 0 (off)..0.05
  /// Pull towards gain 1 and offset 0, without which all pictures could become brighter together, 0..1
  float pull = 0.01F;
};

/// The learned exposures of the training pictures. Single-owner.
class ExposureTable {
 public:
  explicit ExposureTable(const ExposureOptions& options) : options_(options) {}

  [[nodiscard]] Exposure of(std::uint32_t key) const;
  /// Learns from dL by the seen picture [H,W,3], which becomes dL by the drawn one.
  void learn(std::uint32_t key, std::span<const float> drawn, std::span<float> by_seen);
  /// The same from dL by gain 3 and offset 3, where that is summed up already.
  void learn(std::uint32_t key, const std::array<double, 6>& gradient);
  void forget(std::uint32_t key) { entries_.erase(key); }
  [[nodiscard]] std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    Exposure exposure;
    std::array<double, 6> first{}, second{};
    int steps = 0;
  };
  void step(const std::array<double, 6>& gradient, Entry& entry) const;

  ExposureOptions options_;
  std::unordered_map<std::uint32_t, Entry> entries_;
};

/// `seen` = the exposure applied to `drawn`, both [H,W,3].
void apply(const Exposure& exposure, std::span<const float> drawn, std::span<float> seen);

}  // namespace edgesplat::mapping
