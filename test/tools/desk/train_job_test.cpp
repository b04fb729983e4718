// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/train_job.hpp"
#include "common/io/gaussian_file.hpp"
#include "common/io/map_sidecar.hpp"
#include "test/tools/desk/wall_scene.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>

namespace edgesplat::desk {
namespace {

using ::testing::HasSubstr;

void tell_nobody(const TrainingProgress&) {}

TrainJob make_job(const test::TempDir& folder, std::uint64_t iterations) {
  TrainJob job;
  job.scene = folder.path();
  job.out = folder / "map.ply";
  job.holdout = 4;
  job.training.iterations = iterations;
  job.training.schedule.sh_degree = 1;
  return job;
}

/// A sanitizer makes training some fifty times slower: there the same way is gone, not as far.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kIterations = 100;
#else
constexpr std::size_t kIterations = 1000;
#endif

TEST(TrainJob, LearnsAWallFromItsPicturesAlone) {
  const test::TempDir folder;
  write_wall_scene(folder, 9, 160, 120);
  const SteadyClock clock;
  const TrainClocks clocks{clock, clock};
  TrainJob job = make_job(folder, 1);
  const auto untrained = run_train_job(job, clocks, tell_nobody);
  ASSERT_TRUE(untrained) << untrained.error().context;
  job.training.iterations = kIterations;
  job.training.densify_every = 40;
  job.renders = folder / "renders";
  const auto trained = run_train_job(job, clocks, tell_nobody);
  ASSERT_TRUE(trained) << trained.error().context;
  EXPECT_TRUE(trained->triangulated);
  EXPECT_EQ(trained->held_out, 3U);  // frames 0, 4 and 8
  EXPECT_EQ(trained->pictures, 6U);
  EXPECT_EQ(trained->iterations, kIterations);
  EXPECT_FALSE(trained->held_out_means->lpips.has_value());
  EXPECT_GT(trained->held_out_means->psnr_db, untrained->held_out_means->psnr_db);
  if (kIterations >= 1000) {
    EXPECT_GT(trained->held_out_means->psnr_db, 22.0);
    EXPECT_GT(trained->held_out_means->psnr_db, untrained->held_out_means->psnr_db + 6.0);
    EXPECT_GT(trained->held_out_means->ssim, 0.8);
  }
  EXPECT_EQ(io::read_gaussians(job.out).value().size(), trained->gaussians);
  EXPECT_EQ(io::read_sidecar(job.out).value()->gaussians, trained->gaussians);
  EXPECT_TRUE(std::filesystem::exists(folder / "renders" / "view4.png"));
}

TEST(TrainJob, TheSameInputGivesTheSameMap) {
  const test::TempDir folder;
  write_wall_scene(folder, 5, 160, 120);
  const SteadyClock clock;
  const TrainClocks clocks{clock, clock};
  TrainJob job = make_job(folder, 120);
  job.training.densify_every = 20;
  ASSERT_TRUE(run_train_job(job, clocks, tell_nobody));
  const auto first = io::read_gaussians(job.out).value();
  ASSERT_TRUE(run_train_job(job, clocks, tell_nobody));
  const auto second = io::read_gaussians(job.out).value();
  EXPECT_EQ(first.means_m, second.means_m);
  EXPECT_EQ(first.sh, second.sh);
}

/// Every reading is a hundredth of a second after the last: an iteration, which reads it six times, takes
/// 0.06 s.
class SteppingClock final : public Clock {
 public:
  [[nodiscard]] HostTime now() const override { return host_time_from_ns(10'000'000 * ++readings_); }

