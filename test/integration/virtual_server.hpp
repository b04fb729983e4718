// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/heartbeat.hpp"
#include "common/link/transport.hpp"
#include "server/app/mapping_stage.hpp"
#include "server/store/map_folder.hpp"
#include "server/stream/epoch_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

namespace edgesplat::test {

/// What the server's program does from its start on, on one thread in virtual time. Destroyed, it leaves what
/// a killed program leaves: the files.
class VirtualServer {
 public:
  VirtualServer(const config::ServerConfig& config, const std::filesystem::path& folder,
                link::Transport& transport, const Clock& clock)
      : config_(config),
        folder_(folder),
        transport_(transport),
        clock_(clock),
        ingest_(registry_, config.max_robots),
        stage_(
            config_, start(), [this](map::RobotId robot) { return room(robot); }, registry_, clock) {}

  void step() {
    while (const auto message = transport_.receive(nanoseconds(0))) take(*message);
    const HostTime now = clock_.now();
    if (due(next_work_, 0.05)) send(stage_.work());
    if (due(next_heartbeat_, config_.heartbeat_period_s)) send_heartbeats();
    if (now - last_save_ < from_seconds(config_.store.save_period_s)) return;
    last_save_ = now;
    for (const store::StoredMap& map : stage_.changed_maps())
      ASSERT_TRUE(store::save_map(store::map_path(folder_, map.robot, map.map), map));
  }
  /// The file of a save that the kill cut short, so many bytes long.
  void leave_half_a_save(std::size_t bytes) {
    for (const store::StoredMap& map : stage_.all_maps()) {
      std::vector<std::byte> all;
      ASSERT_TRUE(store::write_map(map, {}, [&all](std::span<const std::byte> part) {
        all.insert(all.end(), part.begin(), part.end());
        return Status{};
      }));
      all.resize(std::min(all.size(), bytes));
      const auto path = store::map_path(folder_, map.robot, map.map).string() + ".tmp1-1";
      std::ofstream(path, std::ios::binary)
          .write(reinterpret_cast<const char*>(all.data()), static_cast<std::streamsize>(all.size()));
    }
  }

  /// Of the one robot; nothing before its map is begun.
  [[nodiscard]] std::optional<app::MapStatus> status() const {
    const auto all = stage_.status();
    return all.empty() ? std::nullopt : std::optional(all[0]);
  }
  /// In its map, whether or not the robot has them yet.
  [[nodiscard]] std::size_t gaussians() {
    return registry_.counter("map.gaussians").value() + registry_.counter("map.restored_gaussians").value();
  }
  [[nodiscard]] map::Epoch epoch() const { return epoch_; }
  /// What the robot holds after delta `seq`, where that was noted.
  [[nodiscard]] std::optional<std::uint64_t> hash_at(std::uint64_t seq) const {
    const auto found = hash_at_.find(seq);
    return found == hash_at_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  app::Start start() {
    app::Start start;
    auto found = store::load_newest_maps(folder_, config_.max_robots);
    EXPECT_TRUE(found && found->refused.empty());
    for (auto& loaded : found->maps) {
      EXPECT_TRUE(loaded.report.whole());
      start.maps.push_back(std::move(loaded.map));
    }
    const auto epoch = stream::next_epoch(folder_ / "epoch");
    EXPECT_TRUE(epoch);
    start.epoch = epoch_ = *epoch;
    return start;
  }
  [[nodiscard]] std::size_t room(map::RobotId robot) const {
    constexpr std::size_t kMost_bytes = 65536;  // as in server/app
    return kMost_bytes - std::min(kMost_bytes, transport_.waiting_bytes(link::Lane::kDelta, robot));
  }
  [[nodiscard]] bool due(HostTime& next, double period_s) const {
    if (clock_.now() < next) return false;
    next = clock_.now() + from_seconds(period_s);
    return true;
  }
  void take(const link::Message& message) {
    if (message.lane == link::Lane::kRequest) {
      send(stage_.answer(message));
    } else if (message.lane == link::Lane::kHeartbeat) {
      stage_.take_heartbeat(message);
    } else if (const auto keyframe = ingest_.take(message, clock_.now())) {
      send(stage_.handle(*keyframe));
    }
  }
  void send(std::vector<app::OutgoingDelta> deltas) {
    for (auto& delta : deltas) (void)transport_.send(link::Lane::kDelta, delta.robot, std::move(delta.bytes));
    if (const auto at = status()) hash_at_[at->seq] = at->map_hash;
  }
  void send_heartbeats() {
    const auto down = transport_.counters()[link::index_of(link::Lane::kDelta)];
    const auto at = status();
    if (!at) return;
    link::Heartbeat heartbeat;
    heartbeat.epoch = at->epoch;
    heartbeat.seq = at->seq;
    heartbeat.map_hash = at->map_hash;
    heartbeat.queued_messages = static_cast<std::uint32_t>(down.queued_messages + down.flying_messages);
    (void)transport_.send(link::Lane::kHeartbeat, at->robot, link::encode_heartbeat(heartbeat));
  }

  const config::ServerConfig config_;
  const std::filesystem::path folder_;
  link::Transport& transport_;
  const Clock& clock_;
  metrics::Registry registry_;
  map::Epoch epoch_;
  ingest::Ingest ingest_;
  app::MappingStage stage_;
  std::map<std::uint64_t, std::uint64_t> hash_at_;
  HostTime next_work_{};
  HostTime next_heartbeat_{};
  HostTime last_save_{};
};

}  // namespace edgesplat::test
