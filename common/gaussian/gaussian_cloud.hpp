// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_id.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::gaussian {

/// The keyframe a Gaussian moves with, and the version of that keyframe's pose it was last placed by.
struct Anchor {
  std::uint32_t keyframe = 0;
  std::uint32_t pose_version = 0;
  bool operator==(const Anchor&) const = default;
};

/// N Gaussians as a structure of arrays, in the map frame. All arrays have N rows. Colour is sRGB (as in the
/// INRIA files): degree 0 gives rgb = 0.5 + kShC0 * sh. Plain values, no invariants beyond the lengths; see
/// consistent().
struct GaussianCloud {
  static constexpr float kShC0 = 0.28209479177387814F;

  int sh_degree = 0;                  ///< 0..3
  std::vector<GaussianId> ids;        ///< [N]
  std::vector<float> means_m;         ///< [N,3] in map
  std::vector<float> log_scales;      ///< [N,3] natural log of metres
  std::vector<float> quats_xyzw;      ///< [N,4] map_from_gaussian, unit length within 1e-3
  std::vector<float> opacity_logits;  ///< [N] opacity = sigmoid
  std::vector<float> sh;              ///< [N,(sh_degree+1)^2,3]
  std::vector<Anchor> anchors;        ///< [N]

  [[nodiscard]] std::size_t size() const { return ids.size(); }
  [[nodiscard]] std::size_t sh_floats_each() const {
    const auto bands = static_cast<std::size_t>(sh_degree + 1);
    return 3 * bands * bands;
  }
  /// Every array has the length that ids and sh_degree ask for.
  [[nodiscard]] bool consistent() const;
  void resize(std::size_t count);
  /// Appends row `row` of `other`, which must have the same sh_degree.
  void append_row(const GaussianCloud& other, std::size_t row);
  /// Copies row `from` onto row `to` (both of this cloud).
  void copy_row(std::size_t from, std::size_t to);
};

}  // namespace edgesplat::gaussian
