// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/render/view.hpp"

#include "kernels/splat/render.hpp"

#include <algorithm>
#include <cmath>

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
  out.picture = sensor::ImageRgb8(camera.width_px, camera.height_px);
  for (std::size_t i = 0; i < colour.values.size(); ++i) {
    out.picture.values[i] =
        static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(colour.values[i], 0.0F, 1.0F)));
  }
  for (std::size_t i = 0; i < alpha.values.size(); ++i) {
    out.depth_m.values[i] =
        alpha.values[i] > kLeastAlphaForDepth ? out.depth_m.values[i] / alpha.values[i] : 0.0F;
  }
  return out;
}

}  // namespace edgesplat::render
