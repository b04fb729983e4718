// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/image.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace edgesplat::quality {

/// [H,W] 1 where a pixel counts, 0 where it does not.
struct StaticWeights {
  std::vector<float> without_movers;  ///< all but what can move, parked too, and 5 px around it
  /// ... nor the road and other ground in a square around each region of one class that makes its larger
  /// extent 1.3 times as large (Semantic Gaussian Filter): most shadows fall there, and they move too.
  std::vector<float> without_shadows;
};

/// Which pixels of a street's picture count when a map of what stays is judged: not those of persons, riders
/// and vehicles, by ESPNetv2 (Mehta 2019, s = 2.0, trained on Cityscapes). Deterministic. Single-owner. A
/// picture of any size takes some 0.3 s.
class StaticMask {
 public:
  /// Reads espnetv2_s2_city_384x640.onnx. kNotFound, or kCorrupt where it is not that network.
  static Result<StaticMask> load(const std::filesystem::path& folder);
  StaticMask(StaticMask&&) noexcept;
  StaticMask& operator=(StaticMask&&) noexcept;
  StaticMask(const StaticMask&) = delete;
  StaticMask& operator=(const StaticMask&) = delete;
  ~StaticMask();

  /// kInvalidArgument for an empty picture.
  [[nodiscard]] Result<StaticWeights> weights(const sensor::ImageRgb8& picture);

 private:
  struct Network;
  explicit StaticMask(std::unique_ptr<Network> network);
  std::unique_ptr<Network> network_;
};

}  // namespace edgesplat::quality
