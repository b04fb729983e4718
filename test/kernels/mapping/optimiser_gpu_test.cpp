// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The optimiser on the GPU does what it does on the CPU. Without a GPU these skip;
// test_kernels_mapping_on_cpu runs the CUDA kernels on the CPU.
#include "kernels/mapping/densify.hpp"
#include "kernels/mapping/optimiser.hpp"
#include "kernels/splat/render.hpp"
#include "test/kernels/mapping/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::mapping {
namespace {

class OptimiserOnGpu : public testing::Test {
 protected:
  void SetUp() override {
    const auto gpu = core::choose_backend("cuda");
    if (!gpu) GTEST_SKIP() << gpu.error().context;
    ASSERT_TRUE(on_gpu_.on_gpu());
    ASSERT_FALSE(on_cpu_.on_gpu());
  }
  [[nodiscard]] Optimiser make(bool on_gpu) const {
    OptimiserOptions options;
    options.rates = {
        .mean_m = 3e-3F, .log_scale = 1e-2F, .quat = 5e-3F, .opacity_logit = 5e-2F, .sh_base = 1e-2F};
    options.on_gpu = on_gpu;
    options.gap_factor = 0.1F;
    options.opacity_factor = 0.01F;
    return std::move(*Optimiser::create(options, clock_));
  }
  template <typename Change>
  void both(const Change& change) {
    change(on_gpu_);
    change(on_cpu_);
  }
  void step(int steps) {
    for (int i = 0; i < steps; ++i, ++steps_) {
      TrainingView view = scene_.shots[static_cast<std::size_t>(steps_) % scene_.shots.size()].training();
      view.exposure_key = static_cast<std::uint32_t>(steps_) % 2;
      const auto gpu = on_gpu_.step(view), cpu = on_cpu_.step(view);
      ASSERT_TRUE(gpu && cpu);
      EXPECT_NEAR(gpu->loss, cpu->loss, 5e-3 * cpu->loss);
      EXPECT_NEAR(gpu->depth_m, cpu->depth_m, 2e-2 * cpu->depth_m + 1e-3);
      EXPECT_NEAR(static_cast<double>(gpu->visible), static_cast<double>(cpu->visible), 2.0);
    }
  }
  /// Where a first gradient is close to 0, Adam makes a whole step of its sign: most values agree, all
  /// nearly.
  void expect_alike() const {
    const gaussian::GaussianCloud &gpu = on_gpu_.cloud(), &cpu = on_cpu_.cloud();
    ASSERT_EQ(gpu.ids, cpu.ids);
    ASSERT_TRUE(gpu.consistent());
    std::size_t off = 0;
    for (std::size_t i = 0; i < cpu.means_m.size(); ++i)
      off += std::abs(gpu.means_m[i] - cpu.means_m[i]) > 1e-3F ? 1U : 0U;
    EXPECT_LT(off, cpu.means_m.size() / 10);
    off = 0;
    for (std::size_t i = 0; i < cpu.sh.size(); ++i) off += std::abs(gpu.sh[i] - cpu.sh[i]) > 5e-3F ? 1U : 0U;
    EXPECT_LT(off, cpu.sh.size() / 10);
    for (const std::uint32_t key : {0U, 1U})
      EXPECT_NEAR(on_gpu_exposure(key).gain[0], on_cpu_exposure(key).gain[0], 2e-3);
  }
  [[nodiscard]] Exposure on_gpu_exposure(std::uint32_t key) const { return exposure(on_gpu_, key); }
  [[nodiscard]] Exposure on_cpu_exposure(std::uint32_t key) const { return exposure(on_cpu_, key); }
  static Exposure exposure(const Optimiser& optimiser, std::uint32_t key) {
    return const_cast<Optimiser&>(optimiser).exposures().of(key);
  }

  SteadyClock clock_;
  AnalyticScene scene_{6, 120, 4};
  Optimiser on_gpu_ = make(true), on_cpu_ = make(false);
  int steps_ = 0;
};

TEST_F(OptimiserOnGpu, StepsAsOnTheCpu) {
  const auto start = scene_.perturbed(1.0);
  both([&](Optimiser& optimiser) { ASSERT_EQ(optimiser.add_rows(start).value_or(0), start.size()); });
  const ChangeMark gpu_mark = on_gpu_.mark();
  step(6);
  expect_alike();
  EXPECT_GT(on_gpu_.changed_since(gpu_mark).size(), start.size() / 2);
  for (std::size_t row = 0; row < start.size(); ++row) {
    const RowStatistics &gpu = on_gpu_.statistics()[row], &cpu = on_cpu_.statistics()[row];
    EXPECT_NEAR(gpu.weight_sum, cpu.weight_sum, 0.02F * cpu.weight_sum + 0.5F) << row;
    EXPECT_NEAR(gpu.radius_max_px, cpu.radius_max_px, 0.02F * cpu.radius_max_px + 0.5F) << row;
  }
}

TEST_F(OptimiserOnGpu, RowsComeGoAndAreEdited) {
  const auto start = scene_.perturbed(1.0);
  both([&](Optimiser& optimiser) { ASSERT_TRUE(optimiser.add_rows(start)); });
  step(3);
  const std::vector<std::uint32_t> gone{3, 50, 51, 119}, edited{0, 7}, fresh{10};
  both([&](Optimiser& optimiser) {
    ASSERT_TRUE(optimiser.remove_rows(gone));
    auto& cloud = optimiser.edit_rows(edited);
    cloud.means_m[0] += 0.05F;
    cloud.means_m[21] -= 0.05F;
    optimiser.forget_moments(fresh);
    ASSERT_TRUE(optimiser.add_rows(start));
  });
  EXPECT_EQ(on_gpu_.cloud().size(), 2 * start.size() - gone.size());
  step(3);
  expect_alike();
}

TEST_F(OptimiserOnGpu, DensifyingGoesOnFromThere) {
  const auto start = scene_.perturbed(1.0);
  both([&](Optimiser& optimiser) { ASSERT_TRUE(optimiser.add_rows(start)); });
  step(4);
  DensifyOptions options;
  options.gradient = 1e-5F;
  IdAllocator ids(2);
  const DensifyReport report = densify(on_gpu_, options, ids);
  EXPECT_GT(report.cloned + report.split, 0U);
  const std::size_t rows = on_gpu_.cloud().size();
  const auto before = on_gpu_.step(scene_.shots[0].training());
  for (int i = 0; i < 8; ++i) ASSERT_TRUE(on_gpu_.step(scene_.shots[0].training()));
  const auto after = on_gpu_.step(scene_.shots[0].training());
  ASSERT_TRUE(before && after);
  EXPECT_LT(after->loss, before->loss);
  EXPECT_EQ(on_gpu_.cloud().size(), rows);
  EXPECT_TRUE(on_gpu_.gpu_failure().empty());
}

TEST_F(OptimiserOnGpu, RefusesWhatTheCpuRefuses) {
  ASSERT_TRUE(on_gpu_.add_rows(scene_.truth));
  TrainingView view = scene_.shots[0].training();
  view.colour = view.colour.first(30);
  const auto report = on_gpu_.step(view);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, Errc::kInvalidArgument);
  EXPECT_TRUE(on_gpu_.on_gpu()) << "and stays where it is";
}

}  // namespace
}  // namespace edgesplat::mapping
