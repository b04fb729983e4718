// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/ingest/ingest.hpp"

#include "common/log/log.hpp"
#include "common/map/keyframe_codec.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::ingest {
namespace {

constexpr std::size_t kRememberedSessions = 16;
constexpr std::size_t kRememberedIds = 4096;

}  // namespace

Ingest::Ingest(metrics::Registry& registry, std::size_t max_robots)
    : max_robots_(max_robots),
      keyframes_(registry.counter("ingest.keyframes")),
      bytes_(registry.counter("ingest.bytes")),
      corrupt_(registry.counter("ingest.corrupt")),
      duplicates_(registry.counter("ingest.duplicates")),
      stale_(registry.counter("ingest.stale")),
      refused_(registry.counter("ingest.refused")) {}

std::optional<IngestedKeyframe> Ingest::take(const link::Message& message, HostTime received) {
  bytes_.add(message.bytes.size());
  auto keyframe = map::decode_keyframe(message.bytes);
  if (!keyframe) {
    corrupt_.add();
    EDGESPLAT_LOG_WARN("ingest", "keyframe refused", "robot", message.robot.value, "why",
                       keyframe.error().context);
    return std::nullopt;
  }
  Robot* robot = admit(message.robot, message.session);
  if (robot == nullptr) return std::nullopt;
  if (!remember(*robot, keyframe->id.value)) {
    duplicates_.add();
    return std::nullopt;
  }
  keyframes_.add();
  return IngestedKeyframe{message.robot, message.session, received, std::move(*keyframe)};
}

Ingest::Robot* Ingest::admit(map::RobotId id, std::uint64_t session) {
  auto found = robots_.find(id);
  if (found == robots_.end()) {
    if (robots_.size() >= max_robots_) {
      refused_.add();
      EDGESPLAT_LOG_WARN("ingest", "robot refused: too many", "robot", id.value, "most", max_robots_);
      return nullptr;
    }
    found = robots_.try_emplace(id).first;
    found->second.session = session;
    EDGESPLAT_LOG_INFO("ingest", "robot joined", "robot", id.value, "session", session);
    return &found->second;
  }
  Robot& robot = found->second;
  if (robot.session == session) return &robot;
  if (std::find(robot.former_sessions.begin(), robot.former_sessions.end(), session) !=
      robot.former_sessions.end()) {
    stale_.add();
    return nullptr;
  }
  auto former = std::move(robot.former_sessions);
  former.push_back(robot.session);
  if (former.size() > kRememberedSessions) former.pop_front();
  robot = Robot{session, std::move(former), {}, 0};
  EDGESPLAT_LOG_INFO("ingest", "robot restarted", "robot", id.value, "session", session);
  return &robot;
}

bool Ingest::remember(Robot& robot, std::uint32_t id) {
  if (id < robot.floor || !robot.recent.insert(id).second) return false;
  if (robot.recent.size() > kRememberedIds) {
    robot.floor = *robot.recent.begin() + 1;
    robot.recent.erase(robot.recent.begin());
  }
  return true;
}

}  // namespace edgesplat::ingest
