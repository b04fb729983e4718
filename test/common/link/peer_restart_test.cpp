// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// A robot's end that meets one server after another, in virtual time.
#include "test/common/link/restartable_link.hpp"
#include "test/support/message_bytes.hpp"

#include <gtest/gtest.h>

namespace edgesplat::link {
namespace {

using test::message_bytes;
using test::RestartableLink;

constexpr map::RobotId kRobot{1};
constexpr double kBytes_per_s = 1e6;

LinkEndOptions shaped() {
  LinkEndOptions options;
  options.impair.shape_at_s = {0.0};
  options.impair.shape_bytes_per_s = {kBytes_per_s};
  options.impair.delay_ms = 5;
  return options;
}

class PeerRestart : public ::testing::Test {
 protected:
  void run(double seconds, bool sending) {
    link_.run(seconds, [this, sending] {
      if (sending && link_.robot().counters()[index_of(Lane::kKeyframe)].queued_messages < 2)
        (void)link_.robot().send(Lane::kKeyframe, kRobot, message_bytes(60000));
      while (link_.server() != nullptr && link_.server()->receive(nanoseconds(0))) {
      }
    });
  }
  [[nodiscard]] std::optional<double> estimate() {
    return link_.robot().quality(kRobot).bandwidth_bytes_per_s;
  }
  /// A server is measured, dies under way and is silent for 5 s.
  void lose_a_server() {
    link_.start_server();
    run(0.6, true);
    ASSERT_NEAR(*estimate(), kBytes_per_s, 0.25 * kBytes_per_s);
    link_.kill_server();
    run(5.0, true);
    ASSERT_LT(*estimate(), 0.1 * kBytes_per_s) << "silence counts against the link";
  }

  RestartableLink link_{shaped(), {}};
};

TEST_F(PeerRestart, ANewServerIsMeasuredAnewByWhatIsSent) {
  lose_a_server();
  link_.start_server();
  run(0.5, true);
  EXPECT_NEAR(*estimate(), kBytes_per_s, 0.25 * kBytes_per_s);
}

TEST_F(PeerRestart, ANewServerIsMeasuredAnewByProbesAlone) {
  lose_a_server();
  link_.robot().withdraw(Lane::kKeyframe, kRobot);
  link_.robot().allow_probing(true);
  link_.start_server();
  run(3.0, false);
  EXPECT_GT(*estimate(), 1.25 * 300e3);
}

}  // namespace
}  // namespace edgesplat::link
