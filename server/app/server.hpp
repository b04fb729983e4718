// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/transport.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "server/app/mapping_stage.hpp"

#include <atomic>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

namespace edgesplat::app {

/// The server's stages on their threads: receive, ingest and answer; map, optimise and stream. Borrows
/// everything it is given.
class Server {
 public:
  Server(const config::ServerConfig& config, Start start, link::Transport& transport,
         metrics::Registry& registry, const Clock& clock);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Tells every known robot where its map stands; to be called every heartbeat period.
  void send_heartbeats();
  /// Time since the last keyframe came, or since start.
  [[nodiscard]] nanoseconds idle() const;
  /// Since the slower of the two threads came round last; grows without end when one hangs.
  [[nodiscard]] nanoseconds without_progress() const;
  /// Maps what was received, sends what was made (waiting up to `patience` for the robots) and ends the
  /// threads.
  void finish(nanoseconds patience);
  [[nodiscard]] std::vector<MapStatus> status() const { return stage_.status(); }
  /// After finish(): the maps as they were seeded, where the configuration keeps them.
  [[nodiscard]] std::vector<const gaussian::GaussianCloud*> seeds() const { return stage_.seeds(); }

 private:
  bool receive_step(const std::stop_token& stop);
  void hear(map::RobotId robot);
  void take_keyframe(link::Message message);
  bool map_step();
  [[nodiscard]] std::size_t delta_room(map::RobotId robot) const;
  void save_if_due();
  void send(std::vector<OutgoingDelta> deltas);
  void send_heartbeat(const MapStatus& status, const link::LaneCounters& down);

  const config::ServerConfig& config_;
  link::Transport& transport_;
  const Clock& clock_;
  store::Recorder* const recorder_;
  ingest::Ingest ingest_;
  MappingStage stage_;
  metrics::Histogram& keyframe_to_delta_ms_;
  metrics::Counter& deltas_refused_;
  std::atomic<std::int64_t> last_keyframe_ns_;
  std::atomic<std::int64_t> received_round_ns_;  ///< when the thread came round last
  std::atomic<std::int64_t> mapped_round_ns_;    ///< the same
  HostTime last_save_;                           ///< of the mapping thread
  std::mutex heard_mutex_;
  std::set<map::RobotId> heard_;  ///< robots that are there, perhaps without a map; at most max_robots
  thread::BoundedQueue<ingest::IngestedKeyframe> queue_;
  std::optional<thread::Worker> receiver_;
  std::optional<thread::Worker> mapper_;
};

}  // namespace edgesplat::app
