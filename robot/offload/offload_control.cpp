// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/offload/offload_control.hpp"

#include <utility>

namespace edgesplat::offload {
namespace {

constexpr nanoseconds kWindow = std::chrono::seconds(2);

}  // namespace

link::OffloadMode to_link(policy::Mode mode) {
  switch (mode) {
    case policy::Mode::kLocal:
      return link::OffloadMode::kLocal;
    case policy::Mode::kLean:
      return link::OffloadMode::kLean;
    case policy::Mode::kFull:
      return link::OffloadMode::kFull;
  }
  return link::OffloadMode::kLocal;
}

OffloadControl::OffloadControl(const policy::OffloadConfig& config, OffloadSources sources,
                               const Clock& clock)
    : config_(config),
      sources_(std::move(sources)),
      clock_(clock),
      policy_(config),
      render_ms_(kWindow),
      memory_bytes_(kWindow) {}

void OffloadControl::on_picture(double render_ms) {
  const std::lock_guard lock(mutex_);
  render_ms_.add(render_ms, clock_.now());
}

void OffloadControl::on_server_heartbeat(bool in_step) {
  const std::lock_guard lock(mutex_);
  last_heartbeat_ = clock_.now();
  in_step_ = in_step;
}

bool OffloadControl::offload_failed(const link::LinkCounters& counters) {
  const std::uint64_t given_up = counters[link::index_of(link::Lane::kKeyframe)].messages_given_up;
  return given_up > std::exchange(given_up_before_, given_up);
}

OffloadRecord OffloadControl::evaluate() {
  // Asked before the lock is taken: the sources may take locks of their own.
  const link::LinkQuality quality = sources_.link();
  const link::LinkCounters counters = sources_.counters();
  const auto memory_bytes = static_cast<double>(sources_.memory_bytes());
  const std::lock_guard lock(mutex_);
  const HostTime now = clock_.now();
  memory_bytes_.add(memory_bytes, now);
  if (in_step_) resync_due_ = false;
  OffloadRecord record;
  record.at = now;
  policy::Situation& s = record.situation;
  s.now = now;
  s.render_p95_ms = render_ms_.p95(now);
  s.memory_peak_bytes = memory_bytes_.largest(now);
  s.bandwidth_bytes_per_s = quality.bandwidth_bytes_per_s;
  s.round_trip_ms = quality.round_trip_ms;
  s.last_heartbeat = last_heartbeat_;
  s.in_step = !resync_due_;
  s.offload_failed = offload_failed(counters);
  record.decision = policy_.evaluate(s);
  if (record.decision.changed && record.decision.reason == policy::Reason::kServerLost) {
    resync_due_ = true;
    in_step_ = false;
  }
  record.shaped_bytes_per_s = quality.shaped_bytes_per_s;
  for (const link::LaneCounters& lane : counters) {
    record.bytes_up += lane.bytes_sent;
    record.bytes_down += lane.bytes_received;
  }
  record.offload_wanted = policy_.wants_offload(s);
  record.bandwidth_matters = policy_.bandwidth_matters(s);
  last_ = record;
  return record;
}

OffloadRecord OffloadControl::last() const {
  const std::lock_guard lock(mutex_);
  return last_;
}

}  // namespace edgesplat::offload
