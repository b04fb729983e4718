// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/map_share.hpp"

#include "common/link/dds_transport.hpp"
#include "common/link/link_metrics.hpp"
#include "common/log/log.hpp"

#include <utility>

namespace edgesplat::app {

Result<std::unique_ptr<MapShare>> MapShare::create(const robot_config::RobotConfig& config,
                                                   const Clock& clock) {
  EDGESPLAT_TRY(const std::shared_ptr<link::DdsDomain> domain, link::DdsDomain::open(config.server.link));
  link::DdsTransportOptions options;
  options.role = link::Role::kRobot;
  options.robot = config.uplink.robot;
  EDGESPLAT_TRY(std::unique_ptr<link::Transport> transport, link::open_dds_transport(domain, options, clock));
  return std::make_unique<MapShare>(config, std::move(transport), clock);
}

MapShare::MapShare(const robot_config::RobotConfig& config, std::unique_ptr<link::Transport> transport,
                   const Clock& clock)
    : clock_(clock), transport_(std::move(transport)), resident_(config.map) {
  uplink::DownlinkHandlers handlers;
  handlers.on_delta = [this](std::span<const std::byte> delta) {
    resident_.apply(delta, clock_.now());
    send_requests();
  };
  handlers.on_heartbeat = [this](const link::Heartbeat& heartbeat) {
    on_heartbeat(heartbeat);
    send_requests();
  };
  handlers.on_idle = [this] {
    resident_.publish_if_due(clock_.now());
    send_requests();
  };
  downlink_ = std::make_unique<uplink::Downlink>(*transport_, std::move(handlers));
  uplink_ = std::make_unique<uplink::Uplink>(config.uplink, *transport_, clock_);
}

MapShare::~MapShare() = default;

void MapShare::send_requests() {
  for (const map::MapRequest& request : resident_.requests(clock_.now()))
    (void)transport_->send(link::Lane::kRequest, request.robot, map::encode_map_request(request));
}

void MapShare::submit(std::shared_ptr<const map::Keyframe> keyframe) {
  resident_.robot_at(keyframe->odom_from_body.translation_m.cast<float>());
  (void)uplink_->submit(std::move(keyframe));
}

void MapShare::on_heartbeat(const link::Heartbeat& heartbeat) {
  const bool idle = heartbeat.queued_messages == 0;
  resident_.server_at({heartbeat.epoch, heartbeat.seq}, heartbeat.map_hash, idle, clock_.now());
  const map::MapPosition here = resident_.position();
  const bool agrees = idle && heartbeat.epoch == here.epoch && heartbeat.seq == here.seq;
  const std::lock_guard lock(agreement_mutex_);
  agreeing_heartbeats_ = agrees ? agreeing_heartbeats_ + 1 : 0;
  agreement_changed_.notify_all();
}

bool MapShare::drain(nanoseconds timeout) {
  const HostTime start = clock_.now();
  if (!uplink_->drain(timeout)) return false;
  const nanoseconds left = timeout - (clock_.now() - start);
  std::unique_lock lock(agreement_mutex_);
  agreeing_heartbeats_ = 0;
  // The first heartbeat may have been on its way before the last keyframe came in: the second one counts.
  return agreement_changed_.wait_for(lock, left, [this] { return agreeing_heartbeats_ >= 2; });
}

std::shared_ptr<const gaussian::GaussianCloud> MapShare::newest_snapshot() {
  resident_.publish_if_due(clock_.now() + std::chrono::hours(1));  // due whatever the pace
  return resident_.snapshot();
}

void MapShare::publish_counters(metrics::Registry& metrics) const {
  const uplink::UplinkCounters up = uplink_->counters();
  metrics.counter("uplink.submitted").add(up.submitted);
  metrics.counter("uplink.dropped").add(up.dropped);
  metrics.counter("uplink.refused").add(up.refused);
  metrics.counter("uplink.encoded_bytes").add(up.encoded_bytes);
  const map::ResidentMapCounters resident = resident_.counters();
  metrics.counter("map.deltas_applied").add(resident.applied);
  metrics.counter("map.deltas_duplicate").add(resident.duplicates);
  metrics.counter("map.deltas_held").add(resident.held);
  metrics.counter("map.deltas_corrupt").add(resident.corrupt);
  metrics.counter("map.resets").add(resident.resets);
  metrics.counter("map.resends_asked").add(resident.resends_asked);
  metrics.counter("map.snapshots_asked").add(resident.snapshots_asked);
  metrics.counter("map.hash_agreed").add(resident.hash_agreed);
  metrics.counter("map.hash_disagreed").add(resident.hash_disagreed);
  metrics.counter("map.evicted_chunks").add(resident.evicted_chunks);
  metrics.gauge("map.absent_chunks").set(static_cast<double>(resident.absent_chunks));
  metrics.gauge("map.gaussians").set(static_cast<double>(resident.gaussians));
  metrics.gauge("map.resident_bytes").set(static_cast<double>(resident.resident_bytes));
  std::uint64_t bytes_up = 0;
  std::uint64_t bytes_down = 0;
  const link::LinkCounters lanes = transport_->counters();
  link::record(metrics, *transport_);
  for (const link::Lane lane : link::kLanes) {
    const link::LaneCounters& counters = lanes[static_cast<std::size_t>(lane)];
    bytes_up += counters.bytes_sent;
    bytes_down += counters.bytes_received;
  }
  metrics.counter("link.bytes_up").add(bytes_up);
  metrics.counter("link.bytes_down").add(bytes_down);
}

}  // namespace edgesplat::app
