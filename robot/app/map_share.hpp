// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/transport.hpp"
#include "common/metrics/registry.hpp"
#include "common/time/clock.hpp"
#include "robot/app/offload_loop.hpp"
#include "robot/config/robot_config.hpp"
#include "robot/map/resident_map.hpp"
#include "robot/offload/offload_control.hpp"
#include "robot/uplink/downlink.hpp"
#include "robot/uplink/uplink.hpp"

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace edgesplat::app {

/// What the server made, as it is held here.
struct ResidentNews {
  std::shared_ptr<const gaussian::GaussianCloud> in_map;
  map::MapFromOdom map_from_odom;
  std::vector<std::uint32_t> mapped_keyframes =
      {};  ///< since the last news; what came of them is in `in_map`
};

/// Who else on the robot is concerned with the shared map; all must outlive it.
struct MapShareParties {
  offload::LocalMapping* local = nullptr;  ///< the robot's own mapping, for LOCAL; null: none
  /// Told whenever there is something new; on one thread at a time. May be empty.
  std::function<void(ResidentNews)> on_resident = {};
};

/// The robot's side of the shared map: keyframes go up as the offloading decision says, deltas come down into
/// the resident map. Nothing here makes a caller wait for the server. Thread-safe.
class MapShare {
 public:
  /// kUnavailable, kIo where the transport cannot be opened (wrong interface, ...).
  /// `robot_folder`: of the run, for the timeline of modes and the spool; empty: neither is written.
  static Result<std::unique_ptr<MapShare>> create(const robot_config::RobotConfig& config, const Clock& clock,
                                                  const std::filesystem::path& robot_folder = {},
                                                  MapShareParties parties = {});
  /// Over a transport of the caller's, for tests.
  MapShare(const robot_config::RobotConfig& config, std::unique_ptr<link::Transport> transport,
           const Clock& clock, const std::filesystem::path& robot_folder = {}, MapShareParties parties = {});
  ~MapShare();
  MapShare(const MapShare&) = delete;
  MapShare& operator=(const MapShare&) = delete;

  void submit(std::shared_ptr<const map::Keyframe> keyframe);
  /// A picture took so long to draw.
  void on_picture(double render_ms) { control_->on_picture(render_ms); }
  [[nodiscard]] policy::Mode mode() const { return control_->last().decision.mode; }
  /// Tells on_resident everything that was applied, whatever the publishing pace.
  void publish_newest();
  [[nodiscard]] map::MapFromOdom map_from_odom() const { return resident_.map_from_odom(); }
  [[nodiscard]] map::ResidentMapCounters map_counters() const { return resident_.counters(); }

  /// At the end of a run: waits until the server has every keyframe, has nothing queued and everything it
  /// made is applied here, up to `timeout` in all. False when time ran out first.
  bool drain(nanoseconds timeout);
  void publish_counters(metrics::Registry& metrics) const;

 private:
  void on_heartbeat(const link::Heartbeat& heartbeat);
  void send_requests();
  void tell_resident();
  [[nodiscard]] link::Heartbeat heartbeat() const;

  const Clock& clock_;
  std::unique_ptr<link::Transport> transport_;
  map::ResidentMap resident_;
  const MapShareParties parties_;
  std::mutex told_mutex_;
  std::shared_ptr<const gaussian::GaussianCloud> told_;  ///< to on_resident
  std::mutex agreement_mutex_;
  std::condition_variable agreement_changed_;
  int agreeing_heartbeats_ = 0;  ///< in a row that say: nothing queued, and all that was made is applied here
  std::unique_ptr<offload::OffloadControl> control_;
  std::unique_ptr<uplink::Downlink> downlink_;
  std::unique_ptr<uplink::Uplink> uplink_;
  std::unique_ptr<OffloadLoop> offload_;
};

}  // namespace edgesplat::app
