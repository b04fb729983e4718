// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/recorder.hpp"

#include "common/log/log.hpp"
#include "server/store/map_folder.hpp"

#include <utility>

namespace edgesplat::store {

void Recorder::Trouble::note(const Status& status, const char* what) {
  const bool went_well = last.has_value();
  last = status;
  if (status) {
    if (!went_well) EDGESPLAT_LOG_INFO("store", "written again", "what", what);
    return;
  }
  failed.add();
  if (went_well)
    EDGESPLAT_LOG_ERROR("store", "not written; going on without", "what", what, "why",
                        status.error().context);
}

Recorder::Recorder(const RecorderConfig& config, metrics::Registry& registry, const Clock& clock)
    : config_(config),
      clock_(clock),
      keyframes_(registry.counter("store.keyframes")),
      keyframe_bytes_(registry.counter("store.keyframe_bytes")),
      keyframes_dropped_(registry.counter("store.keyframes_dropped")),
      maps_(registry.counter("store.maps")),
      append_ms_(registry.histogram("store.append_ms")),
      save_ms_(registry.histogram("store.save_ms")),
      keyframe_trouble_{registry.counter("store.keyframes_failed")},
      map_trouble_{registry.counter("store.maps_failed")},
      queue_({config.queue_keyframes, config.queue_bytes}, thread::Overflow::kDropNewest) {
  writer_.emplace("store", [this](const std::stop_token& stop) { return step(stop); });
}

Recorder::~Recorder() {
  finish();
}

void Recorder::keyframe(LoggedKeyframe keyframe) {
  const std::size_t size_bytes = keyframe.bytes.size();
  if (queue_.push(std::move(keyframe), size_bytes) != thread::PushResult::kAccepted) keyframes_dropped_.add();
}

bool Recorder::map(StoredMap map) {
  ++maps_waiting_;
  // Counted as one item only: at most one map of each robot waits, and its memory is the map's own kind.
  if (queue_.push(std::move(map)) == thread::PushResult::kAccepted) return true;
  --maps_waiting_;
  map_trouble_.failed.add();
  return false;
}

bool Recorder::step(const std::stop_token& /*stop*/) {
  if (!log_) open_log();
  const auto job = queue_.pop();
  if (!job) return false;
  if (const auto* keyframe = std::get_if<LoggedKeyframe>(&*job)) {
    keyframe_trouble_.note(append(*keyframe), "keyframe");
  } else {
    save(std::get<StoredMap>(*job));
    --maps_waiting_;
  }
  return true;
}

void Recorder::open_log() {
  auto opened = KeyframeLog::open(config_.folder, config_.log);
  log_opened_ = opened ? Status{} : fail(opened.error().code, opened.error().context);
  if (opened) log_ = *std::move(opened);
}

Status Recorder::append(const LoggedKeyframe& keyframe) {
  if (!log_) return log_opened_;
  const metrics::ScopedTimerMs timer(append_ms_, clock_);
  EDGESPLAT_TRY_STATUS(log_->append(keyframe.robot, keyframe.session, keyframe.bytes));
  keyframes_.add();
  keyframe_bytes_.add(keyframe.bytes.size());
  return {};
}

void Recorder::save(const StoredMap& map) {
  const metrics::ScopedTimerMs timer(save_ms_, clock_);
  const Status saved = save_map(map_path(config_.folder, map.robot, map.map), map);
  if (saved) maps_.add();
  map_trouble_.note(saved, "map");
}

void Recorder::finish(const std::vector<StoredMap>& last) {
  queue_.close();
  if (!writer_) return;
  writer_->join();
  writer_.reset();
  for (const StoredMap& map : last) save(map);
}

Status Recorder::outcome() const {
  return map_trouble_.last ? keyframe_trouble_.last : map_trouble_.last;
}

}  // namespace edgesplat::store
