// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/metrics/registry.hpp"
#include "common/sensor/rig.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "common/time/clock.hpp"
#include "robot/render/view.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace edgesplat::app {

struct RenderLoopConfig {
  double target_hz = 5.0;  ///< pictures a second, [0, 120]; 0 = never
};

struct PictureTimes {
  HostTime began{};
  double took_ms = 0.0;
};

/// Draws the resident map from the newest pose at a fixed rate on its own thread, whether or not a new pose
/// came, on the GPU where there is one; what takes longer than its turn is followed at once. Poses that come
/// while it draws are skipped, so tracking never waits for it. Thread-safe.
class RenderLoop {
 public:
  using MapView = std::function<std::shared_ptr<const gaussian::GaussianCloud>()>;

  /// Told on the render thread about each picture.
  using PictureListener = std::function<void(const PictureTimes&)>;

  RenderLoop(const RenderLoopConfig& config, const sensor::CameraMount& camera, MapView map_view,
             const Clock& clock, metrics::Registry& metrics, PictureListener on_picture = {});
  ~RenderLoop();
  RenderLoop(const RenderLoop&) = delete;
  RenderLoop& operator=(const RenderLoop&) = delete;

  void show_from(const geometry::RigidTransform& map_from_body);

 private:
  bool step(const std::stop_token& stop);
  void draw(const geometry::RigidTransform& map_from_body);

  RenderLoopConfig config_;
  sensor::CameraMount camera_;
  MapView map_view_;
  PictureListener on_picture_;
  const Clock& clock_;
  metrics::Histogram& frame_ms_;
  metrics::Histogram& interval_ms_;
  metrics::Counter& frames_;
  metrics::Counter& failures_;
  render::ViewDrawer drawer_;
  bool told_of_gpu_ = false;                      ///< that it was given up
  std::optional<geometry::RigidTransform> pose_;  ///< the newest that was taken
  HostTime next_{};                               ///< when the next picture is due
  std::optional<HostTime> last_began_;
  thread::BoundedQueue<geometry::RigidTransform> poses_;
  thread::Worker worker_;
};

}  // namespace edgesplat::app
