// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/track_keeper.hpp"

#include <algorithm>

namespace edgesplat::tracking {
namespace {

/// A scan in which less than this part of the usual share is within the gate lies wrongly.
constexpr double kWorstShare = 0.6;
constexpr double kForget = 0.05;
/// An IMU alone is trusted for so long, or until its position is this doubtful.
constexpr double kBlind_s = 2.0;
constexpr double kBlindSigma_m = 0.5;
constexpr double kRecovered_s = 1.0;
constexpr double kRounding_s = 1e-6;

double share_of(const ScanUpdateResult& scan) {
  return static_cast<double>(scan.last.used) / std::max(1, scan.last.matched);
}

}  // namespace

bool TrackKeeper::fits(const ScanUpdateResult& scan) const {
  return scan.updated && share_of(scan) > kWorstShare * usual_share_;
}

void TrackKeeper::learn(const ScanUpdateResult& scan) {
  const double share = share_of(scan);
  usual_share_ += (usual_share_ > 0.0 ? kForget : 1.0) * (share - usual_share_);
}

TrackingState TrackKeeper::next(const GroupEvidence& evidence) {
  const bool blind = !evidence.scan_fits && !evidence.picture;
  blind_s_ = blind ? blind_s_ + evidence.dt_s : 0.0;
  if (blind && (blind_s_ > kBlind_s + kRounding_s || evidence.position_sigma_m > kBlindSigma_m)) lost_ = true;
  if (lost_ && evidence.scan_fits) {
    lost_ = false;
    recovered_s_ = kRecovered_s;
  }
  lost_s_ = lost_ ? lost_s_ + evidence.dt_s : 0.0;
  if (lost_) return TrackingState::kLost;
  if (blind) return TrackingState::kCoasting;
  if (recovered_s_ > kRounding_s) {
    recovered_s_ -= evidence.dt_s;
    return TrackingState::kRecovered;
  }
  const bool whole = evidence.scan_fits && (evidence.scan_sees_all || evidence.picture);
  return whole ? TrackingState::kTracking : TrackingState::kDegraded;
}

}  // namespace edgesplat::tracking
