// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/impairment.hpp"

#include <algorithm>
#include <functional>

namespace edgesplat::link {

void describe(config::ConfigReader& reader, ImpairmentConfig& c) {
  using config::Range;
  reader.field("shape_at_s", c.shape_at_s, Range{0.0, 1e6},
               "times after the start at which the rate changes, ascending; none = not shaped");
  reader.field("shape_bytes_per_s", c.shape_bytes_per_s, Range{0.0, 1e10}, "the rate from each of them on");
  reader.field("burst_bytes", c.burst_bytes, {1, std::size_t{1} << 24U}, "may pass at once after a pause");
  reader.field("queue_bytes", c.queue_bytes, {1024, std::size_t{1} << 24U}, "waiting in front of the shaper");
  reader.field("delay_ms", c.delay_ms, Range{0.0, 10000.0}, "added to every chunk");
  reader.field("loss", c.loss, Range{0.0, 1.0}, "fraction of chunks that vanish");
  reader.field("duplicate", c.duplicate, Range{0.0, 1.0}, "fraction that come twice");
  reader.field("reorder", c.reorder, Range{0.0, 1.0}, "fraction that later ones overtake");
  reader.field("reorder_ms", c.reorder_ms, Range{0.0, 10000.0}, "by up to this much");
  reader.field("flip_bits", c.flip_bits, Range{0.0, 1.0}, "fraction with one bit inverted");
  reader.field("seed", c.seed, {0, 1'000'000'000}, "decides everything random");
  if (c.shape_at_s.size() != c.shape_bytes_per_s.size()) {
    reader.problem("shape_bytes_per_s", "must have as many entries as shape_at_s");
  }
  if (std::adjacent_find(c.shape_at_s.begin(), c.shape_at_s.end(), std::greater_equal<>()) !=
      c.shape_at_s.end()) {
    reader.problem("shape_at_s", "must ascend");
  }
}

}  // namespace edgesplat::link
