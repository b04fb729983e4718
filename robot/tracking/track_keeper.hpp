// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/scan_update.hpp"
#include "robot/tracking/tracked_group.hpp"

namespace edgesplat::tracking {

/// What a group's updates showed.
struct GroupEvidence {
  bool scan_fits = false;         ///< the scan was aligned, and as well as usual
  bool scan_sees_all = false;     ///< in every direction
  bool picture = false;           ///< the picture was aligned
  double position_sigma_m = 0.0;  ///< after both
  double dt_s = 0.0;
};

/// Judges whether scans fit, and what state tracking is in: tracking, degraded while a direction or the LiDAR
/// is missing, coasting while there is nothing, lost when that went on too long, recovered for a second after
/// a scan fitted again. Single-owner.
class TrackKeeper {
 public:
  /// The share of matched points within the gate is about what it was lately.
  [[nodiscard]] bool fits(const ScanUpdateResult& scan) const;
  /// A scan that was believed: what later ones are held against.
  void learn(const ScanUpdateResult& scan);
  TrackingState next(const GroupEvidence& evidence);

  [[nodiscard]] bool lost() const { return lost_; }
  [[nodiscard]] double lost_s() const { return lost_s_; }
  /// The map was begun anew: there is nothing to be found again.
  void restart() { *this = TrackKeeper{}; }

 private:
  double usual_share_ = 0.0;
  double blind_s_ = 0.0;  ///< since anything was aligned
  double lost_s_ = 0.0;
  double recovered_s_ = 0.0;  ///< left to be called recovered
  bool lost_ = false;
};

}  // namespace edgesplat::tracking
