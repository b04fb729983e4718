// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/unique_fd.hpp"

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace edgesplat::test {

/// Files that take a program's words; empty: they go where the test's own go.
struct ChildOutput {
  std::string out_file;
  std::string err_file;
};

/// What the kernel lets the program do.
struct ChildLimits {
  std::optional<std::uint64_t> file_bytes;  ///< no file may grow beyond this, as on a disk that is full
};

/// A program started by a test; killed, if it still runs, at the end of the scope. Single-owner.
class ChildProcess {
 public:
  /// `arguments[0]` is the program's path. A program that cannot be started ends with code 127. It starts
  /// with no signal blocked, whatever the test has blocked.
  explicit ChildProcess(const std::vector<std::string>& arguments, const ChildOutput& output = {},
                        const ChildLimits& limits = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void signal(int number) const;
  /// The exit code (128 + signal where one ended it), or nothing while it still runs after `timeout`.
  std::optional<int> wait(std::chrono::milliseconds timeout);

 private:
  pid_t pid_ = -1;
  UniqueFd pidfd_;
  std::optional<int> code_;
};

}  // namespace edgesplat::test
