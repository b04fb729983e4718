// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/mover_rays.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector3d;

/// Beyond this distance from a person's middle line or a car's side nothing darkens.
constexpr double kShadowReach_m = 1.6;
constexpr float kDarkest = 0.75F;  ///< most of the light that bodies near by can take
constexpr double kSunLift_m = 0.01;

bool meets(const MoverBall& ball, const Vector3d& origin_m, const Vector3d& direction, double to_m) {
  const Vector3d to_centre = ball.centre_m - origin_m;
  const double along = to_centre.dot(direction);
  // From above: does the line pass the upright cylinder? Most rays are nearly level, so this tells most
  // apart.
  const double aside = to_centre.x() * direction.y() - to_centre.y() * direction.x();
  const double level2 = direction.head<2>().squaredNorm();
  if (aside * aside > ball.width_m * ball.width_m * level2) return false;
  const double off2 = to_centre.squaredNorm() - along * along;
  return off2 < ball.radius_m * ball.radius_m && along > -ball.radius_m && along < to_m + ball.radius_m;
}

/// Share of a surface's view that a ball takes (exact far away, Quilez), faded out to nothing at
/// kShadowReach_m.
float ball_shade(const FacePoint& at, const Vector3d& centre, double radius) {
  const Vector3d to_ball = centre - at.p_in_world_m;
  const double d2 = to_ball.squaredNorm(), d = std::sqrt(d2);
  if (d >= kShadowReach_m || d < 1e-6) return 0.0F;
  const double facing = std::clamp(at.normal.dot(to_ball) / d + 0.15, 0.0, 1.0);
  const double fade = 1.0 - d2 / (kShadowReach_m * kShadowReach_m);
  return static_cast<float>(facing * std::min(1.0, radius * radius / d2) * fade * fade);
}

float pedestrian_shade(const MoverBody& body, const Stance& stance, const FacePoint& at) {
  const double h = body.height_m;
  float left = 1.0F;
  for (const auto& [height, radius] : {std::pair(0.06, 0.13), std::pair(0.30, 0.16), std::pair(0.62, 0.24)})
    left *= 1.0F - ball_shade(at, stance.foot_m + Vector3d(0, 0, height * h), radius);
  return 1.0F - left;
}

/// Dark below a car and around it on the ground.
float car_shade(const Stance& stance, const FacePoint& at) {
  const Vector3d p = at.p_in_world_m - stance.foot_m;
  const Eigen::Vector2d flat = p.head<2>();
  const double x = std::abs(flat.dot(stance.forward)) - kCarHalfLength_m;
  const double y = std::abs(stance.forward.x() * flat.y() - stance.forward.y() * flat.x()) - kCarHalfWidth_m;
  const double outside = std::hypot(std::max(x, 0.0), std::max(y, 0.0)) - 0.1;
  const double near = std::clamp(1.0 - std::max(outside, 0.0) / 0.7, 0.0, 1.0);
  const double low = std::clamp(1.0 - p.z() / 1.2, 0.0, 1.0);
  return static_cast<float>(near * near * low * low * (0.5 + 0.5 * std::max(0.0, at.normal.z())));
}

template <typename Movers>
bool sun_blocked(const Movers& movers, const Vector3d& from_m, const Vector3d& towards) {
  for (std::size_t i = 0; i < movers.size(); ++i) {
    if (!meets(movers.ball(i), from_m, towards, kFarthestRange_m)) continue;
    for (const Primitive& part : movers.parts(i))
      if (intersect(part, from_m, towards, 0.0, kFarthestRange_m) < kFarthestRange_m) return true;
  }
  return false;
}

}  // namespace

template <typename Movers>
std::optional<MoverHit> nearest_mover(const Movers& movers, const Ray& ray, double to_m) {
  std::optional<MoverHit> best;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    if (!meets(movers.ball(i), ray.origin_m, ray.direction, to_m)) continue;
    const Parts& parts = movers.parts(i);
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const double t = intersect(parts[k], ray.origin_m, ray.direction, kNearestRange_m, to_m);
      if (t >= to_m) continue;
      best = MoverHit{i, k, t, parts[k]};
      to_m = t;
    }
  }
  return best;
}

template <typename Movers>
float mover_light_left(const Movers& movers, const Scene& scene, const FacePoint& at, float sun_share) {
  float taken = 0.0F;
  for (std::size_t i = 0; i < movers.size(); ++i) {
    const MoverBall& ball = movers.ball(i);
    const double reach_m = ball.radius_m + kShadowReach_m;
    if ((ball.centre_m - at.p_in_world_m).squaredNorm() > reach_m * reach_m) continue;
    const MoverBody& body = movers.body(i);
    const float shade = body.kind == MoverBody::Kind::kCar ? car_shade(movers.stance(i), at)
                                                           : pedestrian_shade(body, movers.stance(i), at);
    taken = 1.0F - (1.0F - taken) * (1.0F - shade);
  }
  const float soft = 1.0F - kDarkest * taken;
  if (sun_share <= 0.0F || !scene.light.sun) return soft;
  const bool dark = sun_blocked(movers, at.p_in_world_m + kSunLift_m * at.normal, scene.light.sun->towards);
  return soft * (1.0F - (dark ? sun_share : 0.0F));
}

template std::optional<MoverHit> nearest_mover(const CrowdAt&, const Ray&, double);
template std::optional<MoverHit> nearest_mover(const PosedCrowd&, const Ray&, double);
template float mover_light_left(const CrowdAt&, const Scene&, const FacePoint&, float);
template float mover_light_left(const PosedCrowd&, const Scene&, const FacePoint&, float);

}  // namespace edgesplat::simulate
