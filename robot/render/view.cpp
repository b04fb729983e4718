// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/render/view.hpp"

#include "common/sensor/image_values.hpp"
#include "kernels/splat/render.hpp"

#include <optional>

namespace edgesplat::render {
namespace {

/// Less coverage than this gives no trustworthy depth.
constexpr float kLeastAlphaForDepth = 0.1F;

/// `draw(view, outputs)` fills the pictures.
template <typename Draw>
Result<View> view_of(const geometry::CameraModel& camera, const geometry::RigidTransform& camera_from_map,
                     const Draw& draw) {
  EDGESPLAT_TRY(const splat::View view, splat::View::from(camera, camera_from_map));
  sensor::ImageRgbF32 colour(camera.width_px, camera.height_px);
  View out;
  out.alpha = sensor::ImageF32(camera.width_px, camera.height_px);
  out.depth_m = sensor::ImageF32(camera.width_px, camera.height_px);
  EDGESPLAT_TRY(const splat::RenderStats stats,
                draw(view, splat::BlendOutputs{colour.values, out.depth_m.values, out.alpha.values}));
  (void)stats;
  out.picture = sensor::to_rgb8(colour.values, camera.width_px, camera.height_px);
  for (std::size_t i = 0; i < out.alpha.values.size(); ++i) {
    const float alpha = out.alpha.values[i];
    out.depth_m.values[i] = alpha > kLeastAlphaForDepth ? out.depth_m.values[i] / alpha : 0.0F;
  }
  return out;
}

/// What the caller did wrong is wrong on every backend.
bool is_of_the_gpu(const Error& error) {
  return error.code != Errc::kInvalidArgument;
}

}  // namespace

Result<View> draw_view(const gaussian::GaussianCloud& cloud, const geometry::CameraModel& camera,
                       const geometry::RigidTransform& camera_from_map) {
  return view_of(camera, camera_from_map, [&](const splat::View& view, const splat::BlendOutputs& out) {
    return splat::render(core::Backend::kCpu, splat::spans_of(cloud), view, {}, out);
  });
}

struct ViewDrawer::State {
  std::optional<splat::Renderer> on_gpu;
  std::shared_ptr<const gaussian::GaussianCloud> there;  ///< the Gaussians that the GPU has
  std::string gpu_failure;

  Result<View> draw_on_gpu(const std::shared_ptr<const gaussian::GaussianCloud>& cloud,
                           const geometry::CameraModel& camera,
                           const geometry::RigidTransform& camera_from_map) {
    if (cloud != there) {
      there.reset();
      EDGESPLAT_TRY_STATUS(on_gpu->set_cloud(splat::spans_of(*cloud)));
      there = cloud;
    }
    return view_of(camera, camera_from_map, [&](const splat::View& view, const splat::BlendOutputs& out) {
      return on_gpu->draw(view, {}, out);
    });
  }
};

ViewDrawer::ViewDrawer() : state_(std::make_unique<State>()) {
  const auto fastest = core::choose_backend("auto");
  if (!fastest || *fastest == core::Backend::kCpu) return;
  if (auto renderer = splat::Renderer::create(*fastest)) {
    state_->on_gpu = std::move(*renderer);
  } else {
    state_->gpu_failure = renderer.error().context;
  }
}

ViewDrawer::~ViewDrawer() = default;

Result<View> ViewDrawer::draw(const std::shared_ptr<const gaussian::GaussianCloud>& cloud,
                              const geometry::CameraModel& camera,
                              const geometry::RigidTransform& camera_from_map) {
  if (state_->on_gpu) {
    auto view = state_->draw_on_gpu(cloud, camera, camera_from_map);
    if (view || !is_of_the_gpu(view.error())) return view;
    state_->gpu_failure = view.error().context;
    state_->there.reset();
    state_->on_gpu.reset();
  }
  return draw_view(*cloud, camera, camera_from_map);
}

core::Backend ViewDrawer::backend() const {
  return state_->on_gpu ? core::Backend::kCuda : core::Backend::kCpu;
}

const std::string& ViewDrawer::gpu_failure() const {
  return state_->gpu_failure;
}

}  // namespace edgesplat::render
