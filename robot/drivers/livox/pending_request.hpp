// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"
#include "robot/drivers/livox/endpoint.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace edgesplat::livox {

/// The one request that waits for its acknowledgement. Requests of this driver may safely be repeated, so
/// they are after a short while: an answer takes some ms. Single-owner.
class PendingRequest {
 public:
  enum class Due : std::uint8_t { kNothing, kRepeat, kGiveUp };

  PendingRequest(nanoseconds timeout, int tries) : timeout_(timeout), tries_(tries) {}

  void begin(Endpoint to, std::uint32_t sequence, std::vector<std::byte> bytes, HostTime now) {
    to_ = to;
    sequence_ = sequence;
    bytes_ = std::move(bytes);
    left_ = tries_ - 1;
    deadline_ = now + timeout_;
  }
  /// True if this acknowledges the request, which is over then.
  [[nodiscard]] bool acknowledge(std::uint32_t sequence) {
    if (!deadline_ || sequence != sequence_) return false;
    deadline_.reset();
    return true;
  }
  [[nodiscard]] Due due(HostTime now) {
    if (!deadline_ || now < *deadline_) return Due::kNothing;
    if (left_ == 0) {
      deadline_.reset();
      return Due::kGiveUp;
    }
    --left_;
    deadline_ = now + timeout_;
    return Due::kRepeat;
  }
  void forget() { deadline_.reset(); }
  [[nodiscard]] bool waits() const { return deadline_.has_value(); }
  [[nodiscard]] HostTime next_due() const { return deadline_.value_or(HostTime::max()); }
  [[nodiscard]] const Endpoint& to() const { return to_; }
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  nanoseconds timeout_;
  int tries_;
  Endpoint to_;
  std::uint32_t sequence_ = 0;
  std::vector<std::byte> bytes_;
  int left_ = 0;
  std::optional<HostTime> deadline_;
};

}  // namespace edgesplat::livox
