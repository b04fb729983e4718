// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/render_loop.hpp"

#include "common/log/log.hpp"
#include "kernels/image/undistort.hpp"
#include "robot/render/view.hpp"

#include <utility>

namespace edgesplat::app {

RenderLoop::RenderLoop(const RenderLoopConfig& config, const sensor::CameraMount& camera, MapView map_view,
                       const Clock& clock, metrics::Registry& metrics, PictureListener on_picture)
    : config_(config),
      camera_{image::undistorted_model(camera.model), camera.body_from_camera, camera.stamp_delay_s},
      map_view_(std::move(map_view)),
      on_picture_(std::move(on_picture)),
      clock_(clock),
      frame_ms_(metrics.histogram("render.frame_ms")),
      frames_(metrics.counter("render.frames")),
      failures_(metrics.counter("render.failures")),
      newest_pose_({1}, thread::Overflow::kDropOldest),
      worker_(thread::Worker::consume<geometry::RigidTransform>(
          "render", newest_pose_, [this](geometry::RigidTransform map_from_body) { draw(map_from_body); })) {}

RenderLoop::~RenderLoop() {
  newest_pose_.close();
}

void RenderLoop::show_from(const geometry::RigidTransform& map_from_body) {
  newest_pose_.push(map_from_body);
}

void RenderLoop::draw(const geometry::RigidTransform& map_from_body) {
  const HostTime start = clock_.now();
  if (config_.target_hz <= 0) return;
  if (drawn_before_ && start - last_start_ < from_seconds(1.0 / config_.target_hz)) return;
  const std::shared_ptr<const gaussian::GaussianCloud> cloud = map_view_();
  if (!cloud || cloud->size() == 0) return;
  drawn_before_ = true;
  last_start_ = start;
  const auto view =
      render::draw_view(*cloud, camera_.model, (map_from_body * camera_.body_from_camera).inverse());
  if (!view) {
    failures_.add();
    EDGESPLAT_LOG_WARN("render", "picture failed", "why", view.error().context);
    return;
  }
  frames_.add();
  const double took_ms = to_seconds(clock_.now() - start) * 1e3;
  frame_ms_.record(took_ms);
  if (on_picture_) on_picture_(took_ms);
}

}  // namespace edgesplat::app
