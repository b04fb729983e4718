// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <stdio.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace edgesplat::io {

/// What peer.py printed; `missing` says why it could not run.
struct PeerRun {
  std::vector<std::string> output;
  std::string missing;
};

/// Runs peer.py in the environment that tools/setup --peers made (or EDGESPLAT_PEERS_PYTHON).
inline PeerRun run_peer(const std::string& verb, const std::filesystem::path& file,
                        const std::string& argument = "") {
  const char* chosen = std::getenv("EDGESPLAT_PEERS_PYTHON");
  const std::string python = chosen != nullptr ? chosen : EDGESPLAT_SOURCE_DIR "/.deps/peers/bin/python";
  PeerRun run;
  if (!std::filesystem::exists(python)) {
    run.missing = "no " + python + ": run tools/setup --peers";
    return run;
  }
  const std::string command = "'" + python + "' '" EDGESPLAT_SOURCE_DIR "/test/common/io/peer.py' " + verb +
                              " '" + file.string() + "' '" + argument + "' 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  std::string line;
  for (int letter = std::fgetc(pipe); letter != EOF; letter = std::fgetc(pipe)) {
    if (letter != '\n') {
      line += static_cast<char>(letter);
      continue;
    }
    run.output.push_back(line);
    line.clear();
  }
  const int status = ::pclose(pipe);
  constexpr int kMissingPackage = 77;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  const std::string last = run.output.empty() ? "" : run.output.back();
  if (code == kMissingPackage) run.missing = last + ": run tools/setup --peers";
  EXPECT_TRUE(code == 0 || code == kMissingPackage) << verb << " failed: " << last;
  return run;
}

}  // namespace edgesplat::io

/// `EDGESPLAT_PEER(lines, "verb", path, "argument");` or skips the test.
#define EDGESPLAT_PEER(lines, ...)                                       \
  const auto lines##_run = ::edgesplat::io::run_peer(__VA_ARGS__);       \
  if (!lines##_run.missing.empty()) GTEST_SKIP() << lines##_run.missing; \
  [[maybe_unused]] const auto& lines = lines##_run.output
