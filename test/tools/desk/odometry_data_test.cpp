// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Real scans of a Velodyne HDL-64E, LiDAR only, one configuration for all: judged against other programs'
// odometry.
#include "test/support/child_process.hpp"
#include "test/support/temp_dir.hpp"
#include "tools/accuracy/association.hpp"
#include "tools/accuracy/evaluation.hpp"
#include "tools/desk/odometry.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace edgesplat::desk {
namespace {

namespace fs = std::filesystem;
const fs::path kShared = fs::path(EDGESPLAT_SOURCE_DIR) / "../shared/data";

/// Unpacks the scans of a data set into `into`; false where the data, python3 or numpy are absent.
bool unpack(const std::string& data_set, const fs::path& into) {
  const fs::path packed = kShared / data_set / "velodyne";
  if (!fs::exists(packed) || !fs::exists("/usr/bin/python3")) return false;
  std::vector<std::string> command = {"/usr/bin/python3", (kShared / "lidar_pack.py").string()};
  for (const auto& entry : fs::directory_iterator(packed)) {
    if (entry.path().extension() != ".mmx") continue;
    fs::copy_file(entry.path(), into / entry.path().filename());  // it unpacks next to the packed file
    command.push_back((into / entry.path().filename()).string());
  }
  return test::ChildProcess(command).wait(std::chrono::minutes(5)) == 0;
}

Result<OdometryRun> run(const fs::path& scans, ScanTiming timing) {
  OdometryJob job;
  job.lidar = scans;
  job.timing = timing;
  job.tracking = default_tracking(scans);
  const SteadyClock clock;
  return run_odometry(job, clock, clock);
}

/// The smaller of the errors against the two programs' trajectories.
double best_ate_m(const OdometryRun& odometry, const std::string& data_set) {
  double best = std::numeric_limits<double>::infinity();
  for (const char* file : {"poses_kiss_icp_pseudo.txt", "poses_velo_gicp_pseudo.txt"}) {
    accuracy::ReferenceSource source;
    source.path = kShared / data_set / file;
    source.format = accuracy::ReferenceFormat::kKitti;
    const auto reference = accuracy::read_reference(source, odometry.poses.front().stamp);
    EXPECT_TRUE(reference.has_value());
    const auto pairs = accuracy::associate(odometry.poses, *reference, std::chrono::milliseconds(10));
    EXPECT_EQ(pairs.size(), odometry.poses.size());
    best = std::min(best, accuracy::evaluate(pairs)->absolute_m.rmse);
  }
  return best;
}

double path_m(const OdometryRun& odometry) {
  double length = 0.0;
  for (std::size_t i = 1; i < odometry.poses.size(); ++i) {
    length += (odometry.poses[i].world_from_body.translation_m -
               odometry.poses[i - 1].world_from_body.translation_m)
                  .norm();
  }
  return length;
}

/// How far the points lie off the planes of the map, once there is a map.
double residual_m(const OdometryRun& odometry) {
  constexpr std::size_t kFirst = 6;
  double sum = 0.0;
  for (std::size_t i = kFirst; i < odometry.health.size(); ++i)
    sum += odometry.health[i].health.residual_rms_m;
  return sum / static_cast<double>(odometry.health.size() - kFirst);
}

struct DataSet {
  const char* name;
  std::size_t scans;
  bool as_fired;     ///< stored as the rays were fired, not as of one moment
  bool points_tell;  ///< fast and long enough for the points to lie better on the map with the right times
  double ate_max_m;  ///< 0: no trajectory to compare with
  double path_min_m;
  double path_max_m;
};

class OdometryOnRealScans : public testing::TestWithParam<DataSet> {};

TEST_P(OdometryOnRealScans, StaysWithinItsErrorAndTakesPointsAtTheirTimes) {
  const DataSet& data = GetParam();
  const test::TempDir folder;
  if (!unpack(data.name, folder.path())) GTEST_SKIP() << data.name << ", python3 or numpy is absent";
  const auto odometry = run(folder.path(), ScanTiming::kAuto);
  ASSERT_TRUE(odometry.has_value()) << odometry.error().context;
  EXPECT_EQ(odometry->poses.size(), data.scans);
  EXPECT_EQ(odometry->coasted_groups, 0);
  EXPECT_GT(path_m(*odometry), data.path_min_m);
  EXPECT_LT(path_m(*odometry), data.path_max_m);
  if (data.ate_max_m > 0.0) {
    const double ate_m = best_ate_m(*odometry, data.name);
    RecordProperty("ate_m", std::to_string(ate_m));
    EXPECT_LT(ate_m, data.ate_max_m);
  }
  // The points of a fast car say themselves when they were measured: with the right times they lie better on
  // the map. In the stop and go of drive 0052 they do not, and of 16 scans the last bits decide (with the
  // wrong times 49 to 54 mm).
  const auto other = run(folder.path(), data.as_fired ? ScanTiming::kInstant : ScanTiming::kAzimuth);
  ASSERT_TRUE(other.has_value()) << other.error().context;
  RecordProperty("residual_m", std::to_string(residual_m(*odometry)));
  RecordProperty("residual_with_other_times_m", std::to_string(residual_m(*other)));
  EXPECT_EQ(timing_of(folder.path()), data.as_fired ? ScanTiming::kAzimuth : ScanTiming::kInstant);
  if (data.points_tell) {
    EXPECT_LT(residual_m(*odometry), 0.97 * residual_m(*other));
  }
}

// The references of both drives take each scan as of one moment, and stumble over the traffic in the first
// scans of drive 0052 (steps of 0.10, 0.26, 0.15 m where the car rolls at an even 0.24 m a scan): they lie
// 0.08 m and 0.09 m from one made of the scans as they were fired, from which our trajectory is 0.01 and 0.02
// m (`tools/bench --peers`).
INSTANTIATE_TEST_SUITE_P(
    Kitti, OdometryOnRealScans,
    testing::Values(DataSet{"kitti_drive0005_80scans", 80, true, true, 0.10, 29.6, 30.4},
                    DataSet{"kitti_drive0052_78scans_images", 77, true, false, 0.10, 7.8, 8.3},
                    DataSet{"kitti_odo00_16scans", 16, false, false, 0.0, 11.64, 11.92}));

/// With the defaults, of which nothing is chosen for a recording.
TEST(OdometryOnDrives, AreWithinFiveCentimetresOfAReferenceByDefault) {
  for (const char* data_set : {"kitti_drive0005_80scans", "kitti_drive0052_78scans_images"}) {
    const test::TempDir folder;
    const fs::path scans = folder.path() / "velodyne";
    fs::create_directories(scans);
    if (!unpack(data_set, scans)) GTEST_SKIP() << data_set << " is absent";
    for (const char* part : {"image_02", "calib_2011_09_26.txt"})
      if (fs::exists(kShared / data_set / part))
        fs::create_symlink(kShared / data_set / part, folder.path() / part);
    const auto odometry = run(folder.path(), OdometryJob{}.timing);
    ASSERT_TRUE(odometry.has_value()) << odometry.error().context;
    // Groups end at a picture, which is taken half a turn after the scan's stamp in the replay.
    OdometryRun at_scans = *odometry;
    const bool at_pictures = fs::exists(folder.path() / "image_02");
    for (io::StampedPose& pose : at_scans.poses)
      if (at_pictures) pose.stamp -= std::chrono::milliseconds(50);
    EXPECT_LT(best_ate_m(at_scans, data_set), 0.05) << data_set;
  }
}

}  // namespace
}  // namespace edgesplat::desk
