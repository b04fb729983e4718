// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/downlink.hpp"

#include "common/log/log.hpp"
#include "common/metrics/counter.hpp"
#include "common/thread/worker.hpp"

#include <utility>

namespace edgesplat::uplink {

class Downlink::Impl {
 public:
  Impl(link::Transport& transport, DownlinkHandlers handlers)
      : transport_(transport),
        handlers_(std::move(handlers)),
        worker_("downlink", [this](const std::stop_token& stop) { return step(stop); }) {}

  [[nodiscard]] DownlinkCounters counters() const {
    return {deltas_.value(), heartbeats_.value(), heartbeats_corrupt_.value()};
  }

 private:
  bool step(const std::stop_token& stop) {
    const auto message = transport_.receive(std::chrono::milliseconds(50));
    if (stop.stop_requested()) return false;
    if (!message) {
      if (transport_.finished()) return false;
      if (handlers_.on_idle) handlers_.on_idle();
    } else if (message->lane == link::Lane::kDelta) {
      deltas_.add();
      if (handlers_.on_delta) handlers_.on_delta(message->bytes);
    } else if (message->lane == link::Lane::kHeartbeat) {
      take_heartbeat(message->bytes);
    }
    return true;
  }

  void take_heartbeat(std::span<const std::byte> bytes) {
    const auto heartbeat = link::decode_heartbeat(bytes);
    if (!heartbeat) {
      heartbeats_corrupt_.add();
      if (!bad_said_) EDGESPLAT_LOG_WARN("downlink", "bad heartbeat", "why", heartbeat.error().context);
      bad_said_ = true;
      return;
    }
    bad_said_ = false;
    heartbeats_.add();
    if (handlers_.on_heartbeat) handlers_.on_heartbeat(*heartbeat);
  }

  link::Transport& transport_;
  const DownlinkHandlers handlers_;
  metrics::Counter deltas_;
  metrics::Counter heartbeats_;
  metrics::Counter heartbeats_corrupt_;
  bool bad_said_ = false;  ///< of the worker: since the last good one
  thread::Worker worker_;
};

Downlink::Downlink(link::Transport& transport, DownlinkHandlers handlers)
    : impl_(std::make_unique<Impl>(transport, std::move(handlers))) {}
Downlink::~Downlink() = default;

DownlinkCounters Downlink::counters() const {
  return impl_->counters();
}

}  // namespace edgesplat::uplink
