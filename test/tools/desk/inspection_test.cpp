// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/inspection.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/mcap_writer.hpp"
#include "common/io/ply_gaussians.hpp"
#include "common/io/ply_points.hpp"
#include "common/io/trajectory_file.hpp"
#include "test/common/io/bag_samples.hpp"
#include "tools/desk/gap_statistics.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace edgesplat::desk {
namespace {

std::filesystem::path file_named(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / ("edgesplat_inspect_" + name);
}

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

HostTime at(double seconds) {
  return host_time_from_ns(from_seconds(seconds).count());
}

/// 50 messages at 10 Hz with a gap of 1 s in the middle, and an attachment.
std::filesystem::path make_recording() {
  auto path = file_named("a.mcap");
  auto writer = io::McapWriter::create(path);
  EXPECT_TRUE(writer);
  const auto schema = writer->add_schema("test_msgs/msg/Note", "ros2msg", "string text");
  const auto channel = writer->add_channel("/note", *schema);
  for (std::uint32_t i = 0; i < 50; ++i) {
    const double t = 0.1 * i + (i >= 25 ? 0.9 : 0.0);
    EXPECT_TRUE(writer->write(*channel, i, at(t), SensorTime{}, bytes_of("hello")));
  }
  EXPECT_TRUE(writer->add_attachment("rig.toml", "text/plain", bytes_of("name = 1\n")));
  EXPECT_TRUE(writer->close());
  return path;
}

nlohmann::json json_of(const Result<Inspection>& inspection) {
  EXPECT_TRUE(inspection) << (inspection ? "" : inspection.error().context);
  return inspection ? nlohmann::json::parse(inspection->json) : nlohmann::json();
}

TEST(GapStatistics, FindsTheLargestGap) {
  GapStatistics gaps;
  EXPECT_EQ(gaps.rate_hz(), 0.0);
  for (const double t : {1.0, 1.5, 3.5, 4.0}) gaps.add(at(t));
  EXPECT_EQ(gaps.count(), 4U);
  EXPECT_DOUBLE_EQ(gaps.largest_gap_s(), 2.0);
  EXPECT_EQ(gaps.gap_start(), at(1.5));
  EXPECT_DOUBLE_EQ(gaps.rate_hz(), 1.0);
}

TEST(InspectRecording, CountsRatesGapsAndAttachments) {
  const auto json = json_of(inspect_file(make_recording()));
  EXPECT_EQ(json["kind"], "recording");
  EXPECT_EQ(json["messages"], 50);
  EXPECT_TRUE(json["complete"]);
  const auto& channel = json["channels"][0];
  EXPECT_EQ(channel["topic"], "/note");
  EXPECT_EQ(channel["schema"], "test_msgs/msg/Note");
  EXPECT_EQ(channel["bytes"], 250);
  EXPECT_NEAR(channel["duration_s"], 5.8, 1e-9);
  EXPECT_NEAR(channel["rate_hz"], 49 / 5.8, 1e-9);
  EXPECT_NEAR(channel["largest_gap_s"], 1.0, 1e-9);
  EXPECT_EQ(json["attachments"], nlohmann::json::array({"rig.toml"}));
}

TEST(InspectRecording, ATruncatedOneSaysSo) {
  const auto whole = io::read_file(make_recording(), 1'000'000);
  ASSERT_TRUE(whole);
  const auto path = file_named("cut.mcap");
  ASSERT_TRUE(io::write_file_atomically(path, std::span(*whole).first(whole->size() - 200)));
  const auto json = json_of(inspect_file(path));
  EXPECT_FALSE(json["complete"]);
  EXPECT_NE(json["why"], "");
}

TEST(ExtractAttachment, WritesItOrNamesWhatIsThere) {
  const auto recording = make_recording();
  const auto target = file_named("rig.toml");
  ASSERT_TRUE(extract_attachment(recording, "rig.toml", target));
  EXPECT_EQ(io::read_text_file(target, 100).value_or(""), "name = 1\n");
  const Status missing = extract_attachment(recording, "world.toml", target);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kNotFound);
  EXPECT_NE(missing.error().context.find("rig.toml"), std::string::npos);
}

TEST(InspectCloud, TellsPointsFromGaussians) {
  io::PointCloud cloud;
  cloud.points_m = {{0, 0, 0}, {2, 3, 4}};
  ASSERT_TRUE(io::write_points_ply(file_named("points.ply"), cloud));
  auto json = json_of(inspect_file(file_named("points.ply")));
  EXPECT_EQ(json["kind"], "points");
  EXPECT_EQ(json["points"], 2);
  EXPECT_EQ(json["max_m"][2], 4.0);

  gaussian::GaussianCloud gaussians;
  gaussians.resize(3);
  for (std::size_t i = 0; i < 3; ++i) gaussians.quats_xyzw[4 * i + 3] = 1.0F;
  ASSERT_TRUE(io::write_gaussians_ply(file_named("gaussians.ply"), gaussians));
  json = json_of(inspect_file(file_named("gaussians.ply")));
  EXPECT_EQ(json["kind"], "gaussians");
  EXPECT_EQ(json["gaussians"], 3);
  EXPECT_DOUBLE_EQ(json["mean_opacity"], 0.5);
}

TEST(InspectTrajectory, MeasuresPathRateAndOrder) {
  std::vector<io::StampedPose> poses(11);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].stamp = at(0.1 * static_cast<double>(i));
    poses[i].world_from_body.translation_m.x() = 0.5 * static_cast<double>(i);
  }
  ASSERT_TRUE(io::write_tum(file_named("a.tum"), poses));
  const auto json = json_of(inspect_file(file_named("a.tum")));
  EXPECT_EQ(json["poses"], 11);
  EXPECT_NEAR(json["path_m"], 5.0, 1e-9);
  EXPECT_NEAR(json["rate_hz"], 10.0, 1e-6);
  EXPECT_EQ(json["steps_back_in_time"], 0);
}

TEST(InspectFile, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(inspect_file("a.jpeg").error().code, Errc::kInvalidArgument);
  EXPECT_FALSE(inspect_file(file_named("never_written.mcap")));
  ASSERT_TRUE(io::write_file_atomically(file_named("noise.ply"), std::string_view("not a ply file")));
  EXPECT_FALSE(inspect_file(file_named("noise.ply")));
}

TEST(Inspection, CountsABagsTopics) {
  const auto path = file_named("a.bag");
  const auto bytes = io::rosbag1_bytes(io::numbered_messages(50), io::BagCompression::kLz4);
  ASSERT_TRUE(io::write_file_atomically(path, bytes));
  const auto inspection = inspect_file(path);
  ASSERT_TRUE(inspection) << inspection.error().context;
  const auto json = nlohmann::json::parse(inspection->json);
  EXPECT_EQ(json["kind"], "bag");
  EXPECT_EQ(json["messages"], 50);
  EXPECT_EQ(json["complete"], true);
  ASSERT_EQ(json["channels"].size(), 2U);
  EXPECT_EQ(json["channels"][0]["topic"], "/even");
  EXPECT_EQ(json["channels"][0]["schema"], "test/Text");
  EXPECT_EQ(json["channels"][0]["messages"], 25);
  EXPECT_NEAR(json["channels"][0]["rate_hz"].get<double>(), 50.0, 1e-6);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace edgesplat::desk
