// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/mcap_writer.hpp"
#include "common/io/ros_messages.hpp"
#include "common/thread/bounded_queue.hpp"
#include "robot/drivers/frame_socket/frame_assembler.hpp"
#include "robot/drivers/livox/livox_transport.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace edgesplat::replay {

struct RecorderConfig {
  std::size_t queue_items = 16'384;                  ///< 6 s of a Mid-360
  std::size_t queue_bytes = std::size_t{96} << 20U;  ///< what waits for the disk at most
  nanoseconds chunk_span{
      400'000'000};  ///< what a killed program loses at most: this and what waits to be written
  nanoseconds sync_period{1'000'000'000};  ///< what a power cut loses at most besides; 0 = left to the system
  std::uint64_t min_free_bytes = std::uint64_t{512} << 20U;  ///< less left on the disk ends the recording
  /// Of the datagrams of each LiDAR, by unit; noted in the file.
  std::vector<livox::Protocol> lidar_protocols = {livox::Protocol::kSdk2};
};

struct RecorderCounters {
  std::uint64_t written = 0;  ///< datagrams and pictures that reached the file
  std::uint64_t dropped = 0;  ///< the disk was too slow: the queue was full
  std::uint64_t failed = 0;   ///< lost to a write error (disk full)
};

/// Writes what the sensors send, byte for byte and with its arrival, to a recording that ReplaySource reads
/// back. What came is in the file after chunk_span, also when nothing more comes, so that a killed program
/// loses less than a second (io::recover_mcap() makes its file whole); a disk that gets full ends the
/// recording, whole, before it is. on_*() may be called from any thread and never wait; one thread calls
/// write_next() until it gives false. Each datagram costs one copy.
class Recorder {
 public:
  /// Creates the file with the attachments rig.toml and robot.toml. kIo.
  static Result<std::unique_ptr<Recorder>> create(const std::filesystem::path& path,
                                                  std::string_view rig_toml, std::string_view robot_toml,
                                                  const RecorderConfig& config = {});

  /// `unit`: the LiDAR it came from; each has topics of its own. Precondition: there is a protocol for it.
  void on_datagram(const livox::Datagram& datagram, std::size_t unit = 0);
  /// `handed_on`: when the robot's own chain gets the picture, which is after a camera's resends; a replay
  /// hands it on among the same points, so that it finds the same groups.
  void on_frame(const frame_socket::EncodedFrame& frame, HostTime arrival, HostTime handed_on);

  /// Waits for something to write, not longer than chunk_span, and writes it. False when `stop` is requested,
  /// or finish() was called, and everything is written. A write error, or too little room left, is returned
  /// once; later messages are counted as failed.
  [[nodiscard]] Result<bool> write_next(const std::stop_token& stop);
  /// Writes what waits and the file's summary. Call it after the writing thread has ended.
  [[nodiscard]] Status finish();
  [[nodiscard]] RecorderCounters counters() const;

 private:
  struct QueuedDatagram {
    std::size_t unit;
    livox::Channel channel;
    HostTime arrival;
    std::vector<std::byte> bytes;
  };
  struct QueuedFrame {
    HostTime arrival;
    HostTime handed_on;
    frame_socket::EncodedFrame frame;
  };
  using Item = std::variant<QueuedDatagram, QueuedFrame>;
  /// Of the camera; then kOfLidar for each LiDAR: points, IMU, control.
  enum Topic : std::size_t { kMeta, kImage, kFirstOfLidars };
  static constexpr std::size_t kOfLidar = 3;

  Recorder(io::McapWriter writer, std::filesystem::path path, const RecorderConfig& config);
  [[nodiscard]] Status add_channels();
  [[nodiscard]] Status add_channel(const std::string& name, const io::RosSchema& schema,
                                   std::map<std::string, std::string> metadata);
  /// Once a sync_period: to the disk, and whether there is room for more.
  [[nodiscard]] Status look_after_disk(HostTime newest);
  [[nodiscard]] Status write(const Item& item);
  [[nodiscard]] Status write(const QueuedDatagram& datagram);
  [[nodiscard]] Status write(const QueuedFrame& frame);
  [[nodiscard]] Status write(std::size_t topic, HostTime arrival, SensorTime stamp,
                             std::span<const std::byte> payload);

  RecorderConfig config_;
  std::filesystem::path path_;
  io::McapWriter writer_;
  bool is_stopped_ = false;  ///< for lack of room
  HostTime newest_{};        ///< arrival of what was written last
  HostTime next_look_{};     ///< after the disk
  bool has_unflushed_ = false;
  thread::BoundedQueue<Item> queue_;
  std::vector<io::McapChannelId> channels_;  ///< by topic
  std::vector<std::uint32_t> sequences_;
  std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> failed_{0};
};

}  // namespace edgesplat::replay
