// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/offload/mode_timeline.hpp"

#include "common/log/log.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace edgesplat::offload {
namespace {

nlohmann::json or_null(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  return std::round(*value * 1000.0) / 1000.0;
}

}  // namespace

std::string timeline_line(const OffloadRecord& record, HostTime start) {
  const policy::Situation& s = record.situation;
  nlohmann::ordered_json line;
  line["t_s"] = or_null(to_seconds(record.at - start));
  line["mode"] = policy::to_string(record.decision.mode);
  line["reason"] = policy::to_string(record.decision.reason);
  line["changed"] = record.decision.changed;
  line["prune"] = record.decision.prune_and_compress;
  line["render_p95_ms"] = or_null(s.render_p95_ms);
  line["memory_bytes"] = or_null(s.memory_peak_bytes);
  line["bandwidth_bytes_per_s"] = or_null(s.bandwidth_bytes_per_s);
  line["true_bandwidth_bytes_per_s"] = or_null(record.shaped_bytes_per_s);
  line["round_trip_ms"] = or_null(s.round_trip_ms);
  std::optional<double> age_s;
  if (s.last_heartbeat) age_s = to_seconds(s.now - *s.last_heartbeat);
  line["heartbeat_age_s"] = or_null(age_s);
  line["bytes_up"] = record.bytes_up;
  line["bytes_down"] = record.bytes_down;
  line["draining"] = record.draining;
  return line.dump();
}

ModeTimeline::ModeTimeline(const std::filesystem::path& path, HostTime start)
    : start_(start), wanted_(!path.empty()) {
  if (wanted_) file_.open(path, std::ios::trunc);
}

void ModeTimeline::add(const OffloadRecord& record) {
  if (!wanted_ || failed_) return;
  file_ << timeline_line(record, start_) << '\n' << std::flush;
  if (file_) return;
  failed_ = true;
  EDGESPLAT_LOG_WARN("offload", "the timeline of modes cannot be written");
}

}  // namespace edgesplat::offload
