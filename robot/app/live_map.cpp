// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/live_map.hpp"

#include "common/log/log.hpp"

#include <utility>

namespace edgesplat::app {
namespace {

using local_mapping::LocalMapper;
using local_mapping::Pace;

constexpr nanoseconds kSettleTime = std::chrono::seconds(10);

}  // namespace

Result<std::unique_ptr<LiveMap>> LiveMap::create(const robot_config::RobotConfig& config, bool lockstep,
                                                 const Clock& clock,
                                                 const std::filesystem::path& robot_folder,
                                                 metrics::Registry& metrics) {
  std::unique_ptr<LiveMap> map(new LiveMap);
  if (config.local.enabled) {
    const auto on_map = [drawn = &map->drawn_](std::shared_ptr<const gaussian::GaussianCloud> in_odom) {
      drawn->set_provisional(std::move(in_odom));
    };
    EDGESPLAT_TRY(map->local_,
                  LocalMapper::create(config.local, config.uplink.robot,
                                      lockstep ? Pace::kInline : Pace::kOwnThread, on_map, clock, metrics));
  }
  if (!config.server.enabled) {
    if (map->local_) map->local_->set_work(true, false);
    return map;
  }
  MapShareParties parties;
  parties.local = map->local_.get();
  parties.on_resident = [self = map.get()](ResidentNews news) { self->on_resident(std::move(news)); };
  EDGESPLAT_TRY(map->share_, MapShare::create(config, clock, robot_folder, std::move(parties)));
  return map;
}

void LiveMap::on_resident(ResidentNews news) {
  drawn_.set_resident(news.in_map, news.map_from_odom);
  if (!local_) return;
  local_->set_resident(
      local_mapping::moved(std::move(news.in_map), news.map_from_odom.map_from_odom.inverse()));
  local_->retire(std::move(news.mapped_keyframes));
}

void LiveMap::submit(std::shared_ptr<const map::Keyframe> keyframe) {
  if (share_) {
    share_->submit(std::move(keyframe));
  } else if (local_) {
    local_->submit(std::move(keyframe));
  }
}

void LiveMap::on_picture(double render_ms) {
  if (share_) share_->on_picture(render_ms);
}

std::shared_ptr<const gaussian::GaussianCloud> LiveMap::newest_snapshot() {
  if (share_) share_->publish_newest();
  if (local_ && !local_->settle(kSettleTime))
    EDGESPLAT_LOG_WARN("local", "the newest keyframes are not in the map");
  return drawn_.snapshot();
}

geometry::RigidTransform LiveMap::map_from_odom() const {
  return share_ ? share_->map_from_odom().map_from_odom : geometry::RigidTransform::identity();
}

bool LiveMap::drain(nanoseconds timeout) {
  return !share_ || share_->drain(timeout);
}

void LiveMap::publish_counters(metrics::Registry& metrics) const {
  if (share_) share_->publish_counters(metrics);
  if (local_) local_->publish_counters(metrics);
}

}  // namespace edgesplat::app
