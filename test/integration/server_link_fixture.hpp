// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "test/integration/robot_end.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/temp_dir.hpp"
#include "test/support/test_domain.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace edgesplat::test {

/// A DDS domain of the test's own, a folder for the server's files, and walls to map.
class ServerLinkFixture : public ::testing::Test {
 protected:
  void SetUp() override {
    link::LinkConfig config;
    config.domain = test_domain();
    auto domain = link::DdsDomain::open(config);
    ASSERT_TRUE(domain.has_value()) << domain.error().context;
    domain_ = *domain;
  }
  /// The real server in this domain and folder.
  [[nodiscard]] std::vector<std::string> server_command(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command = {std::string(EDGESPLAT_BINARY_DIR) + "/bin/edgesplat-server",
                                        "--domain", std::to_string(test_domain()), "--out",
                                        folder_.path().string()};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  /// Each shows a wall of its own, so each makes two deltas: its Gaussians, and
  /// that it is mapped.
  static void submit_walls(RobotEnd& robot, std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t id = first; id < first + count; ++id) {
      auto keyframe = wall_keyframe(id, 3000);
      keyframe.odom_from_body.translation_m.y() = 5.0 * id;
      (void)robot.uplink().submit(std::make_shared<const map::Keyframe>(keyframe));
    }
  }

  TempDir folder_;
  std::shared_ptr<link::DdsDomain> domain_;
};

}  // namespace edgesplat::test
