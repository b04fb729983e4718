// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/noise.hpp"
#include "tools/simulate/world/mover_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector3d;

enum Dress : std::uint32_t { kSkin, kHair, kTop, kTrousers, kShoes, kBag };
/// Two steps of a person 1.75 m tall.
constexpr double kStrideOfHeight = 0.83;

/// From body coordinates (x forward, y left, z up, on the ground) to the world.
struct Placing {
  Vector3d foot_m;
  Eigen::Matrix3d world_from_body;
  [[nodiscard]] Vector3d operator()(const Vector3d& p) const { return foot_m + world_from_body * p; }
};

Primitive limb(const Placing& place, const Vector3d& from, const Vector3d& to, double radius, Dress dress) {
  Primitive p;
  p.shape = Shape::kCapsule;
  p.material = dress;
  p.centre_m = place((from + to) / 2.0);
  const double length = (to - from).norm();
  p.half_m = {radius, radius, length / 2.0};
  const Vector3d z = (to - from) / length;
  const Vector3d y =
      (std::abs(z.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY()).cross(z).normalized() * -1.0;
  Eigen::Matrix3d body_from_limb;
  body_from_limb << y.cross(z), y, z;
  p.rotate(place.world_from_body * body_from_limb);
  return p;
}

Primitive ball(const Placing& place, const Vector3d& centre, const Vector3d& half, Dress dress) {
  Primitive p;
  p.shape = Shape::kEllipsoid;
  p.material = dress;
  p.centre_m = place(centre);
  p.half_m = half;
  p.rotate(place.world_from_body);
  return p;
}

/// A limb's lower end after a swing by `angle` (forwards positive) from hanging straight down.
Vector3d swing(const Vector3d& top, double length, double angle) {
  return top + length * Vector3d(std::sin(angle), 0.0, -std::cos(angle));
}

void add_leg(const Placing& place, double h, double side, double phase, Parts& out) {
  const Vector3d hip(0.0, side * 0.055 * h, 0.515 * h);
  const double thigh = 0.42 * std::sin(phase);
  const double knee_bend = 0.12 + 0.75 * std::max(0.0, std::cos(phase));  // bent while it swings forwards
  const Vector3d knee = swing(hip, 0.245 * h, thigh);
  const Vector3d ankle = swing(knee, 0.225 * h, thigh - knee_bend);
  out.push_back(limb(place, hip, knee, 0.045 * h, kTrousers));
  out.push_back(limb(place, knee, ankle, 0.031 * h, kTrousers));
  const Vector3d heel = ankle + Vector3d(-0.02 * h, 0, -0.015 * h);
  out.push_back(limb(place, heel, heel + Vector3d(0.105 * h, 0, -0.004 * h), 0.025 * h, kShoes));
}

void add_arm(const Placing& place, double h, double side, double phase, Parts& out) {
  const Vector3d shoulder(0.0, side * 0.112 * h, 0.80 * h);
  const double upper = 0.38 * std::sin(phase);
  const Vector3d elbow = swing(shoulder, 0.165 * h, upper) + Vector3d(0, side * 0.012 * h, 0);
  const Vector3d wrist = swing(elbow, 0.145 * h, upper + 0.35 + 0.2 * std::sin(phase));
  out.push_back(limb(place, shoulder, elbow, 0.029 * h, kTop));
  out.push_back(limb(place, elbow, wrist, 0.024 * h, kTop));
  out.push_back(ball(place, wrist + Vector3d(0.01, 0, -0.03 * h), {0.024 * h, 0.018 * h, 0.045 * h}, kSkin));
}

/// Muted: few people wear pure colours.
Rgb cloth_colour(NoiseStream& draw, float brightest) {
  const auto channel = [&] {
    return 0.03F + brightest * static_cast<float>(draw.uniform() * draw.uniform());
  };
  const float r = channel(), g = channel(), b = channel(), grey = (r + g + b) / 3.0F;
  return Rgb::Constant(0.6F * grey) + 0.4F * Rgb(r, g, b);
}

}  // namespace

