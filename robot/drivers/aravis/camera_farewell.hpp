// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/aravis/aravis_camera.hpp"
#include "robot/drivers/aravis/clock_watch.hpp"

#include <memory>
#include <vector>

namespace edgesplat::aravis {

/// Closes cameras that do not answer. libaravis waits for their answers for ten seconds and more, and neither
/// the search for them nor the program's end must: each is closed on a thread of its own. Single-owner.
class CameraFarewell {
 public:
  CameraFarewell() = default;
  CameraFarewell(const CameraFarewell&) = delete;
  CameraFarewell& operator=(const CameraFarewell&) = delete;
  /// Waits until no thread uses the program's clock any more: as long as one question takes, 3 s at most.
  /// What libaravis still does goes with the process.
  ~CameraFarewell();

  void close(std::unique_ptr<AravisCamera> camera, std::unique_ptr<ClockWatch> watch);

 private:
  struct Leaving;
  std::vector<std::shared_ptr<Leaving>> leaving_;
};

}  // namespace edgesplat::aravis
