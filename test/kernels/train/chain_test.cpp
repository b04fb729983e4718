// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/render.hpp"
#include "kernels/train/gaussian_backward.hpp"
#include "test/support/random_cloud.hpp"
#include "test/support/reference/splat_reference.hpp"
#include "test/support/simd_limit.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <string>
#include <tuple>

namespace edgesplat::train {
namespace {

geometry::CameraModel camera(int width_px, int height_px) {
  return {geometry::CameraKind::kPinhole,
          width_px,
          height_px,
          0.8 * width_px,
          0.9 * width_px,
          0.5 * width_px - 0.8,
          0.5 * height_px + 0.3,
          {}};
}

/// A linear function of the pictures: any smooth loss is one, as far as its gradient goes.
struct Loss {
  Loss(test::Random& random, std::size_t pixels) {
    for (std::size_t i = 0; i < 3 * pixels; ++i)
      colour.push_back(static_cast<float>(random.uniform(-1.0, 1.0)));
    for (std::size_t i = 0; i < pixels; ++i) {
      depth.push_back(static_cast<float>(random.uniform(-0.3, 0.3)));
      alpha.push_back(static_cast<float>(random.uniform(-1.0, 1.0)));
    }
  }
  [[nodiscard]] double operator()(const test::ReferencePicture& picture) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < alpha.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c)
        sum += static_cast<double>(colour[3 * i + c]) * picture.colour[i][static_cast<Eigen::Index>(c)];
      sum += static_cast<double>(depth[i]) * picture.depth_sum_m[i] +
             static_cast<double>(alpha[i]) * picture.alpha[i];
    }
    return sum;
  }
  std::vector<float> colour, depth, alpha;
};

GaussianGradients gradients_of(const gaussian::GaussianCloud& cloud, const splat::View& view,
                               const splat::RenderOptions& options, const Loss& loss) {
  const auto projected = *splat::project(core::Backend::kCpu, splat::spans_of(cloud), view, options);
  const auto tiles = splat::make_tile_lists(projected.splats, view.width_px, view.height_px);
  std::vector<float> colour(loss.colour.size()), depth(loss.depth.size()), alpha(loss.alpha.size());
  splat::blend(projected.splats, tiles, view, options, {colour, depth, alpha});
  BlendBackwardScratch scratch;
  const auto by = blend_backward(projected.splats, tiles, view, {colour, depth, alpha},
                                 {loss.colour, loss.depth, loss.alpha}, scratch);
  return gaussian_backward(splat::spans_of(cloud), view, options, by.by_row);
}

struct ChainCase {
  std::uint64_t seed;
  std::size_t count;
  int sh_degree;
  double scale_max_m;
  double opaque;  ///< added to every logit: above 4.6 alpha is cut
  bool fisheye = false, antialiased = false;
};

class Chain : public testing::TestWithParam<std::tuple<core::SimdLevel, ChainCase>> {
 protected:
  Chain() : random_(shape_case().seed), loss_(random_, kPixels), camera_(camera(kWidth_px, kHeight_px)) {
    test::CloudShape shape;
    shape.count = shape_case().count;
    shape.sh_degree = shape_case().sh_degree;
    shape.scale_min_m = 0.05;
    shape.scale_max_m = shape_case().scale_max_m;
    shape.half_width_m = 2.0;
    shape.far_m = 6.0;
    cloud_ = test::random_cloud(random_, shape);
    for (float& logit : cloud_.opacity_logits) logit += static_cast<float>(shape_case().opaque);
    for (float& q : cloud_.quats_xyzw) q *= 1.3F;  // gradients must not depend on unit length
    camera_from_map_ = {geometry::so3_exp(random_.vector(0.2)), random_.vector(0.3)};
    options_.antialiased = reference_options_.antialiased = shape_case().antialiased;
    if (shape_case().fisheye) {
      camera_.kind = geometry::CameraKind::kFisheye;
      camera_.fx_px = camera_.fy_px = 0.35 * kWidth_px;
    }
    // What the kernel sees is rounded to single precision.
    view_ = *splat::View::from(camera_, camera_from_map_);
    options_.background = {0.2F, 0.4F, 0.9F};
    reference_options_.background = {0.2F, 0.4F, 0.9F};
    gradients_ = gradients_of(cloud_, view_, options_, loss_);
  }
  [[nodiscard]] static const ChainCase& shape_case() { return std::get<1>(GetParam()); }
  [[nodiscard]] double loss_of(const test::ReferenceCloud& cloud,
                               const geometry::RigidTransform& pose) const {
    return loss_(test::reference_render(cloud, camera_, pose, reference_options_));
  }
  /// Central difference of the whole forward chain in double precision.
  [[nodiscard]] double difference(double& parameter, const test::ReferenceCloud& cloud) const {
    constexpr double kStep = 1e-6;
    const double before = parameter;
    parameter = before + kStep;
    const double above = loss_of(cloud, camera_from_map_);
    parameter = before - kStep;
    const double below = loss_of(cloud, camera_from_map_);
    parameter = before;
    return (above - below) / (2.0 * kStep);
  }
  /// All parameters of one group of all Gaussians: each agrees, and they are not all zero.
  void expect_group(std::vector<double> test::ReferenceCloud::*group, std::size_t offset) {
    test::ReferenceCloud reference(cloud_);
    const std::size_t width = (reference.*group).size() / cloud_.size();
    std::vector<double> expected, computed;
    double largest = 0.0;
    for (std::size_t i = 0; i < gradients_.rows.size(); ++i) {
      for (std::size_t k = 0; k < width; ++k) {
        expected.push_back(difference((reference.*group)[gradients_.rows[i] * width + k], reference));
        computed.push_back(static_cast<double>(gradients_.row(i)[offset + k]));
        largest = std::max(largest, std::abs(expected.back()));
      }
    }
    EXPECT_GT(largest, 0.0);
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(computed[i], expected[i], 1e-3 * std::abs(expected[i]) + 3e-4 * largest) << "number " << i;
  }

