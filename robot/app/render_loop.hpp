// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/metrics/registry.hpp"
#include "common/sensor/rig.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "common/time/clock.hpp"

#include <functional>
#include <memory>

namespace edgesplat::app {

struct RenderLoopConfig {
  double target_hz = 5.0;  ///< at most this many pictures a second, [0, 120]; 0 = never
};

/// Draws the resident map from the newest pose on its own thread; poses that come while it draws are skipped,
/// so tracking never waits for it. Thread-safe.
class RenderLoop {
 public:
  using MapView = std::function<std::shared_ptr<const gaussian::GaussianCloud>()>;

  /// Told on the render thread how long each picture took, in ms.
  using PictureListener = std::function<void(double)>;

  RenderLoop(const RenderLoopConfig& config, const sensor::CameraMount& camera, MapView map_view,
             const Clock& clock, metrics::Registry& metrics, PictureListener on_picture = {});
  ~RenderLoop();
  RenderLoop(const RenderLoop&) = delete;
  RenderLoop& operator=(const RenderLoop&) = delete;

  void show_from(const geometry::RigidTransform& map_from_body);

 private:
  void draw(const geometry::RigidTransform& map_from_body);

  RenderLoopConfig config_;
  sensor::CameraMount camera_;
  MapView map_view_;
  PictureListener on_picture_;
  const Clock& clock_;
  metrics::Histogram& frame_ms_;
  metrics::Counter& frames_;
  metrics::Counter& failures_;
  HostTime last_start_{};
  bool drawn_before_ = false;
  thread::BoundedQueue<geometry::RigidTransform> newest_pose_;
  thread::Worker worker_;
};

}  // namespace edgesplat::app
