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

Result<OdometryRun> run(const fs::path& scans) {
  OdometryJob job;
  job.lidar = scans;
  job.tracking = default_tracking(scans);
  const SteadyClock clock;
  return run_odometry(job, clock);
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

struct DataSet {
  const char* name;
  std::size_t scans;
  double ate_max_m;  ///< 0: no trajectory to compare with
  double path_min_m;
  double path_max_m;
};

class OdometryOnRealScans : public testing::TestWithParam<DataSet> {};

TEST_P(OdometryOnRealScans, StaysWithinItsError) {
  const DataSet& data = GetParam();
  const test::TempDir folder;
  if (!unpack(data.name, folder.path())) GTEST_SKIP() << data.name << ", python3 or numpy is absent";
  const auto odometry = run(folder.path());
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
}

// Drive 0052: both references stumble over the traffic in their first scans (steps of 0.10, 0.26, 0.15 m
// where the car rolls at an even 0.24 m a scan), which alone makes 0.06 m of the error against them.
INSTANTIATE_TEST_SUITE_P(Kitti, OdometryOnRealScans,
                         testing::Values(DataSet{"kitti_drive0005_80scans", 80, 0.05, 29.6, 30.4},
                                         DataSet{"kitti_drive0052_78scans_images", 77, 0.10, 7.8, 8.3},
                                         DataSet{"kitti_odo00_16scans", 16, 0.0, 11.64, 11.92}));

}  // namespace
}  // namespace edgesplat::desk
