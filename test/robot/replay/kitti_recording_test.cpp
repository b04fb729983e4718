// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/image_file.hpp"
#include "robot/drivers/replay/replay_source.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace edgesplat::replay {
namespace {

namespace fs = std::filesystem;

const fs::path& shared_data() {
  static const fs::path kPath = fs::path(EDGESPLAT_SOURCE_DIR) / ".." / "shared" / "data";
  return kPath;
}
fs::path drive() {
  return shared_data() / "kitti_drive0052_78scans_images";
}

TEST(KittiRecording, PackedScansAskToBeUnpacked) {
  if (!fs::exists(drive() / "velodyne")) GTEST_SKIP() << drive() << " is absent";
  if (fs::exists(drive() / "velodyne" / "0000000000.bin")) GTEST_SKIP() << "the scans are unpacked already";
  const auto source = ReplaySource::open(drive());
  ASSERT_FALSE(source.has_value());
  EXPECT_EQ(source.error().code, Errc::kInvalidArgument);
  EXPECT_NE(source.error().context.find("unpack"), std::string::npos) << source.error().context;
}

bool any_python_runs(const std::string& arguments) {
  for (const char* python : {"python3", "/usr/bin/python3"})
    if (std::system((python + arguments + " 2>/dev/null").c_str()) == 0) return true;
  return false;
}

/// Share of the scan's points that fall into the picture: a third of KITTI's field of view is the camera's.
TEST(KittiRecording, ScansAndPicturesFitEachOther) {
  const fs::path unpacker = shared_data() / "lidar_pack.py";
  if (!fs::exists(drive() / "velodyne") || !fs::exists(unpacker)) GTEST_SKIP() << drive() << " is absent";
  const test::TempDir folder;
  fs::create_directories(folder.path() / "velodyne");
  fs::create_directories(folder.path() / "image_02");
  std::string arguments = " '" + unpacker.string() + "'";
  for (const char* number : {"0000000000", "0000000001"}) {
    const fs::path packed = folder.path() / "velodyne" / (std::string(number) + ".mmx");
    fs::copy_file(drive() / "velodyne" / packed.filename(), packed);
    arguments += " '" + packed.string() + "'";
    fs::copy_file(drive() / "image_02" / (std::string(number) + ".jpg"),
                  folder.path() / "image_02" / (std::string(number) + ".jpg"));
  }
  fs::copy_file(drive() / "calib_2011_09_26.txt", folder.path() / "calib_2011_09_26.txt");
  if (!any_python_runs(arguments)) GTEST_SKIP() << "python3 with numpy is absent";

  auto source = ReplaySource::open(folder.path());
  ASSERT_TRUE(source.has_value()) << source.error().context;
  const sensor::CameraMount& camera = source->rig().camera.value();
  EXPECT_EQ(camera.model.width_px, 1242);
  const auto picture = source->next();
  ASSERT_TRUE(picture.has_value() && picture->has_value());
  auto first = source->next();
  ASSERT_TRUE(first.has_value() && first->has_value());
  const auto& scan = std::get<sensor::LidarPacket>(**first);
  EXPECT_GT(scan.points.size(), 80'000U);
  std::size_t inside = 0;
  for (const sensor::LidarPoint& point : scan.points) {
    const auto pixel =
        camera.model.project(camera.body_from_camera.inverse() * point.p_in_lidar_m.cast<double>());
    inside += pixel && camera.model.contains(*pixel) ? 1U : 0U;
  }
  EXPECT_GT(inside, scan.points.size() / 8);
  EXPECT_LT(inside, scan.points.size() / 4);
  // The picture is taken in the middle of the turn.
  EXPECT_EQ(std::get<sensor::CameraFrame>(**picture).stamp, scan.stamp + scan.span / 2);
}

}  // namespace
}  // namespace edgesplat::replay
