// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/integration/killed_recording.hpp"

namespace edgesplat::test {
namespace {

TEST_F(KilledRecording, LosesItsLastSecondAtMost) {
  for (const double seconds : {1.3, 3.1}) EXPECT_LT(round(seconds), 1.0 * kSlowness);
}

TEST_F(KilledRecording, CanBeReplayedOnceItIsWhole) {
  EXPECT_LT(round(4.0), 1.0 * kSlowness);
  const auto replayed = run_program("edgesplat-robot", {"--replay", in_folder("live.mcap"), "--lockstep",
                                                        "--server", "off", "--out", in_folder("again")});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_EQ(replayed.err.find("recording incomplete"), std::string::npos) << replayed.err;
}

}  // namespace
}  // namespace edgesplat::test
