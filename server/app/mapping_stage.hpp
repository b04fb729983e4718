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
#include <memory>
#include <mutex>
#include <span>
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

/// Keyframe in, encoded deltas out: the map and the stream of each robot. handle() and pump() on one thread;
/// answer(), confirmed() and status() from any. Counts map.keyframes, map.gaussians, map.deltas,
/// map.delta_bytes and the histogram map.keyframe_ms.
class MappingStage {
 public:
  MappingStage(const config::ServerConfig& config, map::Epoch epoch, metrics::Registry& registry,
               const Clock& clock);

  std::vector<std::vector<std::byte>> handle(const ingest::IngestedKeyframe& keyframe);
  /// What a robot's stream still has to say, though no keyframe came.
  std::vector<std::vector<std::byte>> pump(map::RobotId robot);
  /// Takes a message of the request lane; what can be sent again at once is returned, pump() makes the rest.
  std::vector<std::vector<std::byte>> answer(const link::Message& message);
  [[nodiscard]] std::vector<MapStatus> status() const;

 private:
  struct RobotMap {
    std::uint64_t session;
    optimise::MapBuilder builder;
    std::shared_ptr<stream::DeltaStream> stream;
  };
  struct SharedStream {
    std::uint64_t session;
    std::shared_ptr<stream::DeltaStream> stream;
  };
  RobotMap& map_of(const ingest::IngestedKeyframe& keyframe);
  std::vector<std::vector<std::byte>> publish(RobotMap& robot, std::span<const std::uint32_t> changed_rows);

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
  metrics::Counter& requests_corrupt_;
  mutable std::mutex streams_mutex_;
  std::map<map::RobotId, SharedStream> streams_;
};

}  // namespace edgesplat::app
