// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/uplink.hpp"

#include "common/log/log.hpp"
#include "common/map/keyframe_codec.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"

#include <condition_variable>
#include <mutex>
#include <utility>

namespace edgesplat::uplink {

class Uplink::Impl {
 public:
  Impl(const UplinkConfig& config, link::Transport& transport, const Clock& clock, HeartbeatSource heartbeat)
      : config_(config),
        transport_(transport),
        clock_(clock),
        heartbeat_(std::move(heartbeat)),
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

  bool drain(nanoseconds timeout) {
    const HostTime until = clock_.now() + timeout;
    {
      std::unique_lock lock(mutex_);
      const auto all_handed_on = [&] {
        return counters_.handed_on + counters_.refused + queue_.stats().dropped >= counters_.submitted;
      };
      if (!encoded_.wait_for(lock, timeout, all_handed_on)) return false;
    }
    return transport_.drain(link::Lane::kKeyframe, std::max(nanoseconds(0), until - clock_.now()));
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
    const auto keyframe = queue_.pop_for(std::max(nanoseconds(0), next_heartbeat_ - clock_.now()));
    if (stop.stop_requested()) return false;
    if (keyframe && *keyframe) send_keyframe(**keyframe);
    return true;
  }

  void send_keyframe(const map::Keyframe& keyframe) {
    auto bytes = map::encode_keyframe(keyframe);
    if (!bytes) {
      EDGESPLAT_LOG_WARN("uplink", "keyframe refused", "id", keyframe.id.value, "why", bytes.error().context);
    }
    const std::size_t size = bytes ? bytes->size() : 0;
    const bool sent = bytes && transport_.send(link::Lane::kKeyframe, config_.robot, std::move(*bytes));
    {
      const std::lock_guard lock(mutex_);
      ++(sent ? counters_.handed_on : counters_.refused);
      counters_.encoded_bytes += size;
    }
    encoded_.notify_all();
  }

  void send_heartbeat() {
    next_heartbeat_ = clock_.now() + from_seconds(config_.heartbeat_period_s);
    const link::Heartbeat heartbeat = heartbeat_ ? heartbeat_() : link::Heartbeat{};
    (void)transport_.send(link::Lane::kHeartbeat, config_.robot, link::encode_heartbeat(heartbeat));
    const std::lock_guard lock(mutex_);
    ++counters_.heartbeats;
  }

  const UplinkConfig config_;
  link::Transport& transport_;
  const Clock& clock_;
  const HeartbeatSource heartbeat_;
  thread::BoundedQueue<std::shared_ptr<const map::Keyframe>> queue_;
  HostTime next_heartbeat_;
  mutable std::mutex mutex_;
  std::condition_variable encoded_;
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
bool Uplink::drain(nanoseconds timeout) {
  return impl_->drain(timeout);
}
UplinkCounters Uplink::counters() const {
  return impl_->counters();
}

}  // namespace edgesplat::uplink
