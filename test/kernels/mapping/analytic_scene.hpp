// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/training_view.hpp"
#include "kernels/splat/render.hpp"
#include "test/support/random_cloud.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace edgesplat::mapping {

/// Pictures and depths of a known cloud, drawn from several places.
struct AnalyticScene {
  static constexpr int kWidth_px = 80, kHeight_px = 60;
  struct Shot {
    splat::View view;
    std::vector<float> colour, depth_m, alpha;
    [[nodiscard]] TrainingView training() const { return {view, colour, depth_m, {}, {}}; }
  };

  AnalyticScene(std::uint64_t seed, std::size_t count, int shots_wanted) : random(seed) {
    test::CloudShape shape;
    shape.count = count;
    shape.half_width_m = 2.5;
    shape.near_m = 3.0;
    shape.far_m = 6.0;
    shape.scale_min_m = 0.08;
    shape.scale_max_m = 0.4;
    truth = test::random_cloud(random, shape);
    for (float& logit : truth.opacity_logits) logit = static_cast<float>(random.uniform(0.0, 3.0));
    for (int i = 0; i < shots_wanted; ++i)
      shots.push_back(shoot({geometry::so3_exp(random.vector(0.1)), random.vector(0.4)}));
  }
  [[nodiscard]] Shot shoot(const geometry::RigidTransform& camera_from_map) const {
    const geometry::CameraModel camera{
        geometry::CameraKind::kPinhole, kWidth_px, kHeight_px, 70.0, 70.0, 39.5, 29.5, {}};
    Shot shot{*splat::View::from(camera, camera_from_map), {}, {}, {}};
    constexpr std::size_t kPixels = std::size_t{kWidth_px} * kHeight_px;
    shot.colour.resize(3 * kPixels);
    shot.depth_m.resize(kPixels);
    shot.alpha.resize(kPixels);
    EXPECT_TRUE(splat::render(core::Backend::kCpu, splat::spans_of(truth), shot.view, {},
                              {shot.colour, shot.depth_m, shot.alpha}));
    for (std::size_t i = 0; i < kPixels; ++i)
      shot.depth_m[i] = shot.alpha[i] > 0.5F ? shot.depth_m[i] / shot.alpha[i] : 0.0F;
    return shot;
  }
  /// The truth, every parameter off by up to `amount` of a typical error of seeding.
  [[nodiscard]] gaussian::GaussianCloud perturbed(double amount) {
    gaussian::GaussianCloud cloud = truth;
    const auto shake = [this, amount](std::vector<float>& values, double by) {
      for (float& value : values) value += static_cast<float>(amount * random.uniform(-by, by));
    };
    shake(cloud.means_m, 0.05);
    shake(cloud.log_scales, 0.3);
    shake(cloud.quats_xyzw, 0.2);
    shake(cloud.opacity_logits, 1.0);
    shake(cloud.sh, 0.5);
    return cloud;
  }

  test::Random random;
  gaussian::GaussianCloud truth;
  std::vector<Shot> shots;
};

}  // namespace edgesplat::mapping
