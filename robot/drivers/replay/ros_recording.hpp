// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/bag_source.hpp"
#include "robot/drivers/replay/bag_rig.hpp"
#include "robot/drivers/replay/replay_source.hpp"

#include <memory>

namespace edgesplat::replay {

/// A ROS recording as measurements: the rig says which sensors to look for and where they sit, its [replay]
/// how they were recorded. Messages that cannot be used are counted and told in the report, with the first
/// reason. The rig that comes out has no camera where the recording has no pictures. Errors: those of
/// choose_topics().
[[nodiscard]] Result<std::unique_ptr<ReplaySource::Reader>> open_ros_recording(
    std::unique_ptr<io::BagSource> bag, BagRig rig);

}  // namespace edgesplat::replay
