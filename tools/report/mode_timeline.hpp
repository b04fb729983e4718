// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::report {

/// What the robot does itself and what it leaves to the server.
enum class RunMode { kLocal, kLean, kFull };
inline constexpr std::array<const char*, 3> kRunModeNames = {"LOCAL", "LEAN", "FULL"};
[[nodiscard]] constexpr std::size_t index_of(RunMode mode) {
  return static_cast<std::size_t>(mode);
}

/// One evaluation of the robot's offloading. NaN is "not known".
struct ModeSample {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double t_s = 0.0;
  RunMode mode = RunMode::kLocal;
  double render_p95_ms = kUnknown;
  double memory_bytes = kUnknown;
  double bandwidth_bytes_per_s = kUnknown;       ///< the robot's estimate
  double true_bandwidth_bytes_per_s = kUnknown;  ///< where the link is shaped on purpose
  double bytes_up = kUnknown;                    ///< since the start
  double bytes_down = kUnknown;
  bool draining = false;        ///< the run is over: what is left goes up at any cost
  double gaussians = kUnknown;  ///< on the robot, where the run wrote it
};

/// robot/modes.jsonl of a run folder, in order of time.
struct ModeTimeline {
  static constexpr std::size_t kMaxSamples = 200'000;  // a day at two evaluations a second
  std::vector<ModeSample> samples;
  std::size_t skipped = 0;    ///< lines that are none, go back in time or are over the limit
  std::string first_skipped;  ///< the first of them and why: "modes.jsonl:3: no mode"
};

/// Never fails: a line that cannot be used is skipped and counted. Empty lines do not count.
[[nodiscard]] ModeTimeline parse_mode_timeline(std::string_view text, std::string_view file_name);

/// A time in one mode: from its first evaluation to the next mode's first.
struct ModeSpan {
  RunMode mode = RunMode::kLocal;
  double begin_s = 0.0;
  double end_s = 0.0;
};
[[nodiscard]] std::vector<ModeSpan> spans_of(const ModeTimeline& timeline);

/// What the time line says in numbers. The time and the bytes between two evaluations are those of the
/// earlier one's mode.
struct ModeFigures {
  std::array<double, 3> seconds{};  ///< by index_of()
  std::size_t switches = 0;
  /// Mean in each mode until the end of the input; nothing where it was not in it.
  std::array<std::optional<double>, 3> bytes_up_per_s;
  std::optional<double> bytes_down_per_s;  ///< mean of the whole time line
};
[[nodiscard]] ModeFigures figures_of(const ModeTimeline& timeline);

}  // namespace edgesplat::report
