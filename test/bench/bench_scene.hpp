// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/render.hpp"
#include "test/support/splat_scene.hpp"

#include <cstddef>
#include <vector>

namespace edgesplat::bench {

/// test::splat_scene with what its time is to be judged by.
struct BenchScene {
  explicit BenchScene(const test::SplatSceneShape& shape);
  BenchScene(gaussian::GaussianCloud cloud, const geometry::CameraModel& camera);

  [[nodiscard]] std::size_t pixels() const { return alpha.size(); }

  gaussian::GaussianCloud cloud;
  splat::View view;
  std::size_t visible = 0;
  std::size_t tile_pairs = 0;
  double evaluations = 0.0;      ///< pixels of the 4x4 blocks that a splat reaches, summed over the splats
  double median_sigma_px = 0.0;  ///< of what is visible
  std::vector<float> colour, depth_sum_m, alpha;  ///< as drawn

 private:
  void measure();
};

}  // namespace edgesplat::bench
