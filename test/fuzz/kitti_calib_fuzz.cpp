// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/frame_times.hpp"
#include "robot/drivers/replay/kitti_calib.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>

/// The same text as calibration and as times.txt; what is accepted makes sense.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace edgesplat;
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto camera = replay::parse_kitti_camera(text, "fuzz.txt", 1242, 375);
  if (camera && (!camera->body_from_camera.is_finite() || !camera->model.validate())) std::abort();
  (void)replay::parse_times(text, "times.txt");
  return 0;
}