 private:
  mutable std::int64_t readings_ = 0;
};

TEST(TrainJob, WritesItsCurve) {
  const test::TempDir folder;
  write_wall_scene(folder, 5, 96, 72);
  const SteadyClock wall;
  const SteppingClock training;
  TrainJob job = make_job(folder, 0);
  job.training.seconds = 7.5;
  job.curve = folder / "curve.csv";
  ASSERT_TRUE(run_train_job(job, {wall, training}, tell_nobody));
  std::ifstream file(job.curve);
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(line, "seconds,iterations,gaussians,psnr_db,ssim,lpips");
  std::vector<double> seconds, psnr_db;
  while (std::getline(file, line)) {
    double at = 0.0, psnr = 0.0, ssim = 0.0;
    unsigned long iterations = 0, gaussians = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lu,%lu,%lf,%lf,", &at, &iterations, &gaussians, &psnr, &ssim),
              5)
        << line;
    EXPECT_GT(iterations, 0U);
    EXPECT_GE(gaussians, 10U);
    EXPECT_TRUE(ssim > 0.0 && ssim < 1.0) << line;
    if (!seconds.empty()) {
      EXPECT_GT(at, seconds.back());
    }
    seconds.push_back(at);
    psnr_db.push_back(psnr);
  }
  ASSERT_EQ(seconds.size(), 5U);  // 1, 2, 4, 7 and the end: looking takes none of the time
  const double wanted[] = {1.0, 2.0, 4.0, 7.0, 7.5};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(seconds[i], wanted[i], 0.1);
  EXPECT_GT(psnr_db.back(), psnr_db.front());
  job.holdout = 0;
  EXPECT_EQ(run_train_job(job, {wall, training}, tell_nobody).error().code, Errc::kInvalidConfig);
}

TEST(TrainJob, EveryMeasureLearns) {
  const test::TempDir folder;
  write_wall_scene(folder, 9, 96, 72);
  const SteadyClock clock;
  const TrainClocks clocks{clock, clock};
  const auto psnr_db = [&](const TrainJob& job) {
    const auto report = run_train_job(job, clocks, tell_nobody);
    EXPECT_TRUE(report) << report.error().context;
    return report ? report->held_out_means->psnr_db : 0.0;
  };
  const double untrained_db = psnr_db(make_job(folder, 1));
  TrainJob mcmc = make_job(folder, kIterations / 4);
  mcmc.training.densify = Densify::kMcmc;
  mcmc.training.densify_every = 25;
  mcmc.training.opacity_factor = 0.01F;
  mcmc.training.scale_factor = 0.01F;
  TrainJob staged = make_job(folder, kIterations / 4);
  staged.training.schedule = {.coarse_until = 0.3, .sh_degree = 1, .sh_from = 0.5, .cool_from = 0.6};
  staged.training.views.loss_share = 0.5F;
  const double least_db = kIterations >= 1000 ? untrained_db + 3.0 : untrained_db;
  EXPECT_GT(psnr_db(mcmc), least_db);
  EXPECT_GT(psnr_db(staged), least_db);
  EXPECT_EQ(io::read_gaussians(staged.out).value().sh_degree, 1);
}

TEST(TrainJob, SaysWhatIsWrong) {
  const test::TempDir folder;
  write_wall_scene(folder, 3, 64, 48);
  const SteadyClock clock;
  const TrainClocks clocks{clock, clock};
  TrainJob job = make_job(folder, 1);
  job.out = folder / "map.obj";
  EXPECT_EQ(run_train_job(job, clocks, tell_nobody).error().code, Errc::kInvalidConfig);
  job = make_job(folder, 0);
  EXPECT_EQ(run_train_job(job, clocks, tell_nobody).error().code, Errc::kInvalidConfig);
  job = make_job(folder, 1);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(
        io::save_image(folder / "images" / ("view" + std::to_string(i) + ".png"), sensor::ImageRgb8(64, 48)));
  }
  const auto blank = run_train_job(job, clocks, tell_nobody);
  ASSERT_FALSE(blank);
  EXPECT_THAT(blank.error().context, HasSubstr("ply_file_path"));
}

}  // namespace
}  // namespace edgesplat::desk
