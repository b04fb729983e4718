// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/bag_topics.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

namespace edgesplat::replay {
namespace {

using Types = std::vector<std::string_view>;

std::vector<std::size_t> of_types(std::span<const io::BagTopic> topics, const Types& types) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < topics.size(); ++i)
    if (std::find(types.begin(), types.end(), topics[i].type) != types.end()) found.push_back(i);
  return found;
}

/// Of pictures that were recorded plain and compressed, the plain ones.
void drop_compressed_twins(std::span<const io::BagTopic> topics, std::vector<std::size_t>& found) {
  std::vector<std::size_t> kept;
  for (const std::size_t i : found) {
    const auto is_twin = [&](std::size_t j) { return topics[i].name == topics[j].name + "/compressed"; };
    if (std::none_of(found.begin(), found.end(), is_twin)) kept.push_back(i);
  }
  found = std::move(kept);
}

/// What is looked for, in words and by type; nothing only where there is no topic of these types at all.
Result<std::optional<std::size_t>> choose(std::span<const io::BagTopic> topics, std::string_view key,
                                          const std::string& name, const Types& types) {
  std::vector<std::size_t> found = of_types(topics, types);
  if (!name.empty()) {
    const auto has_name = [&](std::size_t i) { return topics[i].name == name; };
    const auto place = std::find_if(found.begin(), found.end(), has_name);
    if (place != found.end()) return *place;
    return fail(Errc::kInvalidConfig, "replay." + std::string(key) + " = \"" + name +
                                          "\" is no topic of a type " + std::string(types.front()) +
                                          " in the recording, which has " + list_topics(topics));
  }
  if (found.empty()) return std::nullopt;
  const auto custom =
      std::count_if(found.begin(), found.end(), [&](std::size_t i) { return is_livox_custom(topics[i]); });
  if (custom == 1) std::erase_if(found, [&](std::size_t i) { return !is_livox_custom(topics[i]); });
  drop_compressed_twins(topics, found);
  if (found.size() == 1) return found.front();
  std::vector<io::BagTopic> candidates;
  for (const std::size_t i : found) candidates.push_back(topics[i]);
  return fail(Errc::kInvalidConfig,
              "several topics of the recording could be it: " + list_topics(candidates) + "; name one as " +
                  std::string(key) + " in [replay] of the rig's file");
}

}  // namespace

bool is_livox_custom(const io::BagTopic& topic) {
  return topic.type == "livox_ros_driver/CustomMsg" || topic.type == "livox_ros_driver2/CustomMsg";
}

std::string list_topics(std::span<const io::BagTopic> topics) {
  std::string text;
  for (const io::BagTopic& topic : topics)
    text += (text.empty() ? "" : ", ") + topic.name + " (" + topic.type + ")";
  return text.empty() ? "no topics" : text;
}

Result<BagTopics> choose_topics(std::span<const io::BagTopic> topics, const BagRig& rig) {
  const BagSettings& s = rig.replay;
  BagTopics chosen;
  EDGESPLAT_TRY(chosen.lidar, choose(topics, "lidar_topic", s.lidar_topic,
                                     {"sensor_msgs/PointCloud2", "livox_ros_driver/CustomMsg",
                                      "livox_ros_driver2/CustomMsg"}));
  if (!chosen.lidar) {
    return fail(Errc::kInvalidConfig,
                "the recording holds no sensor_msgs/PointCloud2 and no Livox CustomMsg: it has " +
                    list_topics(topics));
  }
  if (rig.rig.imu) {
    EDGESPLAT_TRY(chosen.imu, choose(topics, "imu_topic", s.imu_topic, {"sensor_msgs/Imu"}));
    if (!chosen.imu) {
      return fail(Errc::kInvalidConfig, "the rig has an IMU, the recording no sensor_msgs/Imu: it has " +
                                            list_topics(topics) +
                                            "; take [imu] out of the rig's file to track without");
    }
  }
  if (rig.rig.camera) {
    EDGESPLAT_TRY(chosen.image, choose(topics, "image_topic", s.image_topic,
                                       {"sensor_msgs/Image", "sensor_msgs/CompressedImage"}));
  }
  return chosen;
}

}  // namespace edgesplat::replay
