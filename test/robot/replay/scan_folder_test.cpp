// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/image_file.hpp"
#include "robot/drivers/replay/frame_times.hpp"
#include "robot/drivers/replay/replay_source.hpp"
#include "robot/drivers/replay/scan_file.hpp"
#include "test/robot/replay/kitti_text.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace edgesplat::replay {
namespace {

constexpr std::int64_t kMs = 1'000'000;

std::vector<sensor::Measurement> read_all(ReplaySource& source) {
  std::vector<sensor::Measurement> all;
  while (true) {
    auto next = source.next();
    EXPECT_TRUE(next.has_value()) << next.error().context;
    if (!next || !*next) return all;
    all.push_back(**std::move(next));
  }
}

/// A scan of these x, y, z, intensity values.
void write_scan(const test::TempDir& folder, const std::string& name, const std::vector<float>& values) {
  (void)folder.write(name, std::as_bytes(std::span(values)));
}

std::vector<std::byte> picture(int width, int height) {
  return io::encode_jpeg(sensor::ImageRgb8(width, height, 90)).value();
}

TEST(ScanFile, DropsAndCountsWhatIsNoReturn) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values{1, 2, 3, 0.5F, nan, 0, 0, 0, 0, 0, 0, 0, 4, 5, 6, 7, 1, 0, 0, nan};
  std::uint64_t dropped = 0;
  const auto points = parse_scan(std::as_bytes(std::span(values)), "a.bin", dropped);
  ASSERT_TRUE(points.has_value());
  ASSERT_EQ(points->size(), 3U);
  EXPECT_EQ(dropped, 2U);
  EXPECT_FLOAT_EQ((*points)[0].reflectivity, 0.5F);
  EXPECT_FLOAT_EQ((*points)[1].reflectivity, 1.0F);
  EXPECT_FLOAT_EQ((*points)[2].reflectivity, 0.0F);
}

TEST(ScanFile, RefusesSizesThatAreNoScan) {
  std::uint64_t dropped = 0;
  for (const std::size_t bytes : {0U, 1U, 15U, 17U, 31U}) {
    const std::vector<std::byte> content(bytes);
    EXPECT_EQ(parse_scan(content, "a.bin", dropped).error().code, Errc::kCorrupt) << bytes;
  }
  EXPECT_EQ(check_scan_size(kMaxScanFileBytes + 16, "a.bin").error().code, Errc::kCorrupt);
}

TEST(FrameTimes, FollowNumbersPlacesAndLines) {
  const auto by_number = FrameTimes::create(std::nullopt, {"0000000010", "0000000012"});
  ASSERT_TRUE(by_number.has_value());
  EXPECT_EQ(by_number->of("0000000010"), nanoseconds(0));
  EXPECT_EQ(by_number->of("0000000012"), nanoseconds(200 * kMs));  // number 11 is missing
  EXPECT_FALSE(by_number->of("0000000009").has_value());
  const auto by_place = FrameTimes::create(std::nullopt, {"a", "b"});
  EXPECT_EQ(by_place->of("b"), nanoseconds(100 * kMs));
  const std::vector<nanoseconds> lines{nanoseconds(0), nanoseconds(5), nanoseconds(9)};
  EXPECT_EQ(FrameTimes::create(lines, {"0", "2"})->of("2"), nanoseconds(9));
  EXPECT_EQ(FrameTimes::create(lines, {"70", "71", "72"})->of("71"), nanoseconds(5));
  EXPECT_EQ(FrameTimes::create(lines, {"70", "71"}).error().code, Errc::kInvalidArgument);
}

TEST(FrameTimes, ReadsSecondsAndNamesTheBadLine) {
  const auto times = parse_times("0.000000e+00\n1.037e-01\r\n\n0.25\n", "times.txt");
  ASSERT_TRUE(times.has_value()) << times.error().context;
  EXPECT_EQ((*times)[1], nanoseconds(103'700'000));
  for (const char* bad : {"0\nabc\n", "0\n0\n", "1\n0.5\n", "0\nnan\n", "0\n-1\n", "0\n1e30\n", "0\n1 2\n"}) {
    const auto refused = parse_times(bad, "times.txt");
    ASSERT_FALSE(refused.has_value()) << bad;
    EXPECT_NE(refused.error().context.find("times.txt:2"), std::string::npos) << refused.error().context;
  }
}

