// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "kernels/train/parameter_row.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::train {

/// Step lengths of Adam, one a group of parameters: about what a parameter moves by in one step at first.
struct LearningRates {
  float mean_m = 2e-4F;
  float log_scale = 5e-3F;
  float quat = 1e-3F;
  float opacity_logit = 2.5e-2F;
  float sh_base = 2.5e-3F;  ///< degree 0
  float sh_rest = 1.25e-4F;
};

struct AdamOptions {
  float beta1 = 0.9F;
  float beta2 = 0.999F;
  float epsilon = 1e-15F;
  /// A mean's rate falls exponentially with the steps of its Gaussian, to this share of it, so that surfaces
  /// come to rest while new Gaussians still find their place.
  float mean_final_share = 0.05F;   ///< 0..1
  float mean_decay_steps = 600.0F;  ///< after which 1/e of what falls is left, 1..1e6
};

/// Adam (Kingma 2015) over the Gaussians that a picture shows, the others being left untouched. Every
/// Gaussian counts its own steps for the bias correction: one that appears after a thousand steps of the map
/// starts as a map of its own would, and one that is seen seldom is not treated as if its moments had decayed
/// meanwhile. Two moments of 4 bytes for each parameter, in rows (parameter_row.hpp). Single-owner.
class Adam {
 public:
  Adam(int sh_degree, const AdamOptions& options);

  [[nodiscard]] std::size_t size() const { return steps_.size(); }
  /// New rows start at zero moments.
  void resize(std::size_t rows);
  /// Keeps the given rows, ascending, in that order.
  void keep_rows(std::span<const std::uint32_t> rows);
  /// Rows get parameters of a higher SH degree, with zero moments; the others keep theirs.
  void raise_sh_degree(int sh_degree);
  /// Forgets what is known of one row.
  void reset_row(std::size_t row);
  /// Moves the parameters of `rows` one step down and sets quaternions to unit length. `values` [rows,stride]
  /// are the gradients, laid out as ParameterRow; `cloud` has as many rows as this. A row whose result is not
  /// finite stays as it was. Several threads may call it at once, each with rows of its own.
  void step(std::span<const std::uint32_t> rows, std::span<const float> values, const LearningRates& rates,
            gaussian::GaussianCloud& cloud);
  [[nodiscard]] std::uint32_t steps_of(std::size_t row) const { return steps_[row]; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  int sh_degree_;
  AdamOptions options_;
  std::size_t stride_;
  std::vector<float> first_;   ///< [N,stride] mean of the gradient
  std::vector<float> second_;  ///< [N,stride] mean of its square
  std::vector<std::uint16_t> steps_;
  /// By steps: 1 / (1 - beta1^t), 1 / sqrt(1 - beta2^t), share of the mean's rate.
  std::vector<std::array<float, 3>> by_steps_;
};

}  // namespace edgesplat::train
