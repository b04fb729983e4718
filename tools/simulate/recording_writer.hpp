// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/io/mcap_writer.hpp"
#include "common/io/ros_messages.hpp"
#include "common/time/time.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace edgesplat::simulate {

/// One exposure with its truth, encoded.
struct RecordedFrame {
  SensorTime stamp{};
  HostTime arrival{};
  io::FrameMeta meta;
  std::vector<std::byte> image_jpeg;
  std::vector<std::byte> clean_png;
  std::vector<std::byte> mask_png;
  std::vector<std::byte> depth_png;
};

/// Writes a simulation as a recording (ARCHITECTURE.md, "A recording"). Devices deliver in any order;
/// messages are held back until nothing earlier can come, so the file is in the order of arrival.
/// Single-owner.
class RecordingWriter {
 public:
  static Result<RecordingWriter> create(const std::filesystem::path& path, std::size_t lidars = 1);

  /// `unit`: which LiDAR's, each has a topic.
  void add_points(std::size_t unit, SensorTime stamp, HostTime arrival, std::vector<std::byte> datagram);
  void add_imu(SensorTime stamp, HostTime arrival, std::vector<std::byte> datagram);
  void add_pose(HostTime time, const geometry::RigidTransform& world_from_body);
  void add_frame(const RecordedFrame& frame);
  /// Writes every message that arrived before `time`: the caller promises that no earlier one follows.
  [[nodiscard]] Status write_until(HostTime time);
  [[nodiscard]] Status attach(std::string_view name, std::string_view text);
  /// Writes what is left and closes the file.
  [[nodiscard]] Status close(const std::map<std::string, std::string>& metadata);
  [[nodiscard]] const io::McapWriter& file() const { return file_; }

 private:
  enum Topic : std::size_t { kPoints, kImu, kMeta, kImage, kPose, kClean, kMask, kDepth, kMorePoints };
  struct Pending {
    std::size_t topic;
    SensorTime stamp;
    HostTime arrival;
    std::vector<std::byte> payload;
  };
  explicit RecordingWriter(io::McapWriter file) : file_(std::move(file)) {}
  [[nodiscard]] Status add_channels(std::size_t lidars);
  void add(std::size_t topic, SensorTime stamp, HostTime arrival, std::vector<std::byte> payload);
  void add_picture(Topic topic, const RecordedFrame& frame, std::string_view format,
                   const std::vector<std::byte>& encoded);

  io::McapWriter file_;
  std::vector<io::McapChannelId> channels_;  ///< by topic; kMorePoints: of unit 1, then 2, ...
  std::vector<std::uint32_t> sequences_;
  std::vector<Pending> pending_;
};

}  // namespace edgesplat::simulate
