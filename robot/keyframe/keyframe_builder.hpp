// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/keyframe.hpp"
#include "robot/keyframe/colouriser.hpp"
#include "robot/keyframe/exposure.hpp"
#include "robot/keyframe/keyframe_config.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/tracked_group.hpp"

#include <memory>
#include <optional>

namespace edgesplat::keyframe {

/// Decides which moments become keyframes and makes them: pose, picture, and the points that were coloured
/// since the last one. Without a camera the points of the chosen groups go out uncoloured, grey by
/// reflectivity. Single-owner.
class KeyframeBuilder {
 public:
  KeyframeBuilder(const KeyframeConfig& config, const sensor::Rig& rig);

  /// Feeds one tracked group and the picture taken at its end, if there is one. Returns a keyframe when this
  /// moment is one: tracking is valid, a picture is there where the rig has a camera, and the robot has moved
  /// enough. Errors: kInvalidArgument when the picture cannot be encoded or its size is not the rig's.
  [[nodiscard]] Result<std::shared_ptr<const map::Keyframe>> add(
      const tracking::TrackedGroup& group, const std::optional<sync::GroupImage>& image);
  /// A picture that the map is not to get: the moment as a keyframe without points and number, for comparing
  /// with; null while there is no pose. The group's points wait for another picture's colours. Errors as of
  /// add().
  [[nodiscard]] Result<std::shared_ptr<const map::Keyframe>> hold_out(const tracking::TrackedGroup& group,
                                                                      const sync::GroupImage& image);
  [[nodiscard]] std::int64_t points_without_colour() const {
    return colouriser_ ? colouriser_->expired_without_colour() : 0;
  }

 private:
  [[nodiscard]] Result<sensor::ImageRgb8> equalised(const sync::GroupImage& image);
  [[nodiscard]] Result<std::shared_ptr<map::Keyframe>> begin_keyframe(const tracking::TrackedGroup& group,
                                                                      const sync::GroupImage* image,
                                                                      const sensor::ImageRgb8& picture) const;
  [[nodiscard]] bool is_due(const tracking::TrackedGroup& group) const;
  [[nodiscard]] std::vector<map::ColouredPoint> collect_points(const tracking::TrackedGroup& group);

  KeyframeConfig config_;
  sensor::Rig rig_;
  ExposureEqualiser exposure_;
  std::optional<Colouriser> colouriser_;
  std::uint32_t next_id_ = 0;
  std::optional<geometry::RigidTransform> last_odom_from_body_;
  HostTime last_stamp_{};
};

}  // namespace edgesplat::keyframe
