// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/peer_link.hpp"

#include <algorithm>

namespace edgesplat::link {
namespace {

constexpr nanoseconds kProbeGone = std::chrono::seconds(2);
constexpr double kLeastPipe_s = 0.05;                  // receivers take their time
constexpr std::size_t kLeastWindow_bytes = 32 * 1024;  // two chunks
constexpr std::size_t kMostWindow_bytes = 2U << 20U;

}  // namespace

bool PeerLink::meet(std::uint64_t session) {
  if (session == session_) return true;
  if (session == former_session_) return false;
  if (session_ != 0) {
    estimator = BandwidthEstimator(bandwidth_);
    prober = Prober(probe_);
  }
  former_session_ = session_;
  session_ = session;
  return true;
}

void PeerLink::sent_single(Lane lane, std::uint32_t train, HostTime now) {
  auto& log = lane == Lane::kProbe ? probes_ : heartbeats_;
  log[train % kRemembered] = {train, now};
  if (lane != Lane::kProbe) return;
  last_probe_sent_ = train;
  last_probe_at_ = now;
}

Flight::News PeerLink::on_single_ack(const Ack& ack, nanoseconds came_after, HostTime now) {
  Flight::News news;
  const bool probe = ack.lane == Lane::kProbe;
  std::uint32_t& last_came = probe ? last_probe_came_ : last_heartbeat_came_;
  const Sent& sent = (probe ? probes_ : heartbeats_)[ack.newest_train % kRemembered];
  if (ack.newest_train == 0 || ack.newest_train == last_came || sent.train != ack.newest_train) return news;
  last_came = ack.newest_train;
  news.chunks_came = 1;
  news.newest_sent = sent.at;
  news.round_trip = std::max(nanoseconds(0), now - sent.at - came_after);
  return news;
}

std::size_t PeerLink::probes_on_the_way(HostTime now) const {
  if (now - last_probe_at_ > kProbeGone || last_probe_sent_ <= last_probe_came_) return 0;
  return last_probe_sent_ - last_probe_came_;
}

std::size_t PeerLink::window_bytes() const {
  const auto bytes_per_s = estimator.bytes_per_s();
  if (!bytes_per_s) return 2 * kLeastWindow_bytes;
  const double round_trip_s = to_seconds(estimator.least_round_trip().value_or(nanoseconds(0)));
  const double bytes = 2.0 * *bytes_per_s * std::max(round_trip_s, kLeastPipe_s);
  return static_cast<std::size_t>(
      std::clamp(bytes, static_cast<double>(kLeastWindow_bytes), static_cast<double>(kMostWindow_bytes)));
}

}  // namespace edgesplat::link
