// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/bag_source.hpp"
#include "robot/drivers/replay/bag_rig.hpp"

#include <cstddef>
#include <optional>
#include <span>

namespace edgesplat::replay {

/// Indices of the topics that a rig's sensors have in a recording.
struct BagTopics {
  std::optional<std::size_t> lidar;
  std::optional<std::size_t> imu;    ///< always there where the rig has one
  std::optional<std::size_t> image;  ///< absent where the rig has no camera or the recording no pictures
};

/// By name where the settings name them, else by type. kInvalidConfig, with what the recording holds, where a
/// named topic is absent or of another type, where none fits, or where several do.
[[nodiscard]] Result<BagTopics> choose_topics(std::span<const io::BagTopic> topics, const BagRig& rig);

[[nodiscard]] bool is_livox_custom(const io::BagTopic& topic);
/// "/a (sensor_msgs/Imu), /b (...)", for messages.
[[nodiscard]] std::string list_topics(std::span<const io::BagTopic> topics);

}  // namespace edgesplat::replay
