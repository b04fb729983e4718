// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/uplink.hpp"

#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace edgesplat::uplink {
namespace {

constexpr nanoseconds kSpoolPeriod = std::chrono::milliseconds(50);  // looked at that often while not empty

}  // namespace

class Uplink::Impl {
 public:
  Impl(const UplinkConfig& config, link::Transport& transport, const Clock& clock, HeartbeatSource heartbeat)
      : config_(config),
        transport_(transport),
        clock_(clock),
        heartbeat_(std::move(heartbeat)),
        sender_(config, transport, clock),
        queue_({config.queue_keyframes}, thread::Overflow::kDropOldest),
        next_heartbeat_(clock.now()),
        worker_("uplink", [this](const std::stop_token& stop) { return step(stop); }) {}

  ~Impl() {
    worker_.request_stop();
    queue_.close();
    worker_.join();
  }

  bool submit(std::shared_ptr<const map::Keyframe> keyframe) {
    {
      const std::lock_guard lock(mutex_);
      ++counters_.submitted;
    }
    const auto result = queue_.push(std::move(keyframe));
    return result == thread::PushResult::kAccepted;
  }

  void set_mode(link::OffloadMode mode) { mode_ = mode; }

  bool drain(nanoseconds timeout) {
    const HostTime until = clock_.now() + timeout;
    draining_ = true;
    {
      std::unique_lock lock(mutex_);
      const auto nothing_left = [&] {
        const UplinkCounters& c = counters_;
        const auto handled = c.handed_on - c.spool.taken + c.refused + c.kept_by_mode + c.kept_by_budget;
        return handled + queue_.stats().dropped >= c.submitted && c.spool.items == 0;
      };
      if (!changed_.wait_for(lock, timeout, nothing_left)) return false;
    }
    const auto drained = [&](link::Lane lane) {
      return transport_.drain(lane, std::max(nanoseconds(0), until - clock_.now()));
    };
    return drained(link::Lane::kKeyframe) && drained(link::Lane::kSpool);
  }

  [[nodiscard]] UplinkCounters counters() const {
    const std::lock_guard lock(mutex_);
    UplinkCounters counters = counters_;
    counters.dropped = queue_.stats().dropped;
    return counters;
  }

 private:
  bool step(const std::stop_token& stop) {
    if (clock_.now() >= next_heartbeat_) send_heartbeat();
    nanoseconds wait = std::max(nanoseconds(0), next_heartbeat_ - clock_.now());
    if (!sender_.spool_empty()) wait = std::min(wait, kSpoolPeriod);
    const auto keyframe = queue_.pop_for(wait);
    if (stop.stop_requested()) return false;
    sender_.set_mode(mode_);
    if (keyframe && *keyframe) {
      sender_.send(**keyframe);
    } else {
      sender_.send_spooled(draining_);
    }
    publish_counters();
    return true;
  }

  void send_heartbeat() {
    next_heartbeat_ = clock_.now() + from_seconds(config_.heartbeat_period_s);
    const link::Heartbeat heartbeat = heartbeat_ ? heartbeat_() : link::Heartbeat{};
    (void)transport_.send(link::Lane::kHeartbeat, config_.robot, link::encode_heartbeat(heartbeat));
    const std::lock_guard lock(mutex_);
    ++counters_.heartbeats;
  }

  void publish_counters() {
    {
      const std::lock_guard lock(mutex_);
      static_cast<SenderCounters&>(counters_) = sender_.counters();
    }
    changed_.notify_all();
  }

  const UplinkConfig config_;
  link::Transport& transport_;
  const Clock& clock_;
  const HeartbeatSource heartbeat_;
  std::atomic<link::OffloadMode> mode_ = link::OffloadMode::kFull;
  std::atomic<bool> draining_ = false;
  KeyframeSender sender_;  ///< the worker's own
  thread::BoundedQueue<std::shared_ptr<const map::Keyframe>> queue_;
  HostTime next_heartbeat_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  UplinkCounters counters_;
  thread::Worker worker_;
};

Uplink::Uplink(const UplinkConfig& config, link::Transport& transport, const Clock& clock,
               HeartbeatSource heartbeat)
    : impl_(std::make_unique<Impl>(config, transport, clock, std::move(heartbeat))) {}
Uplink::~Uplink() = default;

bool Uplink::submit(std::shared_ptr<const map::Keyframe> keyframe) {
  return impl_->submit(std::move(keyframe));
}
void Uplink::set_mode(link::OffloadMode mode) {
  impl_->set_mode(mode);
}
bool Uplink::drain(nanoseconds timeout) {
  return impl_->drain(timeout);
}
UplinkCounters Uplink::counters() const {
  return impl_->counters();
}

}  // namespace edgesplat::uplink
