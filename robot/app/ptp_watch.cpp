// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/ptp_watch.hpp"

#include "common/log/log.hpp"

namespace edgesplat::app {
namespace {

constexpr double kAnswerTimeout_s = 2.0;

}  // namespace

PtpWatch::PtpWatch(const robot_config::PtpSettings& config, metrics::Registry& metrics)
    : config_(config),
      failures_(metrics.counter("ptp.failures")),
      good_(metrics.gauge("ptp.good")),
      offset_ns_(metrics.gauge("ptp.offset_from_master_ns")),
      judgement_(config.offset_limit_us),
      worker_("ptp-watch", [this](const std::stop_token& stop) { return step(stop); }) {}

bool PtpWatch::step(const std::stop_token& stop) {
  const auto text = sync::run_for_output(sync::pmc_command(config_.program), kAnswerTimeout_s, stop);
  if (stop.stop_requested()) return false;
  const Result<sync::PtpReport> report =
      text ? sync::parse_pmc(*text) : Result<sync::PtpReport>(tl::unexpected<Error>(text.error()));
  if (const auto change = judgement_.on_report(report)) {
    if (change->good) {
      EDGESPLAT_LOG_INFO("ptp", change->what);
    } else {
      failures_.add();
      EDGESPLAT_LOG_WARN("ptp", "not in order", "why", change->what);
    }
  }
  good_.set(judgement_.good() ? 1.0 : 0.0);
  if (judgement_.offset_ns()) offset_ns_.set(*judgement_.offset_ns());
  std::unique_lock lock(mutex_);
  (void)never_.wait_for(lock, stop, from_seconds(config_.period_s), [] { return false; });
  return !stop.stop_requested();
}

}  // namespace edgesplat::app
