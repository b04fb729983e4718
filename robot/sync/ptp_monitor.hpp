// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/sync/ptp_report.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace edgesplat::sync {

/// What changed about PTP on this machine, as words for the log.
struct PtpChange {
  bool good = false;
  std::string what;
};

/// Judges one report after the other. PTP serves the sensors when a port is MASTER (this machine is their
/// clock) or SLAVE (something else is, and it is close). Single-owner.
class PtpJudgement {
 public:
  explicit PtpJudgement(double offset_limit_us = 10.0) : limit_us_(offset_limit_us) {}

  /// Nothing while it stays as it was.
  [[nodiscard]] std::optional<PtpChange> on_report(const Result<PtpReport>& report);
  [[nodiscard]] bool good() const { return good_.value_or(false); }
  /// Times that it went bad.
  [[nodiscard]] std::uint64_t failures() const { return failures_; }
  [[nodiscard]] std::optional<double> offset_ns() const { return offset_ns_; }

 private:
  double limit_us_;
  std::optional<bool> good_;
  std::string grandmaster_;
  std::optional<double> offset_ns_;
  std::uint64_t failures_ = 0;
};

/// Runs a program and gives what it wrote, at most 64 KiB. kUnavailable where it cannot be run, fails, or is
/// not done after `timeout_s` (it is ended then).
[[nodiscard]] Result<std::string> run_for_output(const std::vector<std::string>& command, double timeout_s,
                                                 const std::stop_token& stop);

/// `pmc` with the questions that parse_pmc() wants.
[[nodiscard]] std::vector<std::string> pmc_command(const std::string& program);

}  // namespace edgesplat::sync
