// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/virtual_camera.hpp"

#include "common/base/check.hpp"
#include "common/io/image_file.hpp"
#include "common/io/trajectory_file.hpp"
#include "common/thread/parallel_for.hpp"
#include "tools/simulate/camera_render.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <system_error>

namespace edgesplat::simulate {
namespace {

constexpr double kReadout_s = 0.012;        // end of exposure to the last byte at the host
constexpr double kArrivalJitter_s = 0.001;  // mean
constexpr int kJpegQuality = 95;

sensor::ImageGray16 depth_in_mm(const sensor::ImageF32& depth_m) {
  sensor::ImageGray16 out(depth_m.width_px, depth_m.height_px);
  std::ranges::transform(depth_m.values, out.values.begin(), [](float metres) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(1000.0F * metres, 0.0F, 65535.0F)));
  });
  return out;
}

}  // namespace

VirtualCamera::VirtualCamera(const World& world, const Trajectory& trajectory, const SimulateOptions& options)
    : world_(world),
      trajectory_(trajectory),
      mount_(simulated_rig(options).camera.value_or(sensor::CameraMount{})),
      sensor_(simulated_exposure(options)),
      clock_({.mode = options.clock}, NoisePurpose::kCameraClock, options.world.seed),
      arrival_(kReadout_s, kArrivalJitter_s, options.world.seed, 2) {
  EDGESPLAT_CHECK(mount_.model.width_px > 0, "a virtual camera needs a rig with a camera");
}

Result<RecordedFrame> VirtualCamera::expose() {
  const std::uint32_t number = next_++;
  const double time_s = (number + 0.5) * kFramePeriod_s;
  const HostTime middle = host_time_from_ns(kEpoch_ns) + from_seconds(time_s);
  const double exposure_s = sensor_.exposure_s(time_s);
  const CameraView view{mount_.model, trajectory_.world_from_body(time_s) * mount_.body_from_camera, time_s};
  const CameraPicture picture = render_picture(world_, view);

  RecordedFrame frame;
  frame.stamp = clock_.stamp(middle - from_seconds(mount_.stamp_delay_s));
  frame.arrival = arrival_.arrival(middle + from_seconds(0.5 * exposure_s));
  frame.meta = {frame.stamp, number, static_cast<float>(exposure_s), 0.0F, clock_.source()};
  Result<std::vector<std::byte>> image, clean, mask, depth;
  thread::parallel_invoke(
      [&] { image = io::encode_jpeg(sensor_.expose(picture.full, number, time_s), kJpegQuality); },
      [&] { clean = io::encode_png(sensor_.expose_ideal(picture.clean, time_s), 1); },
      [&] { mask = io::encode_png(picture.movers, 1); },
      [&] { depth = io::encode_png(depth_in_mm(picture.depth), 1); });
  EDGESPLAT_TRY(frame.image_jpeg, std::move(image));
  EDGESPLAT_TRY(frame.clean_png, std::move(clean));
  EDGESPLAT_TRY(frame.mask_png, std::move(mask));
  EDGESPLAT_TRY(frame.depth_png, std::move(depth));
  return frame;
}

sensor::ImageRgb8 clean_picture(const World& world, const geometry::CameraModel& camera,
                                const geometry::RigidTransform& world_from_camera) {
  const CameraPicture picture = render_picture(world, {camera, world_from_camera, 0.0});
  return CameraSensor{CameraSensorConfig{}}.expose_ideal(picture.clean, 0.0);
}

Status write_clean_views(const World& world, const SimulateOptions& options) {
  if (!options.clean_views) return {};
  EDGESPLAT_TRY(const auto poses, io::read_tum(options.clean_views->poses));
  std::error_code error;
  std::filesystem::create_directories(options.clean_views->folder, error);
  if (error) {
    return fail(Errc::kIo, "cannot create " + options.clean_views->folder.string() + ": " + error.message());
  }
  const sensor::CameraMount mount = *simulated_rig(options).camera;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    char name[32];
    std::snprintf(name, sizeof(name), "%06zu.png", k);
    EDGESPLAT_TRY_STATUS(
        io::save_image(options.clean_views->folder / name,
                       clean_picture(world, mount.model, poses[k].world_from_body * mount.body_from_camera)));
  }
  return {};
}

}  // namespace edgesplat::simulate
