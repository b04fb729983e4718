// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::link {

/// A link made worse on purpose, for demonstrations and tests: what this end sends is delayed, lost,
/// repeated, overtaken, damaged and held to a rate. Off by default.
struct ImpairmentConfig {
  /// The rate changes at these times after the link was opened, ascending; before the first it is unlimited.
  std::vector<double> shape_at_s;
  std::vector<double> shape_bytes_per_s;  ///< from each of these times on; 0 lets nothing pass
  std::size_t burst_bytes = 4096;         ///< what may pass at once after a pause
  std::size_t queue_bytes =
      64 * 1024;           ///< waiting in front of the narrow place; then the sender is held back
  double delay_ms = 0.0;   ///< added to every chunk
  double loss = 0.0;       ///< fraction of chunks that vanish
  double duplicate = 0.0;  ///< fraction that come twice
  double reorder = 0.0;    ///< fraction that later ones overtake, by up to reorder_ms
  double reorder_ms = 30.0;
  double flip_bits = 0.0;  ///< fraction with one bit of the payload inverted
  std::uint64_t seed = 1;  ///< decides everything random

  [[nodiscard]] bool active() const {
    return !shape_at_s.empty() || delay_ms > 0 || loss > 0 || duplicate > 0 || reorder > 0 || flip_bits > 0;
  }
};

void describe(config::ConfigReader& reader, ImpairmentConfig& config);

/// What an ImpairedPath did so far.
struct ImpairmentCounters {
  std::uint64_t lost = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;
  std::uint64_t flipped = 0;
  std::uint64_t held_back = 0;  ///< writes refused for now because the narrow place's queue was full
};

}  // namespace edgesplat::link
