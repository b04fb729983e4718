// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/transport.hpp"
#include "common/time/clock.hpp"
#include "kernels/mapping/id_allocator.hpp"
#include "server/app/restored_maps.hpp"
#include "server/config/server_config.hpp"
#include "server/ingest/ingest.hpp"
#include "server/optimise/map_builder.hpp"
#include "server/store/recorder.hpp"
#include "server/stream/byte_allowance.hpp"
#include "server/stream/delta_stream.hpp"

#include <functional>
#include <map>
#include <memory>
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

/// How a server begins.
struct Start {
  map::Epoch epoch;
  std::vector<store::StoredMap> maps = {};             ///< of earlier servers, for robots that still run
  std::vector<ingest::IngestedKeyframe> unsaved = {};  ///< that came after those maps were saved
  store::Recorder* recorder = nullptr;                 ///< keeps keyframes and maps; null: nothing is kept
};

/// How many bytes of deltas a robot's link takes now; what waits in front of it is old before it leaves.
using DeltaRoom = std::function<std::size_t(map::RobotId)>;

/// An encoded delta and whom it is for.
struct OutgoingDelta {
  map::RobotId robot;
  std::vector<std::byte> bytes;
};

/// Keyframes in, deltas out: the map and the stream of each robot, optimised between keyframes. handle() and
/// work() on one thread; answer() and take_heartbeat() on another; status() from any. Counts map.keyframes,
/// map.keyframes_again (mapped already), map.gaussians, map.steps, map.bad_pictures, map.deltas,
/// map.delta_bytes and the histograms map.keyframe_ms and map.step_ms.
class MappingStage {
 public:
  MappingStage(const config::ServerConfig& config, Start start, DeltaRoom room, metrics::Registry& registry,
               const Clock& clock);

  /// New Gaussians go out at once, as far as the robot's allowance goes.
  std::vector<OutgoingDelta> handle(const ingest::IngestedKeyframe& keyframe);
  /// There is a map to optimise.
  [[nodiscard]] bool has_work() const;
  /// One optimisation step of the map whose turn it is, and what is due to be sent.
  std::vector<OutgoingDelta> work();
  /// Takes a robot's request; what is kept goes out again at once, the rest with the next work(). While its
  /// link has no room, what it misses may be waiting there: nothing is sent again (map.resends_put_off).
  std::vector<OutgoingDelta> answer(const link::Message& message);
  /// A robot's heartbeat says what it has applied.
  void take_heartbeat(const link::Message& message);
  /// Copies of the maps that changed since the last call, to be saved. On the thread of work().
  [[nodiscard]] std::vector<store::StoredMap> changed_maps();
  [[nodiscard]] std::vector<store::StoredMap> all_maps();
  [[nodiscard]] std::vector<MapStatus> status() const;
  /// The maps as they were seeded, where the configuration keeps them.
  [[nodiscard]] std::vector<const gaussian::GaussianCloud*> seeds() const;

 private:
  struct RobotMap {
    std::uint64_t session;
    map::MapUuid name;
    std::unique_ptr<optimise::MapBuilder> builder;
    std::shared_ptr<stream::DeltaStream> stream;
    stream::ByteAllowance allowance;
    HostTime last_publish{};
    std::uint64_t bad_pictures = 0;    ///< counted already
    std::uint64_t saved_revision = 0;  ///< keyframes and steps that changed_maps() has given

    [[nodiscard]] std::uint64_t revision() const {
      return builder->poses().size() + builder->engine().steps();
    }
  };
  RobotMap& map_of(const ingest::IngestedKeyframe& keyframe);
  RobotMap& begin(map::RobotId robot, std::uint64_t session, const map::MapUuid& name);
  void share(map::RobotId robot, const RobotMap& map);
  void begin_restored();
  void restore(const store::StoredMap& stored);
  [[nodiscard]] store::StoredMap copy_of(map::RobotId robot, RobotMap& map);
  std::vector<OutgoingDelta> publish(map::RobotId robot, RobotMap& map);
  [[nodiscard]] std::shared_ptr<stream::DeltaStream> stream_of(map::RobotId robot,
                                                               std::uint64_t session) const;

  const config::ServerConfig& config_;
  const map::Epoch epoch_;
  const DeltaRoom room_;
  const Clock& clock_;
  mapping::IdAllocator ids_;
  RestoredMaps restored_;
  std::map<map::RobotId, RobotMap> maps_;  ///< of the mapping thread
  map::RobotId last_worked_{};
  metrics::Counter& keyframes_;
  metrics::Counter& keyframes_again_;
  metrics::Counter& gaussians_;
  metrics::Counter& steps_;
  metrics::Counter& bad_pictures_;
  metrics::Counter& deltas_;
  metrics::Counter& delta_bytes_;
  metrics::Histogram& keyframe_ms_;
  metrics::Histogram& step_ms_;
  metrics::Counter& requests_corrupt_;
  metrics::Counter& resends_put_off_;
  metrics::Counter& restored_gaussians_;
  metrics::Histogram& copy_ms_;
  mutable std::mutex streams_mutex_;
  struct SharedStream {
    std::uint64_t session;
    std::shared_ptr<stream::DeltaStream> stream;
  };
  std::map<map::RobotId, SharedStream> streams_;  ///< the same as in maps_
};

}  // namespace edgesplat::app
