// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/offload/offload_control.hpp"

#include <filesystem>
#include <fstream>
#include <string>

namespace edgesplat::offload {

/// One evaluation as a line of JSON: t_s (since `start`), mode, reason, changed, prune, render_p95_ms,
/// memory_bytes, bandwidth_bytes_per_s, true_bandwidth_bytes_per_s, round_trip_ms, heartbeat_age_s, bytes_up,
/// bytes_down. What is not known is null.
[[nodiscard]] std::string timeline_line(const OffloadRecord& record, HostTime start);

/// Writes a line an evaluation into a file (modes.jsonl of a run folder). A file that cannot be written is
/// said once and costs nothing but itself. Single-owner.
class ModeTimeline {
 public:
  /// An empty path: nothing is written.
  ModeTimeline(const std::filesystem::path& path, HostTime start);
  void add(const OffloadRecord& record);

 private:
  HostTime start_;
  std::ofstream file_;
  bool wanted_;
  bool failed_ = false;
};

}  // namespace edgesplat::offload
