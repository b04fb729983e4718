// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/cuda_renderer.hpp"

#include "test/support/random_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace edgesplat::splat {
namespace {

class CudaRendering : public testing::Test {
 protected:
  void SetUp() override {
    const auto gpu = core::choose_backend("cuda");
    if (!gpu) GTEST_SKIP() << gpu.error().context;
    stream_.emplace(*core::Stream::create());
  }
  static gaussian::GaussianCloud cloud(std::size_t count) {
    test::Random random(count);
    return test::random_cloud(random, {.count = count});
  }
  std::optional<core::Stream> stream_;
  View view_ = *View::from({geometry::CameraKind::kPinhole, 64, 48, 50.0, 50.0, 31.5, 23.5, {}}, {});
};

TEST_F(CudaRendering, AFullMemoryIsAnErrorValue) {
  core::VramPool pool(1'000'000);
  CudaRenderer renderer(pool);
  const auto small = cloud(50), large = cloud(20'000);
  ASSERT_TRUE(renderer.set_cloud(*stream_, spans_of(small)));
  ASSERT_TRUE(renderer.draw_on_device(*stream_, view_, {}));
  const Status refused = renderer.set_cloud(*stream_, spans_of(large));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kOutOfVram);
  const auto empty = renderer.draw_on_device(*stream_, view_, {});
  ASSERT_TRUE(empty) << "there is no cloud then";
  EXPECT_EQ(empty->visible, 0U);
  ASSERT_TRUE(renderer.set_cloud(*stream_, spans_of(small)));
  EXPECT_GT(renderer.draw_on_device(*stream_, view_, {})->visible, 0U);
  EXPECT_LE(pool.peak_bytes(), pool.budget_bytes());
}

TEST_F(CudaRendering, HalfPrecisionTakesLessAndDrawsNearlyTheSame) {
  test::Random random(9);
  auto gaussians = test::random_cloud(random, {.count = 2000, .sh_degree = 3, .scale_max_m = 0.4});
  gaussians.sh[7] = std::numeric_limits<float>::quiet_NaN();
  const auto drawn = [&](bool half_precision, std::size_t& used_bytes) {
    core::VramPool pool(std::size_t{1} << 26U);
    CudaRenderer renderer(pool, half_precision);
    std::vector<float> colour(std::size_t{3} * 64 * 48), depth(std::size_t{64} * 48),
        alpha(std::size_t{64} * 48);
    EXPECT_TRUE(renderer.set_cloud(*stream_, spans_of(gaussians)));
    used_bytes = pool.used_bytes();
    const auto stats = renderer.draw(*stream_, view_, {}, {colour, depth, alpha});
    EXPECT_TRUE(stats);
    EXPECT_EQ(stats->not_finite, 1U);
    return colour;
  };
  std::size_t whole_bytes = 0, half_bytes = 0;
  const auto whole = drawn(false, whole_bytes), half = drawn(true, half_bytes);
  EXPECT_NEAR(static_cast<double>(whole_bytes), 236.0 * 2000, 1000.0);
  EXPECT_NEAR(static_cast<double>(half_bytes), 124.0 * 2000, 1000.0);
  double squares = 0.0;
  for (std::size_t i = 0; i < whole.size(); ++i)
    squares += std::pow(static_cast<double>(whole[i] - half[i]), 2.0);
  EXPECT_LT(squares / static_cast<double>(whole.size()), std::pow(10.0, -4.5)) << "45 dB";
  EXPECT_GT(squares, 0.0);
}

TEST_F(CudaRendering, ASteadyViewTakesNoMoreMemory) {
  core::VramPool pool(std::size_t{1} << 26U);
  CudaRenderer renderer(pool);
  const auto gaussians = cloud(3000);
  ASSERT_TRUE(renderer.set_cloud(*stream_, spans_of(gaussians)));
  ASSERT_TRUE(renderer.draw_on_device(*stream_, view_, {}));
  ASSERT_TRUE(renderer.draw_on_device(*stream_, view_, {}));
  const std::size_t used_bytes = pool.used_bytes();
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(renderer.draw_on_device(*stream_, view_, {}));
  EXPECT_EQ(pool.used_bytes(), used_bytes);
}

}  // namespace
}  // namespace edgesplat::splat
