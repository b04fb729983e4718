// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The same for every backend. Without a GPU, CUDA's part skips; test_kernels_train_on_cpu runs its kernels
// there.
#include "test/kernels/train/backend_steps.hpp"
#include "test/support/random_cloud.hpp"
#include "test/support/reference/splat_reference.hpp"
#include "test/support/reference/ssim_reference.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::train {
namespace {

constexpr int kWidth_px = 37, kHeight_px = 21;

geometry::CameraModel camera(int width_px = kWidth_px, int height_px = kHeight_px) {
  return {geometry::CameraKind::kPinhole,
          width_px,
          height_px,
          0.8 * width_px,
          0.9 * width_px,
          0.5 * width_px - 0.8,
          0.5 * height_px + 0.3,
          {}};
}

std::vector<float> noise(test::Random& random, std::size_t count, double low, double high) {
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(random.uniform(low, high));
  return values;
}

class TrainOn : public testing::TestWithParam<Way> {
 protected:
  void SetUp() override {
    const auto chosen = core::choose_backend(core::to_string(GetParam().backend));
    if (!chosen) GTEST_SKIP() << chosen.error().context;
  }
};

/// A linear function of the pictures: any smooth loss is one, as far as its gradient goes.
struct Linear {
  Linear(test::Random& random, std::size_t pixels)
      : colour(noise(random, 3 * pixels, -1.0, 1.0)),
        depth(noise(random, pixels, -0.3, 0.3)),
        alpha(noise(random, pixels, -1.0, 1.0)) {}
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
  [[nodiscard]] PictureGradients gradients() const { return {colour, depth, alpha}; }
  std::vector<float> colour, depth, alpha;
};

struct Chain {
  Chain(std::uint64_t seed, std::size_t count, int sh_degree, double scale_max_m, float opaque)
      : random(seed), loss(random, std::size_t{kWidth_px} * kHeight_px) {
    cloud = test::random_cloud(random, {.count = count,
                                        .sh_degree = sh_degree,
                                        .half_width_m = 2.0,
                                        .far_m = 6.0,
                                        .scale_min_m = 0.05,
                                        .scale_max_m = scale_max_m});
    for (float& logit : cloud.opacity_logits) logit += opaque;
    for (float& q : cloud.quats_xyzw) q *= 1.3F;  // gradients must not depend on unit length
    camera_from_map = {geometry::so3_exp(random.vector(0.2)), random.vector(0.3)};
  }
  [[nodiscard]] double at(const test::ReferenceCloud& changed, const geometry::RigidTransform& pose) const {
    test::ReferenceOptions options;
    options.background = {0.2F, 0.4F, 0.9F};
    return loss(test::reference_render(changed, camera(), pose, options));
  }
  test::Random random;
  Linear loss;
  gaussian::GaussianCloud cloud;
  geometry::RigidTransform camera_from_map;
};

/// Central differences of the whole forward chain in double precision, for a group of parameters.
void expect_group(const Chain& chain, const GaussianGradients& gradients,
                  std::vector<double> test::ReferenceCloud::*group, std::size_t offset) {
  constexpr double kStep = 1e-6;
  test::ReferenceCloud reference(chain.cloud);
  const std::size_t width = (reference.*group).size() / chain.cloud.size();
  std::vector<double> expected;
  double largest = 0.0;
  for (const std::uint32_t row : gradients.rows) {
    for (std::size_t k = 0; k < width; ++k) {
      double& parameter = (reference.*group)[row * width + k];
      const double before = parameter;
      parameter = before + kStep;
      const double above = chain.at(reference, chain.camera_from_map);
      parameter = before - kStep;
      expected.push_back((above - chain.at(reference, chain.camera_from_map)) / (2.0 * kStep));
      parameter = before;
      largest = std::max(largest, std::abs(expected.back()));
    }
  }
  EXPECT_GT(largest, 0.0);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto computed = static_cast<double>(gradients.row(i / width)[offset + i % width]);
    EXPECT_NEAR(computed, expected[i], 1e-3 * std::abs(expected[i]) + 3e-4 * largest) << "number " << i;
  }
}

void expect_pose(const Chain& chain, const GaussianGradients& gradients) {
  constexpr double kStep = 1e-6;
  const test::ReferenceCloud reference(chain.cloud);
  std::array<double, 6> expected{};
  double largest = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    const auto moved = [&](double step) {
      Eigen::Matrix<double, 6, 1> d = Eigen::Matrix<double, 6, 1>::Zero();
      d[static_cast<Eigen::Index>(k)] = step;
      return chain.at(reference, {chain.camera_from_map.rotation * geometry::so3_exp(d.head<3>()),
                                  chain.camera_from_map.translation_m + d.tail<3>()});
    };
    expected[k] = (moved(kStep) - moved(-kStep)) / (2.0 * kStep);
    largest = std::max(largest, std::abs(expected[k]));
  }
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(gradients.pose[k], expected[k], 1e-3 * std::abs(expected[k]) + 5e-4 * largest)
        << "axis " << k;
}

