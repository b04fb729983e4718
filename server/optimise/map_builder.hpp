// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/engine.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::optimise {

/// Where a keyframe was put.
struct KeyframePose {
  map::KeyframeId keyframe;
  std::uint32_t version = 0;
  geometry::RigidTransform map_from_body;
};

/// The server's map of one robot's session: grown keyframe by keyframe, optimised step by step. `map` and
/// `odom` are one frame until poses are corrected. Single-owner.
class MapBuilder {
 public:
  /// `ids` and `clock` must outlive this. kInvalidConfig for options out of range.
  static Result<std::unique_ptr<MapBuilder>> create(const mapping::EngineOptions& options,
                                                    mapping::IdAllocator& ids, const Clock& clock);

  /// Decodes the picture, seeds what is new, trains on it from now on; returns how many Gaussians are new. A
  /// picture that does not decode is counted, and the points are used alone.
  std::size_t add(const map::Keyframe& keyframe);
  /// Goes on with a map of an earlier server, before the first add(); as of MappingEngine::restore().
  Result<std::size_t> restore(const gaussian::GaussianCloud& cloud, std::vector<KeyframePose> poses);
  [[nodiscard]] bool has_work() const { return engine_->has_work(); }
  /// One optimisation step; nothing without a view.
  std::optional<mapping::StepReport> step() { return engine_->step(); }
  [[nodiscard]] mapping::EngineChanges take_changes() { return engine_->take_changes(); }

  [[nodiscard]] const mapping::MappingEngine& engine() const { return *engine_; }
  /// Of every keyframe that was added, in their order.
  [[nodiscard]] std::span<const KeyframePose> poses() const { return poses_; }
  [[nodiscard]] bool has(map::KeyframeId keyframe) const {
    return std::any_of(poses_.rbegin(), poses_.rend(),
                       [keyframe](const KeyframePose& pose) { return pose.keyframe == keyframe; });
  }
  [[nodiscard]] std::uint64_t bad_pictures() const { return bad_pictures_; }

 private:
  explicit MapBuilder(std::unique_ptr<mapping::MappingEngine> engine) : engine_(std::move(engine)) {}

  std::unique_ptr<mapping::MappingEngine> engine_;
  std::vector<KeyframePose> poses_;
  std::uint64_t bad_pictures_ = 0;
  bool told_of_gpu_ = false;  ///< that it was given up
};

}  // namespace edgesplat::optimise
