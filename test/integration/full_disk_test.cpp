// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/integration/program.hpp"
#include "test/integration/server_link_fixture.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace edgesplat {
namespace {

using namespace std::chrono_literals;

using FullDiskTest = test::ServerLinkFixture;

std::size_t times(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

// The map and its robot matter more than the store: the server says once that nothing is kept, and why, and
// goes on; its exit code tells that something failed.
TEST_F(FullDiskTest, TheServerGoesOnMappingSaysSoOnceAndFailsInTheEnd) {
  const std::string words = folder_.path() / "words";
  constexpr std::uint64_t kRoom_bytes = 30'000;  // for any one file: less than a keyframe or a map
  test::ChildProcess server(server_command({"--set", "store.save_period_s=0.2"}), {{}, words}, {kRoom_bytes});
  test::RobotEnd robot(domain_);
  submit_walls(robot, 0, 8);
  ASSERT_TRUE(robot.wait_for_delta(map::Epoch{1}, 16, 60s));
  const auto hash = robot.server_hash_at(16, 60s);
  ASSERT_TRUE(hash.has_value());
  EXPECT_EQ(robot.map().map_hash(), *hash);
  server.signal(SIGTERM);
  EXPECT_EQ(server.wait(30s), 1);
  const std::string said = test::text_of(words);
  EXPECT_EQ(times(said, "not written; going on without"), 2U) << said;  // keyframes and maps
  EXPECT_NE(said.rfind("edgesplat-server: "), std::string::npos) << said;
  EXPECT_NE(said.find("File too large"), std::string::npos) << said;
}

}  // namespace
}  // namespace edgesplat
