// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/metrics/registry.hpp"
#include "common/thread/worker.hpp"
#include "robot/config/robot_config.hpp"
#include "robot/sync/ptp_monitor.hpp"

#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace edgesplat::app {

/// Asks ptp4l every few seconds how PTP is, on a thread of its own: a line in the log for each change,
/// "ptp.*" among the metrics. Owned by one thread.
class PtpWatch {
 public:
  PtpWatch(const robot_config::PtpSettings& config, metrics::Registry& metrics);
  PtpWatch(const PtpWatch&) = delete;
  PtpWatch& operator=(const PtpWatch&) = delete;

 private:
  bool step(const std::stop_token& stop);

  robot_config::PtpSettings config_;
  metrics::Counter& failures_;
  metrics::Gauge& good_;
  metrics::Gauge& offset_ns_;
  sync::PtpJudgement judgement_;
  std::mutex mutex_;
  std::condition_variable_any never_;
  thread::Worker worker_;
};

}  // namespace edgesplat::app