TEST_P(TrainOn, EveryGradientAgreesWithDifferences) {
  for (const Chain& chain :
       {Chain(1, 1, 0, 0.6, 0.0F), Chain(2, 12, 0, 0.4, 0.0F), Chain(3, 12, 1, 1.0, 2.0F),
        Chain(4, 12, 2, 0.4, 0.0F), Chain(5, 20, 3, 0.8, 0.0F), Chain(6, 60, 0, 1.5, 5.0F)}) {
    SCOPED_TRACE(chain.cloud.size());
    splat::RenderOptions options;
    options.background = {0.2F, 0.4F, 0.9F};
    const auto gradients =
        gradients_on(GetParam(), chain.cloud, *splat::View::from(camera(), chain.camera_from_map), options,
                     chain.loss.gradients());
    ASSERT_TRUE(gradients) << gradients.error().context;
    EXPECT_GT(gradients->rows.size(), chain.cloud.size() / 2);
    expect_group(chain, *gradients, &test::ReferenceCloud::means_m, ParameterRow::kMean);
    expect_group(chain, *gradients, &test::ReferenceCloud::log_scales, ParameterRow::kLogScale);
    expect_group(chain, *gradients, &test::ReferenceCloud::quats_xyzw, ParameterRow::kQuat);
    expect_group(chain, *gradients, &test::ReferenceCloud::opacity_logits, ParameterRow::kOpacity);
    expect_group(chain, *gradients, &test::ReferenceCloud::sh, ParameterRow::kSh);
    expect_pose(chain, *gradients);
  }
}

TEST_P(TrainOn, ALargerSceneAgreesWithTheCpu) {
  test::Random random(8);
  const Linear loss(random, 100 * 70);
  const auto cloud = test::random_cloud(random, {.count = 3000, .sh_degree = 1, .scale_max_m = 0.5});
  const auto view = *splat::View::from(camera(100, 70), {});
  const auto expected = gradients_on({core::Backend::kCpu}, cloud, view, {}, loss.gradients());
  const auto computed = gradients_on(GetParam(), cloud, view, {}, loss.gradients());
  ASSERT_TRUE(computed) << computed.error().context;
  ASSERT_EQ(computed->rows.size(), expected->rows.size());
  EXPECT_EQ(computed->rows, expected->rows);
  double apart = 0.0, size = 0.0;
  for (std::size_t i = 0; i < expected->values.size(); ++i) {
    apart += std::abs(static_cast<double>(computed->values[i] - expected->values[i]));
    size += std::abs(static_cast<double>(expected->values[i]));
  }
  EXPECT_LT(apart, 1e-3 * size);
  for (std::size_t i = 0; i < expected->sightings.size(); ++i) {
    const Sighting &a = computed->sightings[i], &b = expected->sightings[i];
    EXPECT_NEAR(a.weight, b.weight, 1e-3F * b.weight + 0.02F);
    EXPECT_NEAR(a.radius_px, b.radius_px, 1e-3F * b.radius_px);
  }
}

TEST_P(TrainOn, DepthAndAlphaMayHaveNoGradients) {
  test::Random random(9);
  Linear loss(random, std::size_t{kWidth_px} * kHeight_px);
  const auto cloud = test::random_cloud(random, {.count = 50});
  const auto view = *splat::View::from(camera(), {});
  const auto without = gradients_on(GetParam(), cloud, view, {}, {loss.colour, {}, {}});
  for (float& value : loss.depth) value = 0.0F;
  for (float& value : loss.alpha) value = 0.0F;
  const auto zero = gradients_on(GetParam(), cloud, view, {}, loss.gradients());
  ASSERT_TRUE(without && zero);
  ASSERT_EQ(without->values.size(), zero->values.size());
  double apart = 0.0;
  for (std::size_t i = 0; i < zero->values.size(); ++i)
    apart = std::max(apart, std::abs(static_cast<double>(without->values[i] - zero->values[i])));
  EXPECT_LT(apart, 1e-3);
}

TEST_P(TrainOn, AnEmptyCloudHasNoGradients) {
  test::Random random(10);
  const Linear loss(random, std::size_t{kWidth_px} * kHeight_px);
  const auto gradients = gradients_on(GetParam(), {}, *splat::View::from(camera(), {}), {}, loss.gradients());
  ASSERT_TRUE(gradients) << gradients.error().context;
  EXPECT_TRUE(gradients->rows.empty());
  EXPECT_EQ(gradients->pose, (std::array<double, 6>{}));
}

Task task(std::uint64_t seed, std::size_t pixels) {
  test::Random random(seed);
  Task out;
  out.colour = noise(random, 3 * pixels, 0.0, 1.0);
  out.depth_m = noise(random, pixels, 1.0, 8.0);
  for (std::size_t i = 0; i < pixels; i += 5) out.depth_m[i] = 0.0F;
  out.weight = noise(random, pixels, 0.0, 1.0);
  for (std::size_t i = 0; i < pixels; i += 7) out.weight[i] = 0.0F;
  return out;
}

