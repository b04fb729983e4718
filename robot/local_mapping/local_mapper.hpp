// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/metrics/registry.hpp"
#include "common/thread/worker.hpp"
#include "robot/local_mapping/inbox.hpp"
#include "robot/local_mapping/local_map.hpp"
#include "robot/offload/local_mapping.hpp"

#include <tbb/task_arena.h>

#include <functional>
#include <memory>
#include <mutex>
#include <optional>

namespace edgesplat::local_mapping {

enum class Pace : std::uint8_t {
  kOwnThread,  ///< within the configured share of a core; no call waits
  kInline,     ///< for lockstep runs: a call does what it asks for, with a fixed number of steps a keyframe
};

/// The robot's own mapping on one thread of low priority and one core: keyframes and orders in, its Gaussians
/// out, at a bounded pace. Every call but settle() returns at once. Thread-safe. Counts local.keyframes,
/// .dropped, .bad_pictures, .steps, .pruned, .retired, .dropped_views, .published; gauges local.gaussians,
/// .views; histograms local.step_ms, .keyframe_ms.
class LocalMapper : public offload::LocalMapping {
 public:
  /// Given the robot's Gaussians in `odom` whenever they changed; on the mapper's thread.
  using Listener = std::function<void(std::shared_ptr<const gaussian::GaussianCloud>)>;

  /// kInvalidConfig where the budget is too small. Begins outside LOCAL. `clock` and `registry` must outlive
  /// the mapper.
  static Result<std::unique_ptr<LocalMapper>> create(const LocalMappingConfig& config, map::RobotId robot,
                                                     Pace pace, Listener on_map, const Clock& clock,
                                                     metrics::Registry& registry);
  ~LocalMapper() override;
  LocalMapper(const LocalMapper&) = delete;
  LocalMapper& operator=(const LocalMapper&) = delete;

  void set_work(bool map_here, bool prune_and_compress) override;
  void submit(std::shared_ptr<const map::Keyframe> keyframe) override;
  /// What the server made, as far as it is held here.
  void set_resident(std::shared_ptr<const gaussian::GaussianCloud> in_odom);
  /// The server has mapped these keyframes, and what it made of them is in the last set_resident().
  void retire(std::vector<std::uint32_t> mapped_keyframes);
  /// For the end of a run: waits until all of the above is done and the listener has the newest map.
  bool settle(nanoseconds timeout);
  void publish_counters(metrics::Registry& metrics) const;

 private:
  LocalMapper(const LocalMappingConfig& config, LocalMap map, Pace pace, Listener on_map, const Clock& clock,
              metrics::Registry& registry);
  bool round(const std::stop_token& stop);
  void run_inline();
  [[nodiscard]] std::optional<nanoseconds> patience(HostTime now) const;
  // All with map_mutex_ held.
  void obey(const Inbox::Round& round);
  /// The round's keyframe, or a step where it has none.
  void work(const Inbox::Round& round);
  void publish_where_due(bool at_once);

  const LocalMappingConfig config_;
  const Pace pace_;
  const Listener on_map_;
  const Clock& clock_;
  metrics::Histogram& step_ms_;
  metrics::Histogram& keyframe_ms_;
  Inbox inbox_;
  tbb::task_arena arena_;
  mutable std::mutex map_mutex_;  ///< guards what follows
  LocalMap map_;
  HostTime rest_until_{};
  HostTime last_publish_{};
  std::uint64_t published_revision_ = 0;
  std::uint64_t published_ = 0;
  std::optional<thread::Worker> worker_;
};

}  // namespace edgesplat::local_mapping
