// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Warps and lanes may run in any order: here they do, and what is said to be in order must not change.
#include "kernels/splat/render.hpp"
#include "test/kernels/train/backend_steps.hpp"
#include "test/support/cuda_on_cpu/block_runner.hpp"
#include "test/support/random_cloud.hpp"

#include <gtest/gtest.h>

namespace edgesplat::train {
namespace {

constexpr std::size_t kPixels = std::size_t{48} * 40;

splat::View view() {
  return *splat::View::from({geometry::CameraKind::kPinhole, 48, 40, 40.0, 40.0, 23.5, 19.5, {}}, {});
}

gaussian::GaussianCloud cloud() {
  test::Random random(5);
  return test::random_cloud(random, {.count = 500, .sh_degree = 1, .scale_max_m = 0.4});
}

TEST(Order, PicturesAreTheSame) {
  const auto drawn = [](std::uint64_t seed) {
    test::set_order_seed(seed);
    std::vector<float> colour(3 * kPixels), depth(kPixels), alpha(kPixels);
    EXPECT_TRUE(
        splat::render(core::Backend::kCuda, splat::spans_of(cloud()), view(), {}, {colour, depth, alpha}));
    return colour;
  };
  const auto first = drawn(1);
  for (const std::uint64_t seed : {2U, 3U, 4U}) EXPECT_EQ(drawn(seed), first);
}

TEST(Order, StepsInOrderAreTheSameToTheLastBit) {
  const auto stepped = [](std::uint64_t seed) {
    test::set_order_seed(seed);
    test::Random random(6);
    Task task;
    task.colour.resize(3 * kPixels);
    for (float& value : task.colour) value = static_cast<float>(random.uniform());
    task.depth_m.assign(kPixels, 4.0F);
    task.gap_factor = 0.1F;
    auto moved = cloud();
    const auto steps = steps_on({core::Backend::kCuda, true}, view(), task, 2, moved);
    EXPECT_TRUE(steps);
    return std::pair{moved.means_m, steps->back().by_pose};
  };
  const auto first = stepped(1);
  for (const std::uint64_t seed : {2U, 3U}) EXPECT_EQ(stepped(seed), first);
}

}  // namespace
}  // namespace edgesplat::train
