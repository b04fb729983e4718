// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/image.hpp"

#include <filesystem>
#include <memory>

namespace edgesplat::quality {

/// LPIPS v0.1 with AlexNet (Zhang 2018): 0 for equal pictures, about 0.1 for good renderings, 0.7 for noise.
/// Single-owner. A megapixel takes about a second.
class Lpips {
 public:
  /// Reads lpips_alex_feats_256x256.onnx and lpips_alex_lin.f32. kNotFound, or kCorrupt where they do not
  /// fit.
  static Result<Lpips> load(const std::filesystem::path& folder);
  Lpips(Lpips&&) noexcept;
  Lpips& operator=(Lpips&&) noexcept;
  Lpips(const Lpips&) = delete;
  Lpips& operator=(const Lpips&) = delete;
  ~Lpips();

  /// kInvalidArgument for pictures of different sizes or with a side under 64 px.
  [[nodiscard]] Result<double> distance(const sensor::ImageRgb8& a, const sensor::ImageRgb8& b);

 private:
  struct Network;
  explicit Lpips(std::unique_ptr<Network> network);
  std::unique_ptr<Network> network_;
};

}  // namespace edgesplat::quality
