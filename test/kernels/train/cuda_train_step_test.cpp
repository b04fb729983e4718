// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/cuda_train_step.hpp"

#include "kernels/core/backend.hpp"
#include "test/support/random_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace edgesplat::train {
namespace {

constexpr int kWidth_px = 50, kHeight_px = 40;

class CudaTrain : public testing::Test {
 protected:
  void SetUp() override {
    const auto gpu = core::choose_backend("cuda");
    if (!gpu) GTEST_SKIP() << gpu.error().context;
    stream_.emplace(*core::Stream::create());
    test::Random random(3);
    cloud_ = test::random_cloud(random, {.count = 100, .scale_max_m = 0.5});
    for (float& value : colour_) value = static_cast<float>(random.uniform());
  }
  [[nodiscard]] Status step(CudaTrainStep& trainer, const TrainSettings& settings = {}) const {
    const geometry::CameraModel camera{
        geometry::CameraKind::kPinhole, kWidth_px, kHeight_px, 45.0, 45.0, 24.5, 19.5, {}};
    EDGESPLAT_TRY(const auto report,
                  trainer.step(*stream_, *splat::View::from(camera, {}), {colour_, {}, {}, {}}, settings));
    EXPECT_GT(report.visible, 20U);
    return {};
  }
  [[nodiscard]] gaussian::GaussianCloud fetched(const CudaTrainStep& trainer,
                                                const gaussian::GaussianCloud& like) const {
    gaussian::GaussianCloud out = like;
    EXPECT_TRUE(trainer.fetch_cloud(*stream_, out));
    return out;
  }
  std::optional<core::Stream> stream_;
  core::VramPool pool_{std::size_t{1} << 28U};
  gaussian::GaussianCloud cloud_;
  std::vector<float> colour_ = std::vector<float>(std::size_t{3} * kWidth_px * kHeight_px);
};

TEST_F(CudaTrain, DenseStepsMoveWhatThePictureDoesNotShowByItsMoments) {
  CudaTrainStep trainer(pool_, {.mean_final_share = 1.0F});
  ASSERT_TRUE(trainer.set_cloud(*stream_, splat::spans_of(cloud_)));
  ASSERT_TRUE(step(trainer));
  GaussianGradients gradients;
  ASSERT_TRUE(trainer.fetch_gradients(*stream_, gradients));
  const std::size_t row = gradients.rows.front();
  const auto g = static_cast<double>(gradients.row(0)[ParameterRow::kOpacity]);
  // Out of sight: its gradient is 0 from here on, and its moments die away.
  auto moved = fetched(trainer, cloud_);
  moved.means_m[3 * row + 2] = -5.0F;
  std::vector<std::uint32_t> same(moved.size());
  for (std::uint32_t i = 0; i < same.size(); ++i) same[i] = i;
  ASSERT_TRUE(trainer.replace_cloud(*stream_, splat::spans_of(moved), same));
  TrainSettings settings;
  ASSERT_TRUE(step(trainer, settings));
  EXPECT_EQ(fetched(trainer, moved).opacity_logits[row], moved.opacity_logits[row]) << "sparse: untouched";
  settings.dense = true;
  ASSERT_TRUE(step(trainer, settings));
  const double first = 0.9 * 0.1 * g / (1.0 - 0.81), second = 0.999 * 0.001 * g * g / (1.0 - 0.999 * 0.999);
  const double expected = static_cast<double>(settings.rates.opacity_logit) * first / std::sqrt(second);
  EXPECT_NEAR(moved.opacity_logits[row] - fetched(trainer, moved).opacity_logits[row], expected,
              1e-3 * std::abs(expected));
}

TEST_F(CudaTrain, MomentsFollowTheirRows) {
  const auto after_two = [&](bool replaced, bool fresh) {
    CudaTrainStep trainer(pool_, {});
    EXPECT_TRUE(trainer.set_cloud(*stream_, splat::spans_of(cloud_)));
    EXPECT_TRUE(step(trainer));
    auto now = fetched(trainer, cloud_);
    if (replaced) {
      // The first row goes and comes again at the end; the picture stays the same.
      std::vector<std::uint32_t> from;
      gaussian::GaussianCloud turned = now;
      turned.resize(0);
      for (std::uint32_t i = 1; i < now.size(); ++i) {
        from.push_back(fresh ? CudaTrainStep::kFreshRow : i);
        turned.append_row(now, i);
      }
      from.push_back(CudaTrainStep::kFreshRow);
      turned.append_row(now, 0);
      EXPECT_TRUE(trainer.replace_cloud(*stream_, splat::spans_of(turned), from));
      now = turned;
    }
    EXPECT_TRUE(step(trainer));
    return fetched(trainer, now);
  };
  const auto straight = after_two(false, false), turned = after_two(true, false),
             fresh = after_two(true, true);
  /// How far row i of one lies from row j of the other.
  const auto apart = [](const gaussian::GaussianCloud& a, std::size_t i, const gaussian::GaussianCloud& b,
                        std::size_t j) {
    float most = std::abs(a.opacity_logits[i] - b.opacity_logits[j]);
    for (std::size_t k = 0; k < 3; ++k) {
      most = std::max(most, std::abs(a.means_m[3 * i + k] - b.means_m[3 * j + k]));
      most = std::max(most, std::abs(a.log_scales[3 * i + k] - b.log_scales[3 * j + k]));
      most = std::max(most, std::abs(a.sh[3 * i + k] - b.sh[3 * j + k]));
    }
    return most;
  };
  std::size_t same = 0, changed = 0;
  for (std::size_t i = 1; i < cloud_.size(); ++i) {
    same += apart(straight, i, turned, i - 1) < 2e-6F ? 1U : 0U;
    changed += apart(straight, i, fresh, i - 1) > 1e-5F ? 1U : 0U;
  }
  EXPECT_EQ(same, cloud_.size() - 1);
  EXPECT_GT(changed, cloud_.size() / 4) << "without moments a step is another";
}

TEST_F(CudaTrain, RefusesRowsThatAreNotThere) {
  CudaTrainStep trainer(pool_, {});
  ASSERT_TRUE(trainer.set_cloud(*stream_, splat::spans_of(cloud_)));
  std::vector<std::uint32_t> from(cloud_.size(), CudaTrainStep::kFreshRow);
  EXPECT_TRUE(trainer.replace_cloud(*stream_, splat::spans_of(cloud_), from));
  from[0] = static_cast<std::uint32_t>(cloud_.size());
  EXPECT_FALSE(trainer.replace_cloud(*stream_, splat::spans_of(cloud_), from));
  from[0] = 5;
  from[1] = 4;
  EXPECT_FALSE(trainer.replace_cloud(*stream_, splat::spans_of(cloud_), from)) << "not ascending";
  from.pop_back();
  EXPECT_FALSE(trainer.replace_cloud(*stream_, splat::spans_of(cloud_), from));
}

TEST_F(CudaTrain, WithoutMemoryIsAnErrorValueAndTheNextBudgetDoes) {
  for (const std::size_t budget_bytes : {std::size_t{1000}, std::size_t{60000}, std::size_t{300000}}) {
    core::VramPool small(budget_bytes);
    {
      CudaTrainStep trainer(small, {});
      const Status set = trainer.set_cloud(*stream_, splat::spans_of(cloud_));
      const Status stepped = set ? step(trainer) : set;
      ASSERT_FALSE(stepped) << budget_bytes;
      EXPECT_EQ(stepped.error().code, Errc::kOutOfVram);
      EXPECT_LE(small.peak_bytes(), budget_bytes);
    }
    EXPECT_EQ(small.used_bytes(), 0U);
  }
  CudaTrainStep trainer(pool_, {});
  ASSERT_TRUE(trainer.set_cloud(*stream_, splat::spans_of(cloud_)));
  EXPECT_TRUE(step(trainer));
}

}  // namespace
}  // namespace edgesplat::train
