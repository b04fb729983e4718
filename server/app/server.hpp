// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/transport.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "server/app/mapping_stage.hpp"

#include <atomic>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

namespace edgesplat::app {

/// The server's stages on their threads: receive and ingest; map and stream. Borrows everything it is given.
class Server {
 public:
  Server(const config::ServerConfig& config, map::Epoch epoch, link::Transport& transport,
         metrics::Registry& registry, const Clock& clock);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Tells every known robot where its map stands; to be called every heartbeat period.
  void send_heartbeats();
  /// Time since the last keyframe came, or since start.
  [[nodiscard]] nanoseconds idle() const;
  /// Maps what was received, sends what was made (waiting up to `patience` for the robots) and ends the
  /// threads.
  void finish(nanoseconds patience);
  [[nodiscard]] std::vector<MapStatus> status() const { return stage_.status(); }

 private:
  bool receive_step(const std::stop_token& stop);
  /// A keyframe to map, or a robot whose stream has something to say.
  using Job = std::variant<ingest::IngestedKeyframe, map::RobotId>;
  void do_job(const Job& job);
  void map_keyframe(const ingest::IngestedKeyframe& keyframe);
  void send(map::RobotId robot, std::vector<std::vector<std::byte>> deltas);

  const config::ServerConfig& config_;
  link::Transport& transport_;
  const Clock& clock_;
  ingest::Ingest ingest_;
  MappingStage stage_;
  metrics::Histogram& keyframe_to_delta_ms_;
  metrics::Counter& deltas_refused_;
  std::atomic<std::int64_t> last_keyframe_ns_;
  thread::BoundedQueue<Job> queue_;
  std::optional<thread::Worker> receiver_;
  std::optional<thread::Worker> mapper_;
};

}  // namespace edgesplat::app
