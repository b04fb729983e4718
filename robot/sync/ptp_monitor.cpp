// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/ptp_monitor.hpp"

#include "common/base/unique_fd.hpp"
#include "common/thread/stop_fd.hpp"
#include "common/time/clock.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstring>
#include <utility>

namespace edgesplat::sync {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 10U;

std::string judge(const PtpReport& report, double limit_us) {
  if (report.has_port_in("FAULTY")) return "a PTP port is FAULTY: cable or network card";
  if (report.has_port_in("MASTER")) return {};
  if (!report.has_port_in("SLAVE")) return "no PTP port is MASTER or SLAVE: the sensors' clocks run freely";
  if (report.grandmaster_present == false) return "the PTP master is gone";
  if (std::abs(report.offset_from_master_ns.value_or(0.0)) > limit_us * 1e3)
    return "the offset from the PTP master is over the limit";
  return {};
}

/// A child that is ended and waited for, whatever happens.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    (void)::waitpid(pid_, nullptr, 0);
  }
  /// Its exit code; -1 where a signal ended it.
  int wait() {
    int status = 0;
    (void)::waitpid(std::exchange(pid_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_;
};

Result<pid_t> spawn(const std::vector<std::string>& command, int out) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));  // NOLINT
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t pid = -1;
  const int error = ::posix_spawnp(&pid, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return fail(Errc::kUnavailable, "cannot run " + command[0] + ": " + std::strerror(error));
  return pid;
}

}  // namespace

std::optional<PtpChange> PtpJudgement::on_report(const Result<PtpReport>& report) {
  const std::string bad = report ? judge(*report, limit_us_) : report.error().context;
  offset_ns_ = report ? report->offset_from_master_ns : std::nullopt;
  const bool was_good = good_.value_or(false);
  const bool first = !good_.has_value();
  good_ = bad.empty();
  if (!*good_) {
    if (!first && !was_good) return std::nullopt;
    ++failures_;
    return PtpChange{false, bad};
  }
  const bool other_master = was_good && !grandmaster_.empty() && report->grandmaster != grandmaster_;
  grandmaster_ = report->grandmaster;
  if (other_master) return PtpChange{true, "another PTP grandmaster: " + grandmaster_};
  if (was_good) return std::nullopt;
  return PtpChange{true, "PTP serves the sensors, grandmaster " + grandmaster_};
}

Result<std::string> run_for_output(const std::vector<std::string>& command, double timeout_s,
                                   const std::stop_token& stop) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) return fail(Errc::kUnavailable, "cannot make a pipe");
  const UniqueFd read_end(pipe[0]);
  UniqueFd write_end(pipe[1]);
  EDGESPLAT_TRY(const pid_t pid, spawn(command, write_end.get()));
  Child child(pid);
  write_end.reset();
  const SteadyClock clock;
  const HostTime until = clock.now() + from_seconds(timeout_s);
  const thread::StopFd stop_fd(stop);
  std::string text;
  std::array<char, 4096> chunk{};
  while (true) {
    const auto left_ms = std::chrono::ceil<std::chrono::milliseconds>(until - clock.now()).count();
    std::array<pollfd, 2> fds{pollfd{stop_fd.get(), POLLIN, 0}, pollfd{read_end.get(), POLLIN, 0}};
    const int ready = left_ms > 0 ? ::poll(fds.data(), fds.size(), static_cast<int>(left_ms)) : 0;
    if (ready <= 0 || fds[0].revents != 0)
      return fail(Errc::kUnavailable, command[0] + " did not answer in " + std::to_string(timeout_s) + " s");
    const ssize_t bytes = ::read(read_end.get(), chunk.data(), chunk.size());
    if (bytes <= 0) break;
    text.append(chunk.data(), static_cast<std::size_t>(bytes));
    if (text.size() > kMostBytes) return fail(Errc::kUnavailable, command[0] + " writes without end");
  }
  const int code = child.wait();
  if (code != 0) return fail(Errc::kUnavailable, command[0] + " failed, exit code " + std::to_string(code));
  return text;
}

std::vector<std::string> pmc_command(const std::string& program) {
  return {program, "-u", "-b", "0", "GET PORT_DATA_SET", "GET CURRENT_DATA_SET", "GET TIME_STATUS_NP"};
}

}  // namespace edgesplat::sync
