// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/render_loop.hpp"

#include "common/log/log.hpp"
#include "kernels/image/undistort.hpp"

#include <algorithm>
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
      interval_ms_(metrics.histogram("render.interval_ms")),
      frames_(metrics.counter("render.frames")),
      failures_(metrics.counter("render.failures")),
      poses_({1}, thread::Overflow::kDropOldest),
      worker_("render", [this](const std::stop_token& stop) { return step(stop); }) {}

RenderLoop::~RenderLoop() {
  poses_.close();
}

void RenderLoop::show_from(const geometry::RigidTransform& map_from_body) {
  poses_.push(map_from_body);
}

bool RenderLoop::step(const std::stop_token& stop) {
  if (!pose_ || config_.target_hz <= 0.0) {
    pose_ = poses_.pop(stop);
    next_ = clock_.now();
    return pose_.has_value();
  }
  const nanoseconds wait = next_ - clock_.now();
  if (auto newer = wait > nanoseconds(0) ? poses_.pop_for(wait) : poses_.try_pop()) pose_ = *newer;
  if (stop.stop_requested() || poses_.finished()) return false;
  const HostTime now = clock_.now();
  if (now < next_) return true;
  next_ = std::max(next_ + from_seconds(1.0 / config_.target_hz), now);
  draw(*pose_);
  return true;
}

void RenderLoop::draw(const geometry::RigidTransform& map_from_body) {
  const HostTime began = clock_.now();
  const std::shared_ptr<const gaussian::GaussianCloud> cloud = map_view_();
  if (!cloud || cloud->size() == 0) return;
  const auto view = drawer_.draw(cloud, camera_.model, (map_from_body * camera_.body_from_camera).inverse());
  if (!drawer_.gpu_failure().empty() && !std::exchange(told_of_gpu_, true))
    EDGESPLAT_LOG_WARN("render", "drawing on the CPU", "why", drawer_.gpu_failure());
  if (!view) {
    failures_.add();
    EDGESPLAT_LOG_WARN("render", "picture failed", "why", view.error().context);
    return;
  }
  frames_.add();
  if (last_began_) interval_ms_.record(to_seconds(began - *last_began_) * 1e3);
  last_began_ = began;
  const double took_ms = to_seconds(clock_.now() - began) * 1e3;
  frame_ms_.record(took_ms);
  if (on_picture_) on_picture_({began, took_ms});
}

}  // namespace edgesplat::app
