// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/offload_loop.hpp"

#include "common/log/log.hpp"

namespace edgesplat::app {

OffloadLoop::OffloadLoop(offload::OffloadControl& control, const OffloadTargets& targets, double period_s,
                         const std::filesystem::path& timeline, const Clock& clock)
    : control_(control),
      targets_(targets),
      period_(from_seconds(period_s)),
      timeline_(timeline, clock.now()) {
  evaluate();
  worker_.emplace("offload", [this](const std::stop_token& stop) {
    {
      std::unique_lock lock(sleep_mutex_);
      (void)sleep_.wait_for(lock, stop, period_, [] { return false; });
    }
    if (stop.stop_requested()) return false;
    evaluate();
    return true;
  });
}

OffloadLoop::~OffloadLoop() {
  worker_->request_stop();
  worker_->join();
}

void OffloadLoop::evaluate() {
  offload::OffloadRecord record = control_.evaluate();
  record.draining = draining_;
  const policy::Decision& decision = record.decision;
  targets_.uplink.set_mode(offload::to_link(decision.mode));
  targets_.transport.allow_probing(record.bandwidth_matters);
  if (targets_.local != nullptr)
    targets_.local->set_work(decision.mode == policy::Mode::kLocal, decision.prune_and_compress);
  timeline_.add(record);
  if (decision.changed) {
    ++switches_;
    log_change(record);
  }
}

void OffloadLoop::log_change(const offload::OffloadRecord& record) {
  const policy::Situation& s = record.situation;
  EDGESPLAT_LOG_INFO("offload", "mode changed", "mode", policy::to_string(record.decision.mode), "reason",
                     policy::to_string(record.decision.reason), "render_p95_ms",
                     s.render_p95_ms.value_or(0.0), "memory_bytes", s.memory_peak_bytes.value_or(0.0),
                     "bandwidth_bytes_per_s", s.bandwidth_bytes_per_s.value_or(0.0), "round_trip_ms",
                     s.round_trip_ms.value_or(0.0));
}

void OffloadLoop::submit(const std::shared_ptr<const map::Keyframe>& keyframe) {
  if (targets_.local == nullptr || control_.last().decision.mode != policy::Mode::kLocal) return;
  targets_.local->submit(keyframe);
}

}  // namespace edgesplat::app
