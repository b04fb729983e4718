// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/unsaved_keyframes.hpp"

#include "common/map/keyframe_codec.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace edgesplat::app {
namespace {

store::LoggedKeyframe logged(std::uint16_t robot, std::uint64_t session, std::uint32_t id) {
  return {map::RobotId{robot}, session, *map::encode_keyframe(test::wall_keyframe(id, 50))};
}

store::StoredMap saved(std::uint16_t robot, std::uint64_t session,
                       const std::vector<std::uint32_t>& keyframes) {
  store::StoredMap map;
  map.robot.value = robot;
  map.session = session;
  for (const std::uint32_t id : keyframes) map.poses.push_back({id, 0, {}});
  return map;
}

using Found = std::vector<std::pair<int, std::uint32_t>>;

Found found(const std::vector<store::LoggedKeyframe>& log, const std::vector<store::StoredMap>& maps) {
  Found found;
  for (const auto& keyframe : unsaved_keyframes(log, maps))
    found.emplace_back(keyframe.robot.value, keyframe.keyframe.id.value);
  return found;
}

TEST(UnsavedKeyframes, AreThoseThatTheSavedMapLacks) {
  const std::vector log = {logged(1, 10, 4), logged(2, 20, 4), logged(1, 10, 6), logged(1, 10, 5)};
  EXPECT_EQ(found(log, {saved(1, 10, {4, 6}), saved(2, 20, {})}), (Found{{2, 4}, {1, 5}}));
  EXPECT_EQ(found(log, {}), (Found{{1, 4}, {2, 4}, {1, 6}, {1, 5}})) << "no map was saved yet";
}

TEST(UnsavedKeyframes, BelongToTheRobotsLastSession) {
  const std::vector log = {logged(1, 10, 4), logged(1, 11, 0)};
  EXPECT_EQ(found(log, {saved(1, 10, {})}), (Found{{1, 0}}));
}

TEST(UnsavedKeyframes, ComeOnceAndDamagedOnesDoNot) {
  std::vector log = {logged(1, 10, 4), logged(1, 10, 4), logged(1, 10, 5)};
  log[2].bytes.resize(20);
  EXPECT_EQ(found(log, {}), (Found{{1, 4}}));
  EXPECT_TRUE(found({}, {saved(1, 10, {1})}).empty());
}

}  // namespace
}  // namespace edgesplat::app
