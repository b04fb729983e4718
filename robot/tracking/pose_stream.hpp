// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/sync/measure_group.hpp"
#include "robot/tracking/filter_state.hpp"
#include "robot/tracking/tracked_group.hpp"

#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>

namespace edgesplat::tracking {

/// Where the body is at one sample of the IMU.
struct StreamedPose {
  HostTime stamp{};  ///< the sample's
  geometry::RigidTransform odom_from_body;
  Eigen::Vector3d velocity_in_odom_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_in_body_radps = Eigen::Vector3d::Zero();  ///< without the gyro's bias
  nanoseconds since_tracked{};                                   ///< carried by the IMU alone for so long
};

/// The pose at the IMU's rate, for control: the newest tracked state carried through the samples that came
/// since, by the filter's own equations. Tracking works on what is up to a group and an image's way old; its
/// result moves the stream by what the filter learnt, so the stream is not smooth where the filter is not.
/// Thread-safe. A sample costs one step, a correction one for each sample since its stamp.
class PoseStream {
 public:
  struct Config {
    nanoseconds longest_carry{1'000'000'000};  ///< without a tracked state; then nothing is said
    nanoseconds longest_hole{
        100'000'000};                  ///< between samples; over it nothing is said till tracking is past it
    std::size_t most_samples = 2'000;  ///< kept: those since the newest tracked state
  };
  PoseStream() = default;
  explicit PoseStream(const Config& config) : config_(config) {}

  /// Tracking's result. A state that is not valid (initialising, lost) ends the stream until the next one.
  void correct(const TrackedGroup& tracked);
  /// The next sample; nothing where the pose is not known, or for one that is not newer than the one before.
  [[nodiscard]] std::optional<StreamedPose> on_sample(const sync::GroupImu& sample);

 private:
  [[nodiscard]] bool step(const sync::GroupImu& from, const sync::GroupImu& to);

  Config config_;
  std::mutex mutex_;
  std::deque<sync::GroupImu> samples_;  ///< the last one at or before tracked_at_, and all since
  std::optional<FilterState> state_;    ///< at now_
  HostTime now_{};
  HostTime tracked_at_{};
};

}  // namespace edgesplat::tracking
