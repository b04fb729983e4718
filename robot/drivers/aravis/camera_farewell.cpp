// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/camera_farewell.hpp"

#include <atomic>
#include <thread>
#include <utility>

namespace edgesplat::aravis {

struct CameraFarewell::Leaving {
  std::unique_ptr<AravisCamera> camera;
  std::unique_ptr<ClockWatch> watch;
  std::atomic<bool> asks_no_more{false};
};

CameraFarewell::~CameraFarewell() {
  for (const auto& one : leaving_) one->asks_no_more.wait(false);
}

void CameraFarewell::close(std::unique_ptr<AravisCamera> camera, std::unique_ptr<ClockWatch> watch) {
  std::erase_if(leaving_, [](const auto& one) { return one.use_count() == 1; });
  leaving_.push_back(std::make_shared<Leaving>());
  leaving_.back()->camera = std::move(camera);
  leaving_.back()->watch = std::move(watch);
  std::thread([one = leaving_.back()] {
    one->watch.reset();
    one->asks_no_more = true;
    one->asks_no_more.notify_all();
    one->camera.reset();
  }).detach();
}

}  // namespace edgesplat::aravis
