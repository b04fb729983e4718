// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/map_share.hpp"

#include "common/link/dds_transport.hpp"
#include "common/link/link_metrics.hpp"
#include "common/log/log.hpp"
#include "robot/offload/memory_pressure.hpp"

#include <utility>

namespace edgesplat::app {

Result<std::unique_ptr<MapShare>> MapShare::create(const robot_config::RobotConfig& config,
                                                   const Clock& clock,
                                                   const std::filesystem::path& robot_folder,
                                                   MapShareParties parties) {
  EDGESPLAT_TRY(const std::shared_ptr<link::DdsDomain> domain, link::DdsDomain::open(config.server.link));
  link::DdsTransportOptions options;
  options.role = link::Role::kRobot;
  options.robot = config.uplink.robot;
  EDGESPLAT_TRY(std::unique_ptr<link::Transport> transport, link::open_dds_transport(domain, options, clock));
  return std::make_unique<MapShare>(config, std::move(transport), clock, robot_folder, std::move(parties));
}

MapShare::MapShare(const robot_config::RobotConfig& config, std::unique_ptr<link::Transport> transport,
                   const Clock& clock, const std::filesystem::path& robot_folder, MapShareParties parties)
    : clock_(clock), transport_(std::move(transport)), resident_(config.map), parties_(std::move(parties)) {
  offload::OffloadSources sources;
  sources.link = [this, robot = config.uplink.robot] { return transport_->quality(robot); };
  sources.counters = [this] { return transport_->counters(); };
  sources.memory_bytes = [settings = config.offload] {
    return offload::measured_memory_pressure_bytes(
        settings.memory_reserve_bytes, static_cast<std::uint64_t>(settings.policy.memory_threshold_bytes));
  };
  control_ = std::make_unique<offload::OffloadControl>(config.offload.policy, std::move(sources), clock_);
  uplink::DownlinkHandlers handlers;
  handlers.on_delta = [this](std::span<const std::byte> delta) {
    resident_.apply(delta, clock_.now());
    tell_resident();
    send_requests();
  };
  handlers.on_heartbeat = [this](const link::Heartbeat& heartbeat) {
    on_heartbeat(heartbeat);
    send_requests();
  };
  handlers.on_idle = [this] {
    resident_.publish_if_due(clock_.now());
    tell_resident();
    send_requests();
  };
  downlink_ = std::make_unique<uplink::Downlink>(*transport_, std::move(handlers));
  uplink::UplinkConfig uplink_config = config.uplink;
  if (!robot_folder.empty()) uplink_config.spool.folder = robot_folder / "spool";
  uplink_ =
      std::make_unique<uplink::Uplink>(uplink_config, *transport_, clock_, [this] { return heartbeat(); });
  offload_ = std::make_unique<OffloadLoop>(*control_, OffloadTargets{*transport_, *uplink_, parties_.local},
                                           config.offload.policy.evaluation_period_s,
                                           robot_folder.empty() ? robot_folder : robot_folder / "modes.jsonl",
                                           clock_);
}

MapShare::~MapShare() = default;

link::Heartbeat MapShare::heartbeat() const {
  const offload::OffloadRecord record = control_->last();
  const map::MapPosition here = resident_.position();
  link::Heartbeat heartbeat;
  heartbeat.epoch = here.epoch;
  heartbeat.seq = here.seq;
  heartbeat.map_hash = resident_.map_hash();
  heartbeat.mode = offload::to_link(record.decision.mode);
  heartbeat.render_p95_ms = static_cast<float>(record.situation.render_p95_ms.value_or(0.0));
  heartbeat.memory_bytes = static_cast<std::uint64_t>(record.situation.memory_peak_bytes.value_or(0.0));
  heartbeat.goodput_bytes_per_s = static_cast<float>(record.situation.bandwidth_bytes_per_s.value_or(0.0));
  return heartbeat;
}

void MapShare::send_requests() {
  for (const map::MapRequest& request : resident_.requests(clock_.now()))
    (void)transport_->send(link::Lane::kRequest, request.robot, map::encode_map_request(request));
}

void MapShare::submit(std::shared_ptr<const map::Keyframe> keyframe) {
  resident_.robot_at(keyframe->odom_from_body.translation_m.cast<float>());
  offload_->submit(keyframe);
  (void)uplink_->submit(std::move(keyframe));
}

void MapShare::on_heartbeat(const link::Heartbeat& heartbeat) {
  const bool idle = heartbeat.queued_messages == 0;
  const bool has_map = heartbeat.epoch.value != 0;
  if (has_map) resident_.server_at({heartbeat.epoch, heartbeat.seq}, heartbeat.map_hash, idle, clock_.now());
  const map::MapPosition here = resident_.position();
  control_->on_server_heartbeat(!has_map || here.epoch == heartbeat.epoch);
  const bool agrees = idle && heartbeat.epoch == here.epoch && heartbeat.seq == here.seq;
  const std::lock_guard lock(agreement_mutex_);
  agreeing_heartbeats_ = agrees ? agreeing_heartbeats_ + 1 : 0;
  agreement_changed_.notify_all();
}

bool MapShare::drain(nanoseconds timeout) {
  if (!control_->last().offload_wanted) return true;  // nothing is meant to go to the server
  offload_->begin_draining();
  const HostTime start = clock_.now();
  if (!uplink_->drain(timeout)) return false;
  const nanoseconds left = timeout - (clock_.now() - start);
  std::unique_lock lock(agreement_mutex_);
  agreeing_heartbeats_ = 0;
  // The first heartbeat may have been on its way before the last keyframe came in: the second one counts.
  return agreement_changed_.wait_for(lock, left, [this] { return agreeing_heartbeats_ >= 2; });
}

void MapShare::publish_newest() {
  resident_.publish_now(clock_.now());
  tell_resident();
}

void MapShare::tell_resident() {
  if (!parties_.on_resident) return;
  const std::lock_guard lock(told_mutex_);
  auto mapped = resident_.take_mapped();  // before the snapshot, which has to have what came of them
  auto newest = resident_.snapshot();
  if (newest == told_ && mapped.empty()) return;
  told_ = newest;
  parties_.on_resident({std::move(newest), resident_.map_from_odom(), std::move(mapped)});
}

void MapShare::publish_counters(metrics::Registry& metrics) const {
  const uplink::UplinkCounters up = uplink_->counters();
  metrics.counter("uplink.submitted").add(up.submitted);
  metrics.counter("uplink.dropped").add(up.dropped);
  metrics.counter("uplink.refused").add(up.refused);
  metrics.counter("uplink.kept_by_mode").add(up.kept_by_mode);
  metrics.counter("uplink.kept_by_budget").add(up.kept_by_budget);
  metrics.counter("spool.put").add(up.spool.put);
  metrics.counter("spool.sent").add(up.spool.taken);
  metrics.counter("spool.dropped").add(up.spool.dropped);
  metrics.counter("spool.disk_failures").add(up.spool.disk_failures);
  metrics.gauge("spool.left").set(static_cast<double>(up.spool.items));
  metrics.counter("offload.switches").add(offload_->switches());
  metrics.counter("uplink.encoded_bytes").add(up.encoded_bytes);
  const map::ResidentMapCounters resident = resident_.counters();
  metrics.counter("map.deltas_applied").add(resident.applied);
  metrics.counter("map.deltas_duplicate").add(resident.duplicates);
  metrics.counter("map.deltas_held").add(resident.held);
  metrics.counter("map.deltas_corrupt").add(resident.corrupt);
  metrics.counter("map.deltas_foreign").add(resident.foreign);
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