MoverBody make_pedestrian(std::uint64_t seed) {
  NoiseStream draw(seed, NoisePurpose::kCrowd, 0);
  MoverBody body;
  body.height_m = 1.60 + 0.28 * draw.uniform();
  body.gait_phase = 2.0 * std::numbers::pi * draw.uniform();
  body.reach_m = 0.62 * body.height_m;
  body.width_m = 0.37 * body.height_m;
  const auto number = [&] { return static_cast<std::uint32_t>(draw.bits() >> 32U); };
  const auto tone = static_cast<float>(draw.uniform());
  const Rgb skin = Rgb(0.62F, 0.38F, 0.27F) * (1.0F - 0.7F * tone);
  const Rgb hair = Rgb(0.20F, 0.12F, 0.06F) * static_cast<float>(0.15 + draw.uniform());
  const Rgb top = cloth_colour(draw, 0.75F), stripe = cloth_colour(draw, 0.75F);
  const bool plain = draw.uniform() < 0.5;
  const Rgb trousers = cloth_colour(draw, 0.25F);
  body.materials = {
      {Pattern::kPaint, skin, skin, 1.0F, 0.05F, 0.50F, number()},
      {Pattern::kFabric, hair, hair, 0.05F, 0.45F, 0.25F, number()},
      {Pattern::kFabric, top, plain ? top : stripe, 0.14F, 0.22F, 0.45F, number()},
      {Pattern::kFabric, trousers, trousers, 0.3F, 0.25F, 0.35F, number()},
      {Pattern::kPaint, Rgb(0.06F, 0.05F, 0.05F), Rgb::Zero(), 1.0F, 0.2F, 0.15F, number()},
      {Pattern::kFabric, cloth_colour(draw, 0.5F), Rgb(0.05F, 0.05F, 0.06F), 0.22F, 0.15F, 0.3F, number()},
  };
  return body;
}

Parts pose_pedestrian(const MoverBody& body, const Stance& stance) {
  Parts out;
  out.reserve(20);
  const double h = body.height_m;
  const double phase = body.gait_phase + 2.0 * std::numbers::pi * stance.travelled_m / (kStrideOfHeight * h);
  Placing place;
  place.world_from_body << stance.forward.x(), -stance.forward.y(), 0.0, stance.forward.y(),
      stance.forward.x(), 0.0, 0.0, 0.0, 1.0;
  // The body is highest when the legs pass each other.
  place.foot_m = stance.foot_m + Vector3d(0, 0, 0.014 * h * (std::cos(2.0 * phase) - 1.0));
  add_leg(place, h, 1.0, phase, out);
  add_leg(place, h, -1.0, phase + std::numbers::pi, out);
  add_arm(place, h, 1.0, phase + std::numbers::pi, out);
  add_arm(place, h, -1.0, phase, out);
  out.push_back(ball(place, {0, 0, 0.54 * h}, {0.068 * h, 0.098 * h, 0.085 * h}, kTrousers));
  out.push_back(ball(place, {0, 0, 0.69 * h}, {0.072 * h, 0.108 * h, 0.170 * h}, kTop));
  out.push_back(limb(place, {0, -0.09 * h, 0.805 * h}, {0, 0.09 * h, 0.805 * h}, 0.040 * h, kTop));
  out.push_back(limb(place, {0, 0, 0.82 * h}, {0.006 * h, 0, 0.87 * h}, 0.032 * h, kSkin));
  out.push_back(ball(place, {0.012 * h, 0, 0.925 * h}, {0.055 * h, 0.043 * h, 0.068 * h}, kSkin));
  out.push_back(ball(place, {-0.006 * h, 0, 0.942 * h}, {0.058 * h, 0.048 * h, 0.062 * h}, kHair));
  if (body.materials[kBag].seed % 3 == 0)
    out.push_back(ball(place, {-0.105 * h, 0, 0.70 * h}, {0.065 * h, 0.085 * h, 0.125 * h}, kBag));
  return out;
}

}  // namespace edgesplat::simulate
