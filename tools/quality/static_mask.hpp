// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/image.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace edgesplat::quality {

/// Which pixels of a street's picture count when a map of what stays is judged: all but persons, riders and
/// vehicles, parked ones too, by ESPNetv2 (Mehta 2019, s = 2.0, trained on Cityscapes). Deterministic.
/// Single-owner. A picture of any size takes some 0.3 s.
class StaticMask {
 public:
  /// Reads espnetv2_s2_city_384x640.onnx. kNotFound, or kCorrupt where it is not that network.
  static Result<StaticMask> load(const std::filesystem::path& folder);
  StaticMask(StaticMask&&) noexcept;
  StaticMask& operator=(StaticMask&&) noexcept;
  StaticMask(const StaticMask&) = delete;
  StaticMask& operator=(const StaticMask&) = delete;
  ~StaticMask();

  /// [H,W] 1 where the picture shows what stays, 0 where it shows what can move and close around that.
  /// kInvalidArgument for an empty picture.
  [[nodiscard]] Result<std::vector<float>> weight(const sensor::ImageRgb8& picture);

 private:
  struct Network;
  explicit StaticMask(std::unique_ptr<Network> network);
  std::unique_ptr<Network> network_;
};

}  // namespace edgesplat::quality
