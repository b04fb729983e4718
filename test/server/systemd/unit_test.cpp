// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/atomic_file.hpp"
#include "test/support/child_process.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace edgesplat {
namespace {

constexpr const char* kAnalyze = "/usr/bin/systemd-analyze";

struct Verdict {
  std::optional<int> code;
  std::string words;
};

/// What systemd says of the unit with the program at its place in this build.
Verdict verify(std::string unit) {
  const std::string installed = "/usr/bin/edgesplat-server";
  const auto at = unit.find(installed);
  EXPECT_NE(at, std::string::npos);
  unit.replace(at, installed.size(), EDGESPLAT_BINARY_DIR "/bin/edgesplat-server");
  const test::TempDir folder;
  const auto path = folder.path() / "edgesplat-server.service";
  EXPECT_TRUE(io::write_file_atomically(path, unit).has_value());
  const auto words = folder.path() / "words";
  test::ChildProcess analyze({kAnalyze, "verify", "--man=no", path.string()}, {words, words});
  const auto code = analyze.wait(std::chrono::seconds(60));
  return {code, io::read_text_file(words, 1U << 20U).value_or("")};
}

std::string unit() {
  return *io::read_text_file(EDGESPLAT_SOURCE_DIR "/server/systemd/edgesplat-server.service", 1U << 20U);
}

TEST(ServerUnit, SystemdFindsNothingWrong) {
  if (!std::filesystem::exists(kAnalyze)) GTEST_SKIP() << "no systemd-analyze here";
  const Verdict verdict = verify(unit());
  EXPECT_EQ(verdict.code, 0) << verdict.words;
  EXPECT_EQ(verdict.words.find("edgesplat-server.service:"), std::string::npos) << verdict.words;
}

TEST(ServerUnit, AMistakeWouldBeFound) {
  if (!std::filesystem::exists(kAnalyze)) GTEST_SKIP() << "no systemd-analyze here";
  std::string wrong = unit();
  wrong.replace(wrong.find("ProtectSystem="), 14, "ProtectSystm=");
  EXPECT_NE(verify(wrong).words.find("ProtectSystm"), std::string::npos);
}

}  // namespace
}  // namespace edgesplat
