// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/stream/delta_stream.hpp"

namespace edgesplat::stream {

/// The deltas of one call.
struct DeltaStream::Outbox {
  std::size_t budget_bytes;
  std::size_t most_deltas;
  std::vector<Bytes> deltas = {};
  std::size_t bytes = 0;
  std::size_t last_bytes = 0;  ///< of the last delta

  [[nodiscard]] bool full() const { return bytes >= budget_bytes || deltas.size() >= most_deltas; }
};

/// What became of the changed Gaussians.
struct DeltaStream::Changes {
  std::vector<gaussian::GaussianId> left;  ///< moved into a chunk that the robot does not hold
  map::QuantisedRows added;                ///< new to the robot, or in another chunk than before
  std::vector<Update> updates;
};

}  // namespace edgesplat::stream