  static constexpr int kWidth_px = 37, kHeight_px = 21;
  static constexpr std::size_t kPixels = 37 * 21;
  test::SimdLimit limit_{std::get<0>(GetParam())};
  test::Random random_;
  Loss loss_;
  geometry::CameraModel camera_;
  gaussian::GaussianCloud cloud_;
  geometry::RigidTransform camera_from_map_;
  splat::View view_;
  splat::RenderOptions options_;
  test::ReferenceOptions reference_options_;
  GaussianGradients gradients_;
};

TEST_P(Chain, ShowsMostGaussians) {
  EXPECT_GT(gradients_.rows.size(), shape_case().count / 2);
}
TEST_P(Chain, MeansAgreeWithDifferences) {
  expect_group(&test::ReferenceCloud::means_m, ParameterRow::kMean);
}
TEST_P(Chain, ScalesAgreeWithDifferences) {
  expect_group(&test::ReferenceCloud::log_scales, ParameterRow::kLogScale);
}
TEST_P(Chain, QuaternionsAgreeWithDifferences) {
  expect_group(&test::ReferenceCloud::quats_xyzw, ParameterRow::kQuat);
}
TEST_P(Chain, OpacitiesAgreeWithDifferences) {
  expect_group(&test::ReferenceCloud::opacity_logits, ParameterRow::kOpacity);
}
TEST_P(Chain, ColoursAgreeWithDifferences) {
  expect_group(&test::ReferenceCloud::sh, ParameterRow::kSh);
}

TEST_P(Chain, PoseAgreesWithDifferences) {
  constexpr double kStep = 1e-6;
  const test::ReferenceCloud reference(cloud_);
  std::array<double, 6> expected{};
  double largest = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto at = [&](double step) {
      Eigen::Matrix<double, 6, 1> d = Eigen::Matrix<double, 6, 1>::Zero();
      d[static_cast<Eigen::Index>(k)] = step;
      return loss_of(reference, {camera_from_map_.rotation * geometry::so3_exp(d.head<3>()),
                                 camera_from_map_.translation_m + d.tail<3>()});
    };
    expected[k] = (at(kStep) - at(-kStep)) / (2.0 * kStep);
    largest = std::max(largest, std::abs(expected[k]));
  }
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(gradients_.pose[k], expected[k], 1e-3 * std::abs(expected[k]) + 5e-4 * largest)
        << "axis " << k;
}

INSTANTIATE_TEST_SUITE_P(
    Clouds, Chain,
    testing::Combine(testing::ValuesIn(core::available_simd_levels()),
                     testing::Values(ChainCase{1, 1, 0, 0.6, 0.0}, ChainCase{2, 12, 0, 0.4, 0.0},
                                     ChainCase{3, 12, 1, 1.0, 2.0}, ChainCase{4, 12, 2, 0.4, 0.0},
                                     ChainCase{5, 20, 3, 0.8, 0.0}, ChainCase{6, 60, 0, 1.5, 5.0},
                                     ChainCase{7, 12, 1, 0.4, 0.0, true},
                                     ChainCase{8, 20, 0, 0.8, 0.0, false, true},
                                     ChainCase{9, 20, 1, 0.3, 0.0, true, true})),
    [](const auto& param) {
      return std::string(core::to_string(std::get<0>(param.param))) + "_" +
             std::to_string(std::get<1>(param.param).seed);
    });

TEST(Backward, IsTheSameForEveryNumberOfThreads) {
  test::Random random(7);
  const Loss loss(random, 128 * 96);
  const auto cloud = test::random_cloud(random, {.count = 20000, .sh_degree = 1, .scale_max_m = 0.1});
  const auto view = *splat::View::from(camera(128, 96), {});
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return gradients_of(cloud, view, {}, loss);
  };
  const auto alone = with_threads(1);
  const auto together = with_threads(2);
  EXPECT_GT(alone.rows.size(), 1000U);
  EXPECT_EQ(alone.rows, together.rows);
  EXPECT_EQ(alone.values, together.values);
  EXPECT_EQ(alone.pose, together.pose);
}

TEST(Backward, WeightsAddUpToThePicturesAlpha) {
  test::Random random(8);
  const Loss loss(random, 64 * 48);
  const auto cloud = test::random_cloud(random, {.count = 300});
  const auto view = *splat::View::from(camera(64, 48), {});
  std::vector<float> colour(3 * 64 * 48), depth(64 * 48), alpha(64 * 48);
  ASSERT_TRUE(splat::render(core::Backend::kCpu, splat::spans_of(cloud), view, {}, {colour, depth, alpha}));
  double in_picture = 0.0, in_splats = 0.0;
  for (const float a : alpha) in_picture += static_cast<double>(a);
  for (const Sighting& s : gradients_of(cloud, view, {}, loss).sightings)
    in_splats += static_cast<double>(s.weight);
  EXPECT_NEAR(in_splats, in_picture, 1e-4 * in_picture);
}

TEST(Backward, AnEmptyCloudHasNoGradients) {
  test::Random random(9);
  const Loss loss(random, 20 * 10);
  const auto gradients = gradients_of({}, *splat::View::from(camera(20, 10), {}), {}, loss);
  EXPECT_TRUE(gradients.rows.empty());
  EXPECT_EQ(gradients.pose, (std::array<double, 6>{}));
}

}  // namespace
}  // namespace edgesplat::train
