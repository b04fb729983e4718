// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/clock.hpp"
#include "kernels/mapping/id_allocator.hpp"
#include "server/config/server_config.hpp"
#include "server/ingest/ingest.hpp"
#include "server/optimise/map_builder.hpp"
#include "server/stream/delta_stream.hpp"

#include <map>
#include <mutex>
#include <vector>

namespace edgesplat::app {

/// Where one robot's map stands.
struct MapStatus {
  map::RobotId robot;
  map::Epoch epoch;
  std::uint64_t seq = 0;
  std::uint64_t map_hash = 0;
  std::size_t gaussians = 0;
};

/// Keyframe in, encoded deltas out: the map and the stream of each robot. handle() on one thread; status()
/// from any. Counts map.keyframes, map.gaussians, map.deltas, map.delta_bytes and the histogram
/// map.keyframe_ms.
class MappingStage {
 public:
  MappingStage(const config::ServerConfig& config, map::Epoch epoch, metrics::Registry& registry,
               const Clock& clock);

  std::vector<std::vector<std::byte>> handle(const ingest::IngestedKeyframe& keyframe);
  [[nodiscard]] std::vector<MapStatus> status() const;

 private:
  struct RobotMap {
    std::uint64_t session;
    optimise::MapBuilder builder;
    stream::DeltaStream stream;
  };
  RobotMap& map_of(const ingest::IngestedKeyframe& keyframe);
  void publish_status(map::RobotId robot, const RobotMap& map);

  const config::ServerConfig& config_;
  const map::Epoch epoch_;
  const Clock& clock_;
  mapping::IdAllocator ids_;
  std::map<map::RobotId, RobotMap> maps_;
  metrics::Counter& keyframes_;
  metrics::Counter& gaussians_;
  metrics::Counter& deltas_;
  metrics::Counter& delta_bytes_;
  metrics::Histogram& keyframe_ms_;
  mutable std::mutex status_mutex_;
  std::map<map::RobotId, MapStatus> status_;
};

}  // namespace edgesplat::app
