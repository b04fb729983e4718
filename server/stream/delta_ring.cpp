// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/delta_ring.hpp"

#include "common/base/check.hpp"

#include <utility>

namespace edgesplat::stream {

void DeltaRing::push(std::uint64_t seq, std::vector<std::byte> bytes) {
  if (deltas_.empty()) first_seq_ = seq;
  EDGESPLAT_CHECK(seq == first_seq_ + deltas_.size(), "deltas come in order");
  bytes_ += bytes.size();
  deltas_.push_back(std::move(bytes));
  while (!deltas_.empty() && (deltas_.size() > max_deltas_ || bytes_ > max_bytes_)) {
    bytes_ -= deltas_.front().size();
    deltas_.pop_front();
    ++first_seq_;
  }
}

bool DeltaRing::holds(std::uint64_t seq) const {
  return seq >= first_seq_ && seq < first_seq_ + deltas_.size();
}

std::span<const std::byte> DeltaRing::at(std::uint64_t seq) const {
  EDGESPLAT_CHECK(holds(seq), "the ring holds it");
  return deltas_[static_cast<std::size_t>(seq - first_seq_)];
}

}  // namespace edgesplat::stream
