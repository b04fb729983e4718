// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/integration/finished_map.hpp"

#include "common/time/clock.hpp"
#include "kernels/mapping/engine.hpp"
#include "kernels/splat/render.hpp"
#include "tools/simulate/camera_render.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace edgesplat::test {
namespace {

constexpr int kKeyframes = 8;
constexpr double kApart_m = 0.6;

geometry::CameraModel camera() {
  return {geometry::CameraKind::kPinhole, 128, 96, 90.0, 90.0, 63.5, 47.5, {}};
}

geometry::RigidTransform body_from_camera() {
  geometry::RigidTransform transform;
  Eigen::Matrix3d rotation;
  rotation << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  transform.rotation = Eigen::Quaterniond(rotation);
  return transform;
}

/// Along the first stretch of the corridor's path.
geometry::RigidTransform body_at(const simulate::World& world, double along_m) {
  const auto path = world.path();
  const Eigen::Vector3d ahead = (path.waypoints_m[1] - path.waypoints_m[0]).normalized();
  geometry::RigidTransform pose;
  pose.rotation = Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ());
  pose.translation_m = path.waypoints_m[0] + along_m * ahead + Eigen::Vector3d(0, 0, 0.3);
  return pose;
}

sensor::ImageRgb8 eight_bits(const sensor::ImageRgbF32& radiance) {
  sensor::ImageRgb8 picture(radiance.width_px, radiance.height_px);
  for (std::size_t i = 0; i < radiance.values.size(); ++i) {
    const double v = std::pow(std::clamp(static_cast<double>(radiance.values[i]), 0.0, 1.0), 1.0 / 2.2);
    picture.values[i] = static_cast<std::uint8_t>(std::lround(255.0 * v));
  }
  return picture;
}

/// What a LiDAR with a point at every second pixel would measure.
std::vector<map::ColouredPoint> points_of(const sensor::ImageF32& depth_m, const sensor::ImageRgb8& picture) {
  std::vector<map::ColouredPoint> points;
  const auto model = camera();
  for (int y = 0; y < model.height_px; y += 2) {
    for (int x = 0; x < model.width_px; x += 2) {
      const double z_m = *depth_m.pixel(x, y);
      if (z_m <= 0.0 || z_m > 40.0) continue;
      const Eigen::Vector3d ray = model.unproject({x, y});
      const Eigen::Vector3d p_in_body_m = body_from_camera() * Eigen::Vector3d(ray * (z_m / ray.z()));
      const auto* rgb = picture.pixel(x, y);
      points.push_back({p_in_body_m.cast<float>(), {rgb[0], rgb[1], rgb[2]}, true});
    }
  }
  return points;
}

mapping::EngineOptions engine_options(int sh_degree) {
  mapping::EngineOptions options;
  options.optimiser.sh_degree = sh_degree;
  options.optimiser.rates.sh_rest = 1e-2F;  // far more than is sensible: the colours must depend on direction
  options.fill.enabled = false;
  return options;
}

}  // namespace

FinishedMap train_corridor(int sh_degree, int steps) {
  FinishedMap finished;
  finished.camera = camera();
  const auto world = simulate::World::create({"corridor", 0, 0, 3});
  const VirtualClock clock;
  mapping::IdAllocator ids(40000);
  const auto engine = mapping::MappingEngine::create(engine_options(sh_degree), ids, clock);
  EXPECT_TRUE(world && engine);
  for (int i = 0; i < kKeyframes; ++i) {
    const auto map_from_body = body_at(**world, kApart_m * i);
    const auto shot =
        simulate::render_picture(**world, {finished.camera, map_from_body * body_from_camera(), 0.0});
    const auto picture = eight_bits(shot.clean);
    map::Keyframe keyframe;
    keyframe.id.value = static_cast<std::uint32_t>(i);
    keyframe.odom_from_body = map_from_body;
    keyframe.camera = sensor::CameraMount{};
    keyframe.camera->model = finished.camera;
    keyframe.camera->body_from_camera = body_from_camera();
    keyframe.points_in_body = points_of(shot.depth, picture);
    EXPECT_TRUE((*engine)->add(keyframe, map_from_body, &picture));
    for (int step = 0; step < steps / kKeyframes; ++step) (void)(*engine)->step();
    finished.map_from_body.push_back(map_from_body);
    finished.pictures.push_back(picture);
  }
  finished.cloud = (*engine)->cloud();
  return finished;
}

double FinishedMap::psnr_db(const gaussian::GaussianCloud& drawn,
                            const std::vector<geometry::RigidTransform>& poses) const {
  const auto pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  std::vector<float> colour(3 * pixels), depth(pixels), alpha(pixels);
  double sum_db = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto view = splat::View::from(camera, (poses[i] * body_from_camera()).inverse());
    EXPECT_TRUE(view && splat::render(core::Backend::kCpu, splat::spans_of(drawn), *view, {},
                                      {colour, depth, alpha}));
    double squares = 0.0;
    for (std::size_t k = 0; k < colour.size(); ++k) {
      const double v = std::clamp(static_cast<double>(colour[k]), 0.0, 1.0) - pictures[i].values[k] / 255.0;
      squares += v * v;
    }
    sum_db -= 10.0 * std::log10(squares / static_cast<double>(colour.size()));
  }
  return sum_db / static_cast<double>(poses.size());
}

}  // namespace edgesplat::test
