// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/render/view.hpp"

#include "common/sensor/image_values.hpp"
#include "kernels/splat/render.hpp"

namespace edgesplat::render {
namespace {

/// Less coverage than this gives no trustworthy depth.
constexpr float kLeastAlphaForDepth = 0.1F;

}  // namespace

Result<View> draw_view(const gaussian::GaussianCloud& cloud, const geometry::CameraModel& camera,
                       const geometry::RigidTransform& camera_from_map) {
  EDGESPLAT_TRY(const splat::View view, splat::View::from(camera, camera_from_map));
  sensor::ImageRgbF32 colour(camera.width_px, camera.height_px);
  sensor::ImageF32 alpha(camera.width_px, camera.height_px);
  View out;
  out.depth_m = sensor::ImageF32(camera.width_px, camera.height_px);
  EDGESPLAT_TRY(const splat::RenderStats stats,
                splat::render(core::Backend::kCpu, splat::spans_of(cloud), view, {},
                              {colour.values, out.depth_m.values, alpha.values}));
  (void)stats;
  out.picture = sensor::to_rgb8(colour.values, camera.width_px, camera.height_px);
  for (std::size_t i = 0; i < alpha.values.size(); ++i) {
    out.depth_m.values[i] =
        alpha.values[i] > kLeastAlphaForDepth ? out.depth_m.values[i] / alpha.values[i] : 0.0F;
  }
  return out;
}

}  // namespace edgesplat::render
