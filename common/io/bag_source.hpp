// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/time/time.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::io {

/// How the fields of a ROS message lie in its bytes.
enum class RosEncoding : std::uint8_t {
  kRos1,  ///< one after the other, little-endian, without padding
  kCdr,   ///< ROS 2: behind 4 bytes, each aligned to its size
};

struct BagTopic {
  std::string name;
  std::string type;  ///< "sensor_msgs/Imu", without ROS 2's "/msg"
  RosEncoding encoding = RosEncoding::kRos1;
};

/// One message. `payload` is borrowed from the source, valid until its next call.
struct BagMessage {
  std::size_t topic = 0;  ///< index in topics()
  HostTime time{};        ///< when it was recorded
  std::span<const std::byte> payload;
};

/// What reading found. `why` is empty exactly when `complete`.
struct BagReport {
  bool complete = true;
  std::uint64_t messages_read = 0;  ///< handed out by next() since the last select()
  std::uint64_t bytes_skipped = 0;  ///< bytes of the file that could not be used
  std::string why;
};

/// A recording of ROS, whatever its file format: messages in the order of their times, damage skipped and
/// told. Single-owner.
class BagSource {
 public:
  virtual ~BagSource() = default;
  [[nodiscard]] virtual const std::vector<BagTopic>& topics() const = 0;
  /// Of the first and of the last message; both 0 where there is none.
  [[nodiscard]] virtual HostTime begin() const = 0;
  [[nodiscard]] virtual HostTime end() const = 0;
  /// Starts over with these topics alone (indices); without a call next() gives all.
  virtual void select(std::vector<std::size_t> topics) = 0;
  /// The next message, or nothing at the end.
  [[nodiscard]] virtual std::optional<BagMessage> next() = 0;
  [[nodiscard]] virtual BagReport report() const = 0;
};

/// Opens a recording of ROS without ROS: a ROS 1 .bag (format 2.0), a ROS 2 .mcap or .db3 (or .db3.zstd), or
/// a folder of such files, which are joined in time. kNotFound, kIo, kCorrupt; kInvalidArgument for anything
/// else.
[[nodiscard]] Result<std::unique_ptr<BagSource>> open_bag(const std::filesystem::path& path);
/// The path's name ends as one that open_bag() takes, or it is a folder that holds such a file.
[[nodiscard]] bool is_bag(const std::filesystem::path& path);

/// "sensor_msgs/msg/Imu" -> "sensor_msgs/Imu".
[[nodiscard]] std::string ros_type_name(std::string_view type);

}  // namespace edgesplat::io
