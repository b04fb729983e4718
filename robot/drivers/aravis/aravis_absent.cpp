// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// AravisCamera in a build without libaravis: there is never a camera.
#include "robot/drivers/aravis/aravis_camera.hpp"

#include "common/base/check.hpp"

namespace edgesplat::aravis {

class AravisCamera::Device {
 public:
  CameraAbilities abilities;
  std::string text;
};

Result<std::unique_ptr<AravisCamera>> AravisCamera::open(const GigeCameraConfig& config, const Clock&) {
  return fail(Errc::kUnavailable,
              "cannot open the camera " + config.address +
                  ": this program was built without libaravis; run tools/setup and build again");
}

AravisCamera::AravisCamera(std::unique_ptr<Device> device) : device_(std::move(device)) {}
AravisCamera::~AravisCamera() = default;
Status AravisCamera::start() {
  return fail(Errc::kUnavailable, "built without libaravis");
}
std::optional<RawFrame> AravisCamera::receive(const std::stop_token&, nanoseconds) {
  return std::nullopt;
}
bool AravisCamera::control_lost() const {
  return true;
}
const CameraAbilities& AravisCamera::abilities() const {
  return device_->abilities;
}
Result<PtpReading> AravisCamera::read_ptp() {
  return fail(Errc::kUnavailable, "built without libaravis");
}
Result<AravisCamera::ClockReading> AravisCamera::read_clock() {
  return fail(Errc::kUnavailable, "built without libaravis");
}
StreamStatistics AravisCamera::statistics() const {
  return {};
}
int AravisCamera::packet_bytes() const {
  return 0;
}
const std::string& AravisCamera::name() const {
  return device_->text;
}
const std::string& AravisCamera::address() const {
  return device_->text;
}
bool has_aravis() {
  return false;
}

}  // namespace edgesplat::aravis
