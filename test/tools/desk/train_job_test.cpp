// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/train_job.hpp"
#include "common/io/gaussian_file.hpp"
#include "common/io/map_sidecar.hpp"
#include "test/tools/desk/wall_scene.hpp"

#include <gmock/gmock.h>

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
  job.training.sh_degree = 1;
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
  TrainJob job = make_job(folder, 1);
  const auto untrained = run_train_job(job, clock, tell_nobody);
  ASSERT_TRUE(untrained) << untrained.error().context;
  job.training.iterations = kIterations;
  job.training.densify_every = 40;
  job.renders = folder / "renders";
  const auto trained = run_train_job(job, clock, tell_nobody);
  ASSERT_TRUE(trained) << trained.error().context;
  EXPECT_TRUE(trained->triangulated);
  EXPECT_EQ(trained->held_out, 3U);  // frames 0, 4 and 8
  EXPECT_EQ(trained->pictures, 6U);
  EXPECT_EQ(trained->iterations, kIterations);
  EXPECT_FALSE(trained->lpips.has_value());
  EXPECT_GT(*trained->psnr_db, *untrained->psnr_db);
  if (kIterations >= 1000) {
    EXPECT_GT(*trained->psnr_db, 22.0);
    EXPECT_GT(*trained->psnr_db, *untrained->psnr_db + 6.0);
    EXPECT_GT(*trained->ssim, 0.8);
  }
  EXPECT_EQ(io::read_gaussians(job.out).value().size(), trained->gaussians);
  EXPECT_EQ(io::read_sidecar(job.out).value()->gaussians, trained->gaussians);
  EXPECT_TRUE(std::filesystem::exists(folder / "renders" / "view4.png"));
}

TEST(TrainJob, TheSameInputGivesTheSameMap) {
  const test::TempDir folder;
  write_wall_scene(folder, 5, 160, 120);
  const SteadyClock clock;
  TrainJob job = make_job(folder, 120);
  job.training.densify_every = 20;
  ASSERT_TRUE(run_train_job(job, clock, tell_nobody));
  const auto first = io::read_gaussians(job.out).value();
  ASSERT_TRUE(run_train_job(job, clock, tell_nobody));
  const auto second = io::read_gaussians(job.out).value();
  EXPECT_EQ(first.means_m, second.means_m);
  EXPECT_EQ(first.sh, second.sh);
}

TEST(TrainJob, SaysWhatIsWrong) {
  const test::TempDir folder;
  write_wall_scene(folder, 3, 64, 48);
  const SteadyClock clock;
  TrainJob job = make_job(folder, 1);
  job.out = folder / "map.obj";
  EXPECT_EQ(run_train_job(job, clock, tell_nobody).error().code, Errc::kInvalidConfig);
  job = make_job(folder, 0);
  EXPECT_EQ(run_train_job(job, clock, tell_nobody).error().code, Errc::kInvalidConfig);
  job = make_job(folder, 1);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(
        io::save_image(folder / "images" / ("view" + std::to_string(i) + ".png"), sensor::ImageRgb8(64, 48)));
  }
  const auto blank = run_train_job(job, clock, tell_nobody);
  ASSERT_FALSE(blank);
  EXPECT_THAT(blank.error().context, HasSubstr("ply_file_path"));
}

}  // namespace
}  // namespace edgesplat::desk