void expect_near_steps(const std::vector<StepResult>& computed, const std::vector<StepResult>& expected) {
  ASSERT_EQ(computed.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const StepResult &a = computed[i], &b = expected[i];
    EXPECT_NEAR(a.loss, b.loss, 2e-4 * b.loss);
    EXPECT_NEAR(a.l1, b.l1, 2e-4 * b.l1);
    EXPECT_NEAR(a.ssim, b.ssim, 2e-4);
    EXPECT_NEAR(a.depth_m, b.depth_m, 1e-3 * b.depth_m);
    EXPECT_EQ(a.visible, b.visible);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(a.by_exposure[k], b.by_exposure[k], 1e-3 * std::abs(b.by_exposure[k]) + 1e-4);
      EXPECT_NEAR(a.by_pose[k], b.by_pose[k], 1e-2 * std::abs(b.by_pose[k]) + 1e-3);
    }
  }
}

/// Where a first gradient is close to 0, Adam makes a whole step of its sign: so most agree, and all within
/// some steps.
void expect_near_values(const std::vector<float>& computed, const std::vector<float>& expected, float rate) {
  ASSERT_EQ(computed.size(), expected.size());
  std::size_t off = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(computed[i], expected[i], 7.0F * rate) << i;
    if (std::abs(computed[i] - expected[i]) > 0.05F * rate) ++off;
  }
  EXPECT_LT(static_cast<double>(off), 0.02 * static_cast<double>(expected.size()));
}

TEST_P(TrainOn, StepsAgreeWithTheCpu) {
  const auto view = *splat::View::from(camera(61, 43), {});
  for (int variant = 0; variant < 4; ++variant) {
    SCOPED_TRACE(variant);
    Task t = task(20, 61 * 43);
    t.render.background = {0.1F, 0.2F, 0.3F};
    if (variant == 1) t.weight.clear(), t.depth_m.clear(), t.ssim_share = 0.0F;
    if (variant == 2) t.gap_factor = 0.3F, t.exposure = {1.2F, 0.8F, 1.1F, 0.05F, -0.1F, 0.0F};
    if (variant == 3) t.opacity_factor = 0.5F, t.scale_factor = 2.0F, t.weight.clear();
    test::Random random(21);
    auto expected = test::random_cloud(
        random, {.count = 400, .sh_degree = variant % 3 + (variant == 3 ? 3 : 0), .scale_max_m = 0.4});
    auto computed = expected;
    const auto expected_steps = steps_on({core::Backend::kCpu}, view, t, 3, expected);
    const auto steps = steps_on(GetParam(), view, t, 3, computed);
    ASSERT_TRUE(steps) << steps.error().context;
    expect_near_steps(*steps, *expected_steps);
    expect_near_values(computed.means_m, expected.means_m, t.rates.mean_m);
    expect_near_values(computed.log_scales, expected.log_scales, t.rates.log_scale);
    expect_near_values(computed.quats_xyzw, expected.quats_xyzw, t.rates.quat);
    expect_near_values(computed.opacity_logits, expected.opacity_logits, t.rates.opacity_logit);
    expect_near_values(computed.sh, expected.sh, t.rates.sh_base);
  }
}

TEST_P(TrainOn, SsimIsThatOfTheReference) {
  const auto view = *splat::View::from(camera(61, 43), {});
  const Task t = task(22, 61 * 43);
  test::Random random(23);
  auto cloud = test::random_cloud(random, {.count = 300, .scale_max_m = 0.4});
  const auto drawn = test::reference_render(cloud, camera(61, 43), {}, {});
  std::vector<double> x;
  for (const auto& rgb : drawn.colour) x.insert(x.end(), rgb.data(), rgb.data() + 3);
  const double expected =
      test::reference_ssim(61, 43, x, {t.colour.begin(), t.colour.end()}, {t.weight.begin(), t.weight.end()});
  const auto steps = steps_on(GetParam(), view, t, 1, cloud);
  ASSERT_TRUE(steps) << steps.error().context;
  EXPECT_NEAR(steps->front().ssim, expected, 1e-4);
}

TEST_P(TrainOn, APictureOfOnePixelAndWeightsOfZeroAreFine) {
  test::Random random(24);
  auto cloud = test::random_cloud(random, {.count = 20, .scale_max_m = 1.0});
  Task t = task(25, 1);
  t.weight = {0.0F};
  const auto before = cloud;
  const auto steps = steps_on(GetParam(), *splat::View::from(camera(1, 1), {}), t, 2, cloud);
  ASSERT_TRUE(steps) << steps.error().context;
  EXPECT_EQ(steps->back().loss, 0.0);
  EXPECT_EQ(cloud.means_m, before.means_m);
}

INSTANTIATE_TEST_SUITE_P(Ways, TrainOn,
                         testing::Values(Way{core::Backend::kCpu}, Way{core::Backend::kCuda},
                                         Way{core::Backend::kCuda, false}),
                         [](const auto& way) { return way.param.name(); });

}  // namespace
}  // namespace edgesplat::train
