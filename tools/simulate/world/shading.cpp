// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/shading.hpp"

#include "tools/simulate/world/pattern.hpp"
#include "tools/simulate/world/texture_noise.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Rgb mix(const Rgb& a, const Rgb& b, float share_of_b) {
  return a + share_of_b * (b - a);
}

/// Behind the windows of a house: lawn, a hedge, trees and sky on an upright plane some metres away, so that
/// the view moves against the frame as it should.
Rgb landscape(const Ray& ray, const Hit& hit, const Material& m, double footprint_m) {
  constexpr double kDistance_m = 9.0;
  const double towards = std::max(0.15, -hit.normal.dot(ray.direction));
  const double onward_m = kDistance_m / towards;
  const Vector3d p = ray.origin_m + (hit.range_m + onward_m) * ray.direction;
  const Vector3d right = Vector3d::UnitZ().cross(hit.normal);
  const Vector2d at(right.dot(p), p.z());
  const double blur_m = footprint_m * (hit.range_m + onward_m) / hit.range_m;
  if (at.y() < 0.0) {
    const float grass = octave_noise(at, {0.4, 0.02, 0.7F, m.seed}, blur_m);
    return Rgb(0.16F, 0.26F, 0.07F) * (1.0F + 0.4F * grass);
  }
  const float crown = octave_noise({at.x() / 2.2, 0.5}, {1.0, 0.05, 0.5F, m.seed + 3}, blur_m / 2.2);
  const float leaves = octave_noise(at, {0.6, 0.02, 0.75F, m.seed + 4}, blur_m);
  const Rgb tree = Rgb(0.08F, 0.16F, 0.05F) * (1.0F + 0.9F * leaves);
  const Rgb sky = mix(Rgb(0.80F, 0.84F, 0.88F), Rgb(0.55F, 0.68F, 0.88F),
                      std::min(1.0F, static_cast<float>(at.y()) / 9.0F));
  return mix(sky, tree, box_coverage(at.y(), -1.0, 3.4 + 1.6 * crown + 0.5 * leaves, blur_m + 0.02));
}

/// Dark glass that mirrors the sky, more so at a grazing angle (Schlick 1994), less so low down.
Rgb pane(const Ray& ray, const Hit& hit, const Material& m, const Rgb& light) {
  const auto facing = static_cast<float>(std::clamp(-hit.normal.dot(ray.direction), 0.0, 1.0));
  const float fresnel = 0.10F + 0.6F * std::pow(1.0F - facing, 5.0F);
  Vector3d mirrored = ray.direction - 2.0 * ray.direction.dot(hit.normal) * hit.normal;
  const float height = static_cast<float>(std::clamp(4.0 * mirrored.z() + 0.3, 0.15, 1.0));
  mirrored.z() = std::max(mirrored.z(), 0.02);
  return m.base.cwiseProduct(light) + fresnel * height * sky_radiance(mirrored.normalized());
}

}  // namespace

Rgb sky_radiance(const Vector3d& d) {
  if (d.z() <= 0.0) return {0.55F, 0.60F, 0.66F};  // haze below the horizon
  const auto up = static_cast<float>(std::sqrt(std::clamp(d.z(), 0.0, 1.0)));
  const Rgb clear = mix(Rgb(0.74F, 0.80F, 0.86F), Rgb(0.22F, 0.42F, 0.78F), up);
  const Vector2d at = d.head<2>() / (d.z() + 0.12);
  const float cloud = octave_noise(at, {1.6, 0.02, 0.6F, 77}, 0.004 / (d.z() + 0.12));
  return mix(clear, Rgb(0.90F, 0.90F, 0.91F), std::clamp(1.4F * cloud + 0.1F, 0.0F, 0.9F));
}

Rgb surface_radiance(const Material& m, const Ray& ray, const Hit& hit, const Rgb& light,
                     double footprint_m) {
  switch (m.pattern) {
    case Pattern::kWindowView:
      return 0.92F * landscape(ray, hit, m, footprint_m);
    case Pattern::kPane:
      return pane(ray, hit, m, light);
    case Pattern::kLamp:
      return m.base * m.glow;
    default:
      return albedo(m, {hit.uv_m, footprint_m}).cwiseProduct(light);
  }
}

}  // namespace edgesplat::simulate
