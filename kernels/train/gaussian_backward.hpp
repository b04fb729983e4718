// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/gaussian_spans.hpp"
#include "kernels/train/blend_backward.hpp"
#include "kernels/train/parameter_row.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::train {

/// How one picture saw one Gaussian; what densifying and pruning go by.
struct Sighting {
  float centre_gradient_px;  ///< length of dL/d(u, v)
  float weight;              ///< sum of blending weights
  float radius_px;           ///< larger half of its box on the screen
};

/// dL by the parameters of the Gaussians that a picture shows (in front of the others in some pixel, at
/// least), and by its pose.
struct GaussianGradients {
  std::size_t stride = 0;
  std::vector<std::uint32_t> rows;  ///< [V] ascending
  std::vector<float> values;        ///< [V,stride] laid out as ParameterRow, padding 0
  std::vector<Sighting> sightings;  ///< [V]
  std::array<double, 6>
      pose{};  ///< dr, dt: camera_from_map ⊞ (dr, dt) = (rotation Exp(dr), translation + dt)

  [[nodiscard]] std::span<const float> row(std::size_t i) const {
    return std::span(values).subspan(i * stride, stride);
  }
};

/// Reverse of splat::project into `out`, whose memory is used again: from gradients by the splats
/// (blend_backward, same order as `splats`) to those by the Gaussians. A Gaussian whose gradient is not
/// finite gets zeros. Deterministic whatever the number of threads.
void gaussian_backward(const splat::GaussianSpans& gaussians, const splat::View& view,
                       std::span<const splat::Splat> splats, std::span<const SplatBackward> by_splat,
                       GaussianGradients& out);

}  // namespace edgesplat::train
