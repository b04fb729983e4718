// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/aravis/camera_config.hpp"
#include "robot/drivers/aravis/gvcp_finder.hpp"

#include <cstdint>
#include <optional>
#include <stop_token>
#include <string>

namespace edgesplat::aravis {

enum class Whereabouts : std::uint8_t {
  kUnmet,      ///< nobody knows yet who it is: whoever is at the configured address
  kHere,       ///< where it was
  kElsewhere,  ///< at another address than when it was last met
  kAway,       ///< answers nowhere
};

/// Who the camera is and where: at the configured address until it was met, from then on wherever its serial
/// number answers. Another camera that got its old address is not it. Thread-bound.
class CameraLocator {
 public:
  explicit CameraLocator(const GigeCameraConfig& config)
      : address_(config.address), wanted_serial_number_(config.serial_number) {}

  /// Looks at its address, then on all of this machine's networks; takes up to 0.2 s.
  [[nodiscard]] Whereabouts locate(const std::stop_token& stop);
  /// Whether it answers at its address; takes up to 0.1 s.
  [[nodiscard]] bool answers(const std::stop_token& stop);
  /// It was opened there: learns who it is.
  void meet(const std::string& address, const std::stop_token& stop);

  /// Where to open it.
  [[nodiscard]] const std::string& address() const { return address_; }
  /// For words: its serial number or its address.
  [[nodiscard]] std::string sought() const;
  /// Empty before it was met.
  [[nodiscard]] std::string serial_number() const { return who_ ? who_->serial_number : std::string(); }

 private:
  [[nodiscard]] bool is_wanted(const FoundCamera& camera) const;

  std::string address_;
  std::string wanted_serial_number_;
  bool met_ = false;                ///< it was opened at address_
  std::optional<FoundCamera> who_;  ///< once it answered there
  GvcpFinder finder_;
};

}  // namespace edgesplat::aravis
