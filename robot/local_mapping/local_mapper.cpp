// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/local_mapping/local_mapper.hpp"

#include "common/thread/step_back.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::local_mapping {

Result<std::unique_ptr<LocalMapper>> LocalMapper::create(const LocalMappingConfig& config, map::RobotId robot,
                                                         Pace pace, Listener on_map, const Clock& clock,
                                                         metrics::Registry& registry) {
  EDGESPLAT_TRY(LocalMap map, LocalMap::create(config, robot, clock));
  return std::unique_ptr<LocalMapper>(
      new LocalMapper(config, std::move(map), pace, std::move(on_map), clock, registry));
}

LocalMapper::LocalMapper(const LocalMappingConfig& config, LocalMap map, Pace pace, Listener on_map,
                         const Clock& clock, metrics::Registry& registry)
    : config_(config),
      pace_(pace),
      on_map_(std::move(on_map)),
      clock_(clock),
      step_ms_(registry.histogram("local.step_ms")),
      keyframe_ms_(registry.histogram("local.keyframe_ms")),
      inbox_(config.queue_keyframes),
      arena_(pace == Pace::kInline ? tbb::task_arena::automatic : 1),
      map_(std::move(map)),
      rest_until_(clock.now()),
      last_publish_(clock.now()) {
  if (pace_ != Pace::kOwnThread) return;
  worker_.emplace("local-map", [this, begun = false](const std::stop_token& stop) mutable {
    if (!std::exchange(begun, true)) thread::step_back();  // sensing and rendering go first
    return round(stop);
  });
}

LocalMapper::~LocalMapper() {
  if (!worker_) return;
  worker_->request_stop();
  worker_->join();
}

void LocalMapper::set_work(bool map_here, bool prune_and_compress) {
  inbox_.set_work(map_here, prune_and_compress);
  run_inline();
}

void LocalMapper::submit(std::shared_ptr<const map::Keyframe> keyframe) {
  inbox_.submit(std::move(keyframe));
  run_inline();
}

void LocalMapper::set_resident(std::shared_ptr<const gaussian::GaussianCloud> in_odom) {
  inbox_.set_resident(std::move(in_odom));
  run_inline();
}

void LocalMapper::retire(std::vector<std::uint32_t> mapped_keyframes) {
  inbox_.retire(std::move(mapped_keyframes));
  run_inline();
}

bool LocalMapper::settle(nanoseconds timeout) {
  if (pace_ == Pace::kOwnThread) return inbox_.settle(timeout);
  const std::lock_guard lock(map_mutex_);
  publish_where_due(true);
  return true;
}

void LocalMapper::run_inline() {
  if (pace_ == Pace::kOwnThread) return;
  const std::lock_guard lock(map_mutex_);
  const Inbox::Round round = inbox_.take({}, nanoseconds(0), true);
  obey(round);
  if (round.keyframe) {
    work(round);
    for (int step = 0; step < config_.lockstep_steps && map_.has_work(); ++step) work({});
  }
  publish_where_due(true);
}

std::optional<nanoseconds> LocalMapper::patience(HostTime now) const {
  const std::lock_guard lock(map_mutex_);
  std::optional<nanoseconds> most;
  if (now < rest_until_) {
    most = rest_until_ - now;
  } else if (map_.has_work()) {
    most = nanoseconds(0);
  }
  if (map_.revision() != published_revision_) {
    const nanoseconds due = last_publish_ + from_seconds(config_.publish_period_s) - now;
    most = std::min(most.value_or(due), std::max(due, nanoseconds(0)));
  }
  return most;
}

bool LocalMapper::round(const std::stop_token& stop) {
  const HostTime now = clock_.now();
  bool rested = false;
  {
    const std::lock_guard lock(map_mutex_);
    rested = now >= rest_until_;
  }
  const Inbox::Round round = inbox_.take(stop, patience(now), rested);
  if (stop.stop_requested()) return false;
  const std::lock_guard lock(map_mutex_);
  obey(round);
  if (round.keyframe || (rested && map_.has_work())) work(round);
  publish_where_due(!round.mapped.empty() || inbox_.settling());
  inbox_.done();
  return true;
}

void LocalMapper::obey(const Inbox::Round& round) {
  if (round.resident_in_odom) map_.set_resident(*round.resident_in_odom);
  if (round.map_here) map_.set_here(*round.map_here);
  map_.retire(round.mapped);
  if (round.prune) map_.prune_and_compress();
}

void LocalMapper::work(const Inbox::Round& round) {
  const HostTime start = clock_.now();
  arena_.execute([&] {
    if (round.keyframe) {
      map_.add(*round.keyframe);
    } else {
      map_.step();
    }
  });
  const HostTime end = clock_.now();
  (round.keyframe ? keyframe_ms_ : step_ms_).record(to_seconds(end - start) * 1e3);
  rest_until_ = end + from_seconds(to_seconds(end - start) * (1.0 / config_.core_share - 1.0));
}

void LocalMapper::publish_where_due(bool at_once) {
  const std::uint64_t revision = map_.revision();
  const HostTime now = clock_.now();
  const bool due = at_once || now - last_publish_ >= from_seconds(config_.publish_period_s);
  if (revision == published_revision_ || !due) return;
  published_revision_ = revision;
  last_publish_ = now;
  ++published_;
  on_map_(std::make_shared<const gaussian::GaussianCloud>(map_.cloud()));
}

void LocalMapper::publish_counters(metrics::Registry& metrics) const {
  const std::lock_guard lock(map_mutex_);
  const LocalMapCounters counters = map_.counters();
  metrics.counter("local.keyframes").add(counters.keyframes);
  metrics.counter("local.dropped").add(inbox_.dropped());
  metrics.counter("local.bad_pictures").add(counters.bad_pictures);
  metrics.counter("local.steps").add(counters.steps);
  metrics.counter("local.pruned").add(counters.pruned);
  metrics.counter("local.retired").add(counters.retired);
  metrics.counter("local.dropped_views").add(counters.dropped_views);
  metrics.counter("local.published").add(published_);
  metrics.gauge("local.gaussians").set(static_cast<double>(counters.gaussians));
  metrics.gauge("local.views").set(static_cast<double>(counters.views));
}

}  // namespace edgesplat::local_mapping
