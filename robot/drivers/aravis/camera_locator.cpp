// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/camera_locator.hpp"

#include <chrono>
#include <utility>

namespace edgesplat::aravis {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(100);  // cameras answer within a few

}  // namespace

bool CameraLocator::is_wanted(const FoundCamera& camera) const {
  if (who_) return is_same_camera(*who_, camera);
  return wanted_serial_number_.empty() || camera.serial_number == wanted_serial_number_;
}

bool CameraLocator::answers(const std::stop_token& stop) {
  const auto camera = finder_.ask(address_, stop, kPatience);
  if (!camera || !is_wanted(*camera)) return false;
  if (met_ && !who_) who_ = camera;
  return true;
}

Whereabouts CameraLocator::locate(const std::stop_token& stop) {
  const bool is_known = who_.has_value() || !wanted_serial_number_.empty();
  if (!is_known && !met_) return Whereabouts::kUnmet;
  if (answers(stop)) return Whereabouts::kHere;
  if (!is_known) return Whereabouts::kAway;
  const auto camera =
      finder_.find([this](const FoundCamera& one) { return is_wanted(one); }, stop, kPatience);
  if (!camera) return Whereabouts::kAway;
  if (camera->address == address_) return Whereabouts::kHere;
  address_ = camera->address;
  return std::exchange(met_, false) ? Whereabouts::kElsewhere : Whereabouts::kHere;
}

std::string CameraLocator::sought() const {
  const std::string& serial_number = who_ ? who_->serial_number : wanted_serial_number_;
  return serial_number.empty() ? address_ : serial_number;
}

void CameraLocator::meet(const std::string& address, const std::stop_token& stop) {
  address_ = address;
  met_ = true;
  if (!who_) (void)answers(stop);
}

}  // namespace edgesplat::aravis
