// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/ids.hpp"
#include "common/map/keyframe.hpp"
#include "common/time/clock.hpp"
#include "kernels/mapping/engine.hpp"
#include "robot/local_mapping/local_mapping_config.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>

namespace edgesplat::local_mapping {

struct LocalMapCounters {
  std::uint64_t keyframes = 0;
  std::uint64_t bad_pictures = 0;
  std::uint64_t steps = 0;
  std::uint64_t pruned = 0;         ///< Gaussians removed over the budget or when the robot was short
  std::uint64_t retired = 0;        ///< Gaussians that the server's took the place of
  std::uint64_t dropped_views = 0;  ///< pictures let go early: the robot was short, or the server took over
  std::size_t gaussians = 0;
  std::size_t views = 0;
};

/// The robot's own Gaussians, in `odom`: grown and optimised in LOCAL, provisional from then on until the
/// server has mapped the keyframes they came from. Their ids begin with the robot's number. No I/O, no
/// threads beyond those of a step; deterministic. Single-owner.
class LocalMap {
 public:
  /// kInvalidConfig where the budget is too small for the engine. `clock` must outlive the map.
  static Result<LocalMap> create(const LocalMappingConfig& config, map::RobotId robot, const Clock& clock);

  /// LOCAL begins or ends. When it ends, the Gaussians stay and all that only training needs is freed.
  void set_here(bool map_here);
  [[nodiscard]] bool here() const { return engine_ != nullptr; }
  /// What the server made, as far as it is held here: not mapped again. Null or empty for nothing.
  void set_resident(std::shared_ptr<const gaussian::GaussianCloud> in_odom);
  /// Seeds and trains on from now on; nothing outside LOCAL or for a keyframe that the server has mapped.
  void add(const map::Keyframe& keyframe);
  [[nodiscard]] bool has_work() const { return here() && engine_->has_work(); }
  /// One optimisation step, where there is work.
  void step();
  /// The robot is short: down to half the budget, or four fifths of what there is where that is less, but
  /// not below a twentieth of the budget; pictures down to the newest few. Memory goes back to the system.
  void prune_and_compress();
  /// The server has mapped these keyframes and what it made of them is held here: what came from them here
  /// goes.
  void retire(std::span<const std::uint32_t> keyframes);

  [[nodiscard]] const gaussian::GaussianCloud& cloud() const { return here() ? engine_->cloud() : kept_; }
  /// Rises with every change of the cloud.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// Most Gaussians the budget has room for.
  [[nodiscard]] std::size_t room() const { return room_; }
  [[nodiscard]] LocalMapCounters counters() const;

 private:
  LocalMap(const LocalMappingConfig& config, const mapping::EngineOptions& options, map::RobotId robot,
           const Clock& clock);
  void begin(const gaussian::GaussianCloud& cloud, std::deque<mapping::StoredView> views);
  /// Without the given rows, and the newest pictures alone.
  void keep_all_but(std::span<const std::uint32_t> rows, std::size_t newest_views);
  void keep_at_most(std::size_t gaussians, std::size_t newest_views);
  [[nodiscard]] bool mapped_elsewhere(map::KeyframeId keyframe);

  LocalMappingConfig config_;
  mapping::EngineOptions options_;
  const Clock* clock_;
  std::unique_ptr<mapping::IdAllocator> ids_;
  std::size_t room_;
  std::shared_ptr<const gaussian::GaussianCloud> resident_in_odom_;
  bool resident_new_ = false;                       ///< and not told to the engine yet
  bool told_of_gpu_ = false;                        ///< that it was given up
  std::unique_ptr<mapping::MappingEngine> engine_;  ///< in LOCAL alone
  gaussian::GaussianCloud kept_;                    ///< outside LOCAL
  Eigen::Vector3f robot_in_odom_m_ = Eigen::Vector3f::Zero();
  std::uint32_t next_keyframe_ = 0;    ///< above all that were added
  std::set<std::uint32_t> overtaken_;  ///< mapped by the server before they were added here; bounded
  std::uint64_t revision_ = 0;
  LocalMapCounters counters_;
};

}  // namespace edgesplat::local_mapping
