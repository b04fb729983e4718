// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/gaussian_spans.hpp"
#include "kernels/train/blend_backward.hpp"
#include "kernels/train/parameter_row.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace edgesplat::train {

/// How one picture saw one Gaussian; what densifying and pruning go by.
struct Sighting {
  float centre_gradient_px;  ///< length of dL/d(u, v)
  float weight;              ///< sum of blending weights
  float radius_px;           ///< larger half of its box on the screen
};

/// dL by a camera's pose: dr, dt with camera_from_map ⊞ (dr, dt) = (rotation Exp(dr), translation + dt).
using PoseGradient = std::array<double, 6>;

/// dL by the parameters of some Gaussians that a picture shows (in front of the others in some pixel, at
/// least).
struct GradientBlock {
  std::size_t number;                   ///< of the block
  std::span<const std::uint32_t> rows;  ///< [B] ascending
  std::span<float> values;  ///< [B,stride] laid out as ParameterRow, padding 0; the taker may change them
  std::span<const Sighting> sightings;  ///< [B]
};
/// Called from several threads, each time with other rows; a block's memory is used again afterwards.
using BlockTaker = std::function<void(const GradientBlock&)>;

/// Rows of a block at most.
inline constexpr std::size_t kGradientBlock = 256;
[[nodiscard]] inline std::size_t gradient_blocks(std::size_t splats) {
  return (splats + kGradientBlock - 1) / kGradientBlock;
}

/// Reverse of splat::project with the same view and options: from gradients by the splats (in the order of
/// rows, as blend_backward gives them) to those by the Gaussians, block by block while they are in the cache.
/// Only splats that some pixel shows: those hidden behind others have no gradient, and stay as they are. A
/// taker may move the Gaussians of its block. A Gaussian whose gradient is not finite gets zeros.
/// Deterministic whatever the number of threads.
PoseGradient gaussian_backward_in_blocks(const splat::GaussianSpans& gaussians, const splat::View& view,
                                         const splat::RenderOptions& options,
                                         std::span<const SplatBackward> by_row, const BlockTaker& take);

/// All blocks in one piece.
struct GaussianGradients {
  std::size_t stride = 0;
  std::vector<std::uint32_t> rows;  ///< [V] ascending
  std::vector<float> values;        ///< [V,stride]
  std::vector<Sighting> sightings;  ///< [V]
  PoseGradient pose{};

  [[nodiscard]] std::span<const float> row(std::size_t i) const {
    return std::span(values).subspan(i * stride, stride);
  }
};
[[nodiscard]] GaussianGradients gaussian_backward(const splat::GaussianSpans& gaussians,
                                                  const splat::View& view,
                                                  const splat::RenderOptions& options,
                                                  std::span<const SplatBackward> by_row);

}  // namespace edgesplat::train
