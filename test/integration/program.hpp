// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "test/support/child_process.hpp"
#include "test/support/temp_dir.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace edgesplat::test {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal where one ended it; -1: killed because time ran out
  std::string out;
  std::string err;
};

/// A program of this build (build/<preset>/bin) as a child process whose words can be read back.
class Program {
 public:
  Program(const std::string& name, std::vector<std::string> arguments, const ChildLimits& limits = {});

  void signal(int number) const { child_->signal(number); }
  /// Waits for the end; after `timeout` the program is killed.
  ProgramResult wait(std::chrono::seconds timeout);
  /// Waits until stderr contains `text`; false after `timeout` or when the program ended without saying it.
  [[nodiscard]] bool wait_for_stderr(const std::string& text, std::chrono::seconds timeout);

 private:
  TempDir folder_;
  std::unique_ptr<ChildProcess> child_;
};

/// How much slower programs may be in this build than in a release.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kSlowness = 5;
#else
constexpr int kSlowness = 1;
#endif
/// Where it is slower the robot may be too slow to follow live sensors: it sheds groups then, as it should.
constexpr bool kMustKeepUp = kSlowness == 1;

/// Runs to the end, at most kSlowness times `timeout`.
ProgramResult run_program(const std::string& name, std::vector<std::string> arguments,
                          std::chrono::seconds timeout = std::chrono::seconds(120));

/// A simulated recording that all tests share: made on first use by `edgesplat simulate` with these
/// arguments, kept in the build folder, made again when the program is newer. Safe when tests run at the same
/// time. Empty on failure.
[[nodiscard]] std::string shared_recording(const std::string& name,
                                           std::vector<std::string> simulate_arguments);

/// A whole file as text; empty where it cannot be read.
[[nodiscard]] std::string text_of(const std::string& path);

}  // namespace edgesplat::test
