// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/colouriser.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::keyframe {
namespace {

std::array<std::uint8_t, 3> sample_bilinear(const sensor::ImageRgb8& image, float u_px, float v_px) {
  const float u = std::clamp(u_px, 0.0F, static_cast<float>(image.width_px - 1));
  const float v = std::clamp(v_px, 0.0F, static_cast<float>(image.height_px - 1));
  const int x = std::min(static_cast<int>(u), std::max(0, image.width_px - 2));
  const int y = std::min(static_cast<int>(v), std::max(0, image.height_px - 2));
  const int right = std::min(x + 1, image.width_px - 1);
  const int below = std::min(y + 1, image.height_px - 1);
  const float fx = u - static_cast<float>(x);
  const float fy = v - static_cast<float>(y);
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    const float top = (1 - fx) * image.pixel(x, y)[c] + fx * image.pixel(right, y)[c];
    const float bottom = (1 - fx) * image.pixel(x, below)[c] + fx * image.pixel(right, below)[c];
    rgb[c] = static_cast<std::uint8_t>(std::lround((1 - fy) * top + fy * bottom));
  }
  return rgb;
}

}  // namespace

Colouriser::Colouriser(const KeyframeConfig& config, const sensor::CameraMount& camera)
    : config_(config),
      camera_(camera),
      depth_(camera.model.width_px, camera.model.height_px, config.occlusion_cell_px) {}

void Colouriser::add_points(const tracking::TrackedGroup& group) {
  const Eigen::Matrix3f rotation = group.odom_from_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = group.odom_from_body.translation_m.cast<float>();
  for (const tracking::DeskewedPoint& p : group.points_in_body) {
    points_.push_back({group.stamp, {rotation * p.p_in_body_m + translation, {}, false}, false});
  }
  expire(group.stamp);
}

void Colouriser::expire(HostTime now) {
  const HostTime oldest = now - from_seconds(config_.window_s);
  while (!points_.empty() &&
         ((points_.front().stamp < oldest && (points_.front().taken || !points_.front().point.has_colour)) ||
          points_.size() > static_cast<std::size_t>(config_.window_points))) {
    if (!points_.front().point.has_colour) ++expired_without_colour_;
    points_.pop_front();
  }
}

void Colouriser::project_all(const geometry::RigidTransform& camera_from_odom) {
  const Eigen::Matrix3f rotation = camera_from_odom.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = camera_from_odom.translation_m.cast<float>();
  const auto max_range_m = static_cast<float>(config_.max_colour_range_m);
  projected_.clear();
  depth_.clear();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3f p = rotation * points_[i].point.p_in_odom_m + translation;
    if (p.z() < 0.05F || p.z() > max_range_m) continue;
    const auto pixel = camera_.model.project(p.cast<double>());
    if (!pixel || !camera_.model.contains(*pixel)) continue;
    depth_.insert(pixel->x(), pixel->y(), p.z());
    projected_.push_back({i, static_cast<float>(pixel->x()), static_cast<float>(pixel->y()), p.z()});
  }
}

void Colouriser::add_image(const tracking::TrackedGroup& group, const sensor::ImageRgb8& image) {
  if (image.width_px != camera_.model.width_px || image.height_px != camera_.model.height_px) return;
  project_all((group.odom_from_body * camera_.body_from_camera).inverse());
  const auto absolute_m = static_cast<float>(config_.occlusion_absolute_m);
  const auto relative = static_cast<float>(config_.occlusion_relative);
  for (const Projected& p : projected_) {
    Waiting& waiting = points_[p.index];
    if (waiting.point.has_colour || !depth_.visible(p.u_px, p.v_px, p.z_m, absolute_m, relative)) continue;
    waiting.point.rgb = sample_bilinear(image, p.u_px, p.v_px);
    waiting.point.has_colour = true;
  }
}

std::vector<OdomPoint> Colouriser::take_coloured() {
  std::vector<OdomPoint> coloured;
  for (Waiting& waiting : points_) {
    if (!waiting.point.has_colour || waiting.taken) continue;
    waiting.taken = true;
    coloured.push_back(waiting.point);
  }
  return coloured;
}

}  // namespace edgesplat::keyframe
