// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/uplink.hpp"

#include "common/log/log.hpp"
#include "common/map/keyframe_codec.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "robot/uplink/slim_keyframe.hpp"

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
        router_(config.router, clock.now()),
        spool_(config.spool),
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
    if (!spool_.empty()) wait = std::min(wait, kSpoolPeriod);
    const auto keyframe = queue_.pop_for(wait);
    if (stop.stop_requested()) return false;
    router_.set_mode(mode_, clock_.now());
    if (keyframe && *keyframe) {
      handle(**keyframe);
    } else {
      send_from_spool();
    }
    return true;
  }

  void handle(const map::Keyframe& keyframe) {
    const bool mode_sends = router_.mode_sends_next();
    const bool lean = router_.mode() == link::OffloadMode::kLean;
    const std::size_t target = lean ? config_.lean_keyframe_bytes : config_.full_keyframe_bytes;
    auto bytes = map::encode_keyframe(slim_keyframe(keyframe, target));
    if (!bytes) {
      EDGESPLAT_LOG_WARN("uplink", "keyframe refused", "id", keyframe.id.value, "why", bytes.error().context);
      count([](UplinkCounters& c) { ++c.refused; });
      return;
    }
    const std::size_t size = bytes->size();
    const auto way = router_.route(mode_sends, size, clock_.now());
    bool sent = false;
    if (way == KeyframeRouter::Way::kSend) {
      sent = transport_.send(link::Lane::kKeyframe, config_.robot, std::move(*bytes));
    } else {
      spool_.put(std::move(*bytes));
    }
    count([&](UplinkCounters& c) {
      c.encoded_bytes += size;
      if (way == KeyframeRouter::Way::kSend) {
        ++(sent ? c.handed_on : c.refused);
      } else {
        ++(way == KeyframeRouter::Way::kKeepMode ? c.kept_by_mode : c.kept_by_budget);
      }
    });
  }

  /// The oldest, when nothing of ours waits for the network.
  void send_from_spool() {
    const auto size = spool_.next_bytes();
    if (!size || router_.mode() == link::OffloadMode::kLocal || !link_is_idle()) return;
    if (!draining_ && !router_.may_send_kept(*size, clock_.now())) return;
    auto bytes = spool_.take();
    if (!bytes) return;
    const bool sent = transport_.send(link::Lane::kSpool, config_.robot, std::move(*bytes));
    count([&](UplinkCounters& c) { ++(sent ? c.handed_on : c.refused); });
  }

  [[nodiscard]] bool link_is_idle() const {
    const link::LinkCounters counters = transport_.counters();
    const auto& keyframes = counters[link::index_of(link::Lane::kKeyframe)];
    const auto& spooled = counters[link::index_of(link::Lane::kSpool)];
    return keyframes.queued_messages + spooled.queued_messages + spooled.flying_messages == 0;
  }

  void send_heartbeat() {
    next_heartbeat_ = clock_.now() + from_seconds(config_.heartbeat_period_s);
    const link::Heartbeat heartbeat = heartbeat_ ? heartbeat_() : link::Heartbeat{};
    (void)transport_.send(link::Lane::kHeartbeat, config_.robot, link::encode_heartbeat(heartbeat));
    count([](UplinkCounters& c) { ++c.heartbeats; });
  }

  template <typename Change>
  void count(const Change& change) {
    {
      const std::lock_guard lock(mutex_);
      change(counters_);
      counters_.spool = spool_.counters();
    }
    changed_.notify_all();
  }

  const UplinkConfig config_;
  link::Transport& transport_;
  const Clock& clock_;
  const HeartbeatSource heartbeat_;
  std::atomic<link::OffloadMode> mode_ = link::OffloadMode::kFull;
  std::atomic<bool> draining_ = false;
  KeyframeRouter router_;  ///< this and the spool: the worker's own
  Spool spool_;
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
