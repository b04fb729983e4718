// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/export_scene.hpp"

#include "common/io/atomic_file.hpp"
#include "test/support/temp_dir.hpp"
#include "test/tools/desk/colmap_scene.hpp"
#include "tools/desk/train_job.hpp"
#include "tools/simulate/simulator.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace edgesplat::desk {
namespace {

using ::testing::HasSubstr;

simulate::SimulateOptions corridor(const std::filesystem::path& out) {
  simulate::SimulateOptions options;
  options.world.name = "corridor";
  options.world.pedestrians = 2;
  options.seconds = 5.0;  // it stands still at first
  options.camera_width_px = 96;
  options.camera_height_px = 72;
  options.out = out;
  return options;
}

class ExportScene : public testing::Test {
 protected:
  static void simulate_corridor(const simulate::SimulateOptions& options) {
    ASSERT_TRUE(simulate::simulate(options, [](double) {}, {}));
  }
  test::TempDir folder_;
};

/// Median distance between the points and what the depth pictures say where they are seen, relative to it.
double depth_disagreement(const Scene& scene) {
  std::vector<double> errors;
  for (const ScenePicture& picture : scene.pictures) {
    const auto camera_from_map = picture.map_from_camera.inverse();
    for (const Eigen::Vector3f& point : scene.points.points_m) {
      const Eigen::Vector3d p = camera_from_map * Eigen::Vector3d(point.cast<double>());
      const auto at = picture.camera.project(p);
      if (!at || !picture.camera.contains(*at)) continue;
      const auto pixel =
          static_cast<std::size_t>(std::lround(at->y())) * static_cast<std::size_t>(picture.camera.width_px) +
          static_cast<std::size_t>(std::lround(at->x()));
      if (picture.depth_m[pixel] > 0.0F)
        errors.push_back(std::abs(static_cast<double>(picture.depth_m[pixel]) - p.z()) / p.z());
    }
  }
  if (errors.empty()) return 1.0;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

TEST_F(ExportScene, GivesASceneThatFitsTogetherAndTrains) {
  simulate_corridor(corridor(folder_ / "a.mcap"));
  const auto report = export_scene({folder_ / "a.mcap", folder_ / "scene", 24, 3000, 1});
  ASSERT_TRUE(report) << report.error().context;
  EXPECT_EQ(report->pictures, 24U);
  EXPECT_GT(report->points, 2000U);
  EXPECT_LE(report->points, 3000U);
  const auto scene = read_scene(folder_ / "scene", {});
  ASSERT_TRUE(scene) << scene.error().context;
  ASSERT_EQ(scene->pictures.size(), 24U);
  EXPECT_EQ(scene->points.points_m.size(), report->points);
  EXPECT_EQ(scene->points.rgb.size(), report->points);
  EXPECT_GT(
      (scene->pictures[23].map_from_camera.translation_m - scene->pictures[0].map_from_camera.translation_m)
          .norm(),
      0.1);
  EXPECT_LT(depth_disagreement(*scene), 0.02) << "poses, depths, cameras and points belong together";

  const SteadyClock clock;
  TrainJob job;
  job.scene = folder_ / "scene";
  job.out = folder_ / "map.ply";
  job.training.depth_factor = 0.1F;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  job.training.iterations = 20;
  constexpr double kLeast_db = 12.0;
#else
  job.training.iterations = 300;
  constexpr double kLeast_db = 20.0;
#endif
  const auto trained = run_train_job(job, {clock, clock}, {});
  ASSERT_TRUE(trained) << trained.error().context;
  EXPECT_EQ(trained->start_points, report->points);
  EXPECT_GT(trained->held_out_means->psnr_db, kLeast_db);
}

/// The same cameras, points and images in COLMAP's form: the same map but for rounding of the poses.
TEST_F(ExportScene, TrainsTheSameInColmapsForm) {
  simulate_corridor(corridor(folder_ / "a.mcap"));
  ASSERT_TRUE(export_scene({folder_ / "a.mcap", folder_ / "nerf", 24, 3000, 1}));
  std::filesystem::create_directories(folder_ / "colmap");
  std::filesystem::rename(folder_ / "nerf" / "images", folder_ / "colmap" / "images");
  std::filesystem::create_directory_symlink(folder_ / "colmap" / "images", folder_ / "nerf" / "images");
  colmap_of(folder_ / "nerf").write_bin(folder_, "colmap/sparse/0");
  const SteadyClock clock;
  TrainJob job;
  job.out = folder_ / "map.ply";
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  job.training.iterations = 20;
#else
  job.training.iterations = 200;
#endif
  job.scene = folder_ / "nerf";
  const auto nerf = run_train_job(job, {clock, clock}, {});
  ASSERT_TRUE(nerf) << nerf.error().context;
  job.scene = folder_ / "colmap";
  const auto colmap = run_train_job(job, {clock, clock}, {});
  ASSERT_TRUE(colmap) << colmap.error().context;
  EXPECT_EQ(colmap->start_points, nerf->start_points);
  EXPECT_EQ(colmap->held_out, 3U);
  EXPECT_EQ(colmap->pictures, nerf->pictures);
  EXPECT_FALSE(colmap->triangulated);
  EXPECT_NEAR(colmap->held_out_means->psnr_db, nerf->held_out_means->psnr_db, 0.2);
}

TEST_F(ExportScene, IsTheSameEachTime) {
  simulate_corridor(corridor(folder_ / "a.mcap"));
  ASSERT_TRUE(export_scene({folder_ / "a.mcap", folder_ / "one", 3, 200, 5}));
  ASSERT_TRUE(export_scene({folder_ / "a.mcap", folder_ / "two", 3, 200, 5}));
  for (const char* name : {"points.ply", "transforms.json", "images/000002.png", "depth/000001.png"}) {
    EXPECT_EQ(io::read_text_file(folder_ / "one" / name, 1 << 24).value(),
              io::read_text_file(folder_ / "two" / name, 1 << 24).value())
        << name;
  }
}

TEST_F(ExportScene, SaysWhatIsMissing) {
  EXPECT_EQ(export_scene({folder_ / "none.mcap", folder_ / "scene"}).error().code, Errc::kNotFound);
  auto options = corridor(folder_ / "blind.mcap");
  options.seconds = 0.3;
  options.camera_width_px = options.camera_height_px = 0;
  simulate_corridor(options);
  EXPECT_EQ(export_scene({folder_ / "blind.mcap", folder_ / "scene"}).error().code, Errc::kNotFound);
  options = corridor(folder_ / "free.mcap");
  options.seconds = 0.3;
  options.clock = simulate::ClockMode::kFree;
  simulate_corridor(options);
  const auto free_clock = export_scene({folder_ / "free.mcap", folder_ / "scene"});
  ASSERT_FALSE(free_clock);
  EXPECT_THAT(free_clock.error().context, HasSubstr("--clock ptp"));
  EXPECT_FALSE(export_scene({folder_ / "free.mcap", folder_ / "scene", 0}));
}

}  // namespace
}  // namespace edgesplat::desk
