// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/prober.hpp"

#include <algorithm>

namespace edgesplat::link {

HostTime Prober::next_train(const Situation& s) const {
  HostTime next{};
  if (last_train_) next = *last_train_ + pause_;
  if (s.bytes_per_s && s.confirmed_at)
    next = std::max(next, *s.confirmed_at + from_seconds(config_.period_s));
  return next;
}

void Prober::begin(const Situation& s, HostTime now) {
  const double bytes_per_s = std::max(s.bytes_per_s.value_or(config_.first_bytes_per_s), 1.0);
  const auto packet = static_cast<double>(config_.packet_bytes);
  const double affordable = config_.share * bytes_per_s * config_.period_s / packet;
  left_ = s.bytes_per_s
              ? static_cast<std::size_t>(std::clamp(affordable, static_cast<double>(config_.least_packets),
                                                    static_cast<double>(config_.packets)))
              : config_.packets;
  gap_ = from_seconds(packet / (2.0 * bytes_per_s));
  const double paid_back_s = static_cast<double>(left_) * packet / (config_.share * bytes_per_s);
  pause_ = from_seconds(s.bytes_per_s ? std::max(config_.period_s, paid_back_s) : config_.period_s);
  last_train_ = now;
  packet_at_ = now;
}

bool Prober::due(const Situation& s, HostTime now) {
  next_.reset();
  begins_train_ = left_ == 0;
  if (!s.allowed) {
    left_ = 0;
    return false;
  }
  if (left_ == 0) {
    const HostTime next = next_train(s);
    if (now < next) next_ = next;
    if (now < next || !s.idle) return false;
    begin(s, now);
  }
  if (now < packet_at_) {
    next_ = packet_at_;
    return false;
  }
  --left_;
  packet_at_ += gap_;
  return true;
}

}  // namespace edgesplat::link
