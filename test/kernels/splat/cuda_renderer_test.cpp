// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/cuda_renderer.hpp"

#include "test/support/random_cloud.hpp"

#include <gtest/gtest.h>

#include <optional>

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
