// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/recording.hpp"

#include "common/log/log.hpp"

#include <utility>

namespace edgesplat::app {

Result<std::unique_ptr<Recording>> Recording::start(const std::filesystem::path& path,
                                                    const std::string& rig_toml,
                                                    const std::string& robot_toml,
                                                    const replay::RecorderConfig& config) {
  EDGESPLAT_TRY(auto recorder, replay::Recorder::create(path, rig_toml, robot_toml, config));
  return std::unique_ptr<Recording>(new Recording(std::move(recorder)));
}

Recording::Recording(std::unique_ptr<replay::Recorder> recorder) : recorder_(std::move(recorder)) {
  writer_.emplace(
      thread::Worker("recorder", [this](const std::stop_token& stop) { return write_step(stop); }));
}

bool Recording::write_step(const std::stop_token& stop) {
  const Result<bool> more = recorder_->write_next(stop);
  if (more) return *more;
  EDGESPLAT_LOG_ERROR("recorder", "recording failed, the run goes on", "why", more.error().context);
  return !stop.stop_requested();
}

Status Recording::finish(metrics::Registry& metrics) {
  writer_.reset();
  Status finished = recorder_->finish();
  const replay::RecorderCounters counters = recorder_->counters();
  metrics.counter("recorder.written").add(counters.written);
  metrics.counter("recorder.dropped").add(counters.dropped);
  metrics.counter("recorder.failed").add(counters.failed);
  return finished;
}

}  // namespace edgesplat::app
