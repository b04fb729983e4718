// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/metrics/registry.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "common/time/clock.hpp"
#include "server/store/keyframe_log.hpp"
#include "server/store/map_file.hpp"

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace edgesplat::store {

struct RecorderConfig {
  std::filesystem::path folder;
  KeyframeLogConfig log;
  std::size_t queue_keyframes = 64;                  ///< that wait for the disk, >= 1
  std::size_t queue_bytes = std::size_t{64} << 20U;  ///< the same
};

/// Writes keyframes and maps on a thread of its own, so that nobody waits for the disk. What the queue has no
/// room for and what the disk refuses is counted, said once until it goes well again, and left out.
/// Thread-safe but for finish(). Counts store.keyframes, .keyframe_bytes, .keyframes_dropped (no room),
/// .keyframes_failed (the disk), store.maps, .maps_failed and the histograms store.append_ms, store.save_ms.
class Recorder {
 public:
  /// `registry` and `clock` must outlive this. The log is opened by the thread: a long one takes its time.
  Recorder(const RecorderConfig& config, metrics::Registry& registry, const Clock& clock);
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  ~Recorder();

  /// Never waits.
  void keyframe(LoggedKeyframe keyframe);
  /// Maps were handed over and are not all written yet: another one would only wait.
  [[nodiscard]] bool saving() const { return maps_waiting_ > 0; }
  /// Never waits; goes to map_path(). False, and counted, where nothing has room for it.
  bool map(StoredMap map);
  /// Writes what waits, then these; ends the thread. Can be called more than once.
  void finish(const std::vector<StoredMap>& last = {});
  /// After finish(): the disk's reason where at last it did not take keyframes or maps.
  [[nodiscard]] Status outcome() const;

 private:
  using Job = std::variant<LoggedKeyframe, StoredMap>;
  /// What fails again and again is said once.
  struct Trouble {
    metrics::Counter& failed;
    Status last = {};  ///< what it said last time
    void note(const Status& status, const char* what);
  };
  bool step(const std::stop_token& stop);
  void open_log();
  Status append(const LoggedKeyframe& keyframe);
  void save(const StoredMap& map);

  const RecorderConfig config_;
  const Clock& clock_;
  std::optional<KeyframeLog> log_;  ///< of the thread
  Status log_opened_;
  metrics::Counter& keyframes_;
  metrics::Counter& keyframe_bytes_;
  metrics::Counter& keyframes_dropped_;
  metrics::Counter& maps_;
  metrics::Histogram& append_ms_;
  metrics::Histogram& save_ms_;
  Trouble keyframe_trouble_;
  Trouble map_trouble_;
  std::atomic<std::size_t> maps_waiting_{0};
  thread::BoundedQueue<Job> queue_;
  std::optional<thread::Worker> writer_;
};

}  // namespace edgesplat::store