TEST(ScanFolder, ReplaysKittisLayoutInTimeOrder) {
  const test::TempDir folder;
  for (const int number : {5, 6, 8}) {  // 7 is missing
    write_scan(folder, "velodyne/000000000" + std::to_string(number) + ".bin",
               {static_cast<float>(number), 0, 0, 0.5F, 1, 1, 1, 1});
    folder.write("image_02/000000000" + std::to_string(number) + ".jpg", picture(64, 48));
  }
  folder.write("calib_2011_09_26.txt", std::string_view(kKittiCalib));
  auto source = ReplaySource::open(folder.path());
  ASSERT_TRUE(source.has_value()) << source.error().context;
  ASSERT_TRUE(source->rig().camera.has_value());
  EXPECT_EQ(source->rig().camera->model.width_px, 64);
  EXPECT_FALSE(source->rig().imu.has_value());
  EXPECT_EQ(source->duration(), nanoseconds(350 * kMs));  // the last turn ends 50 ms after its picture
  const auto all = read_all(*source);
  ASSERT_EQ(all.size(), 6U);
  for (std::size_t i = 0; i < 6; i += 2) {
    const auto& frame = std::get<sensor::CameraFrame>(all[i]);
    const auto& turn = std::get<sensor::LidarPacket>(all[i + 1]);
    EXPECT_EQ(to_ns(frame.stamp), (i == 4 ? 300 : static_cast<std::int64_t>(i) * 50) * kMs);
    EXPECT_EQ(frame.image->height_px, 48);
    EXPECT_EQ(to_ns(turn.stamp), to_ns(frame.stamp) - 50 * kMs);
    EXPECT_EQ(to_ns(turn.arrival), to_ns(frame.stamp) + 50 * kMs);
    EXPECT_EQ(turn.span, nanoseconds(100 * kMs));
  }
  // Clockwise from the rear: left at a quarter of the turn, ahead (when the picture is taken) at half of it.
  const auto& first = std::get<sensor::LidarPacket>(all[1]);
  ASSERT_EQ(first.points.size(), 2U);
  EXPECT_NEAR(first.points[0].offset_ns, 37.5 * kMs, 1000);  // (1, 1): 45 degrees to the left
  EXPECT_NEAR(first.points[1].offset_ns, 50 * kMs, 1000);    // (5, 0): ahead
  EXPECT_TRUE(source->report().complete);
  EXPECT_EQ(source->report().measurements, 6U);
}

TEST(ScanFolder, ReplaysAFolderOfScansWithTimes) {
  const test::TempDir folder;
  write_scan(folder, "0.bin", {1, 0, 0, 0});
  write_scan(folder, "1.bin", {2, 0, 0, 0});
  folder.write("times.txt", "10.0\n10.2\n");
  auto source = ReplaySource::open(folder.path());
  ASSERT_TRUE(source.has_value()) << source.error().context;
  EXPECT_FALSE(source->rig().camera.has_value());
  const auto all = read_all(*source);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(to_ns(std::get<sensor::LidarScan>(all[1]).stamp), 10'200 * kMs);
  EXPECT_EQ(to_ns(source->begin()), 10'000 * kMs);
}

TEST(ScanFolder, SkipsADamagedPictureAndSaysSo) {
  const test::TempDir folder;
  for (const char* number : {"0", "1"})
    write_scan(folder, std::string("velodyne/") + number + ".bin", {1, 0, 0, 0});
  auto damaged = picture(64, 48);
  folder.write("image_02/0.jpg", damaged);
  damaged.resize(damaged.size() / 2);
  folder.write("image_02/1.jpg", damaged);
  folder.write("calib.txt", std::string_view(kKittiCalib));
  auto source = ReplaySource::open(folder.path());
  ASSERT_TRUE(source.has_value()) << source.error().context;
  EXPECT_EQ(read_all(*source).size(), 3U);
  EXPECT_EQ(source->report().frames_refused, 1U);
  EXPECT_FALSE(source->report().complete);
  EXPECT_NE(source->report().why.find("1.jpg"), std::string::npos) << source->report().why;
}

void expect_refused(const std::filesystem::path& path, Errc code, const std::string& part) {
  const auto source = ReplaySource::open(path);
  ASSERT_FALSE(source.has_value()) << part;
  EXPECT_EQ(source.error().code, code);
  EXPECT_NE(source.error().context.find(part), std::string::npos) << source.error().context;
}

TEST(ScanFolder, SaysWhatIsWrongWithAFolder) {
  const test::TempDir folder;
  expect_refused(folder.path() / "nowhere", Errc::kNotFound, "does not exist");
  expect_refused(folder.path(), Errc::kInvalidArgument, "Found: nothing");
  expect_refused(folder.write("a/notes.txt", "x").parent_path(), Errc::kInvalidArgument, "Found: notes.txt");
  expect_refused(folder.write("film.mp4", "x"), Errc::kInvalidArgument, "*.mp4");
  expect_refused(folder.write("b/velodyne/0000000001.mmx", "x").parent_path().parent_path(),
                 Errc::kInvalidArgument, "unpack");
  expect_refused(folder.write("c/0.bin", "123456789").parent_path(), Errc::kCorrupt, "multiple of 16");
  write_scan(folder, "d/velodyne/0.bin", {1, 0, 0, 0});
  folder.write("d/image_02/0.jpg", picture(8, 8));
  expect_refused(folder.path() / "d", Errc::kInvalidArgument, "no calib_*.txt");
  folder.write("d/calib.txt", "P_rect_02: 1\n");
  expect_refused(folder.path() / "d", Errc::kInvalidConfig, "calib.txt:1");
}

}  // namespace
}  // namespace edgesplat::replay
