// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/mode_timeline.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

/// Whatever the bytes are: times never go back, and the figures' seconds are those of the time line.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat::report;
  const auto timeline = parse_mode_timeline({reinterpret_cast<const char*>(bytes), size}, "fuzz.jsonl");
  if (timeline.samples.empty()) return 0;
  double last_s = 0.0;
  for (const ModeSample& sample : timeline.samples) {
    if (!(sample.t_s >= last_s)) std::abort();
    last_s = sample.t_s;
  }
  for (const double seconds : figures_of(timeline).seconds) {
    if (!(seconds >= 0.0) || seconds > last_s + 1.0) std::abort();
  }
  if (spans_of(timeline).empty()) std::abort();
  return 0;
}
