// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/integration/program.hpp"

#include "common/base/unique_fd.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace edgesplat::test {

std::string text_of(const std::string& path) {
  const std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Program::Program(const std::string& name, std::vector<std::string> arguments, const ChildLimits& limits) {
  arguments.insert(arguments.begin(), std::string(EDGESPLAT_BINARY_DIR) + "/bin/" + name);
  child_ = std::make_unique<ChildProcess>(
      arguments, ChildOutput{folder_.path() / "out", folder_.path() / "err"}, limits);
}

ProgramResult Program::wait(std::chrono::seconds timeout) {
  const std::optional<int> code = child_->wait(timeout);
  if (!code) {
    child_->signal(SIGKILL);
    (void)child_->wait(std::chrono::seconds(10));
  }
  return {code.value_or(-1), text_of(folder_.path() / "out"), text_of(folder_.path() / "err")};
}

bool Program::wait_for_stderr(const std::string& text, std::chrono::seconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (std::chrono::steady_clock::now() < deadline) {
    const bool over = child_->wait(std::chrono::milliseconds(20)).has_value();
    if (text_of(folder_.path() / "err").find(text) != std::string::npos) return true;
    if (over) return false;
  }
  return false;
}

ProgramResult run_program(const std::string& name, std::vector<std::string> arguments,
                          std::chrono::seconds timeout) {
  Program program(name, std::move(arguments));
  return program.wait(kSlowness * timeout);
}

std::string shared_recording(const std::string& name, std::vector<std::string> simulate_arguments) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(EDGESPLAT_BINARY_DIR) / "test_recordings";
  fs::create_directories(folder);
  const fs::path path = folder / (name + ".mcap");
  const UniqueFd lock(open((folder / (name + ".lock")).c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600));
  flock(lock.get(), LOCK_EX);
  const fs::path program = fs::path(EDGESPLAT_BINARY_DIR) / "bin" / "edgesplat";
  if (!fs::exists(path) || fs::last_write_time(path) < fs::last_write_time(program)) {
    const fs::path fresh = folder / (name + ".new.mcap");
    simulate_arguments.insert(simulate_arguments.begin(), "simulate");
    simulate_arguments.insert(simulate_arguments.end(), {"--out", fresh.string()});
    const ProgramResult made =
        run_program("edgesplat", std::move(simulate_arguments), std::chrono::seconds(280));
    EXPECT_EQ(made.exit_code, 0) << made.err;
    if (made.exit_code == 0) fs::rename(fresh, path);
  }
  return fs::exists(path) ? path.string() : std::string();
}

}  // namespace edgesplat::test
