// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/delta_stream.hpp"

#include "common/map/delta_codec.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::stream {

Result<std::vector<std::vector<std::byte>>> DeltaStream::add(const gaussian::GaussianCloud& gaussians,
                                                             std::span<const map::ChunkId> chunks) {
  std::vector<std::vector<std::byte>> encoded;
  std::uint64_t seq = seq_;
  for (std::size_t first = 0; first < gaussians.size(); first += max_rows_) {
    const std::size_t end = std::min(first + max_rows_, gaussians.size());
    map::AddDelta delta;
    delta.header.robot = robot_;
    delta.header.map = map_;
    delta.header.epoch = epoch_;
    delta.header.base_seq = seq;
    delta.header.seq = ++seq;
    delta.gaussians.sh_degree = gaussians.sh_degree;
    for (std::size_t row = first; row < end; ++row) {
      delta.gaussians.append_row(gaussians, row);
      delta.chunks.push_back(chunks[row]);
    }
    EDGESPLAT_TRY(auto bytes, map::encode_add(delta));
    encoded.push_back(std::move(bytes));
  }
  seq_ = seq;
  return encoded;
}

}  // namespace edgesplat::stream
