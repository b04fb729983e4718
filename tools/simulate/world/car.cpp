// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/noise.hpp"
#include "tools/simulate/world/mover_body.hpp"

namespace edgesplat::simulate {
namespace {

using Eigen::Vector3d;

enum CarPaint : std::uint32_t { kBody, kGlass, kTyre, kHub, kTrim, kHeadLight, kTailLight, kPlate };

Primitive block(const Vector3d& lo, const Vector3d& hi, CarPaint paint) {
  Primitive p;
  p.material = paint;
  p.centre_m = (lo + hi) / 2.0;
  p.half_m = (hi - lo) / 2.0;
  return p;
}

Primitive tapered(const Vector3d& lo, const Vector3d& hi, const Eigen::Vector2d& top_scale, double shift_m,
                  CarPaint paint) {
  Primitive p = block(lo, hi, paint);
  p.shape = Shape::kTaperedBox;
  p.top_scale = top_scale;
  p.top_shift_m = shift_m;
  return p;
}

/// A disc standing upright, its axis to the side.
Primitive disc(const Vector3d& centre, double radius, double half_width, CarPaint paint) {
  Primitive p;
  p.shape = Shape::kCylinder;
  p.material = paint;
  p.centre_m = centre;
  p.half_m = {radius, radius, half_width};
  Eigen::Matrix3d body_from_disc;
  body_from_disc << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  p.rotate(body_from_disc);
  return p;
}

std::vector<Primitive> car_parts() {
  constexpr double kL = kCarHalfLength_m, kW = kCarHalfWidth_m;
  std::vector<Primitive> parts;
  parts.push_back(tapered({-kL, -kW, 0.22}, {kL, kW, 0.58}, {1.0, 1.0}, 0.0, kBody));
  parts.push_back(tapered({-kL, -kW, 0.58}, {kL, kW, 0.88}, {0.95, 0.93}, -0.05, kBody));
  parts.push_back(tapered({-1.75, -0.80, 0.88}, {0.95, 0.80, 1.36}, {0.62, 0.82}, -0.10, kGlass));
  parts.push_back(tapered({-1.34, -0.67, 1.36}, {0.36, 0.67, 1.43}, {0.92, 0.92}, 0.0, kBody));
  parts.push_back(
      tapered({-0.55, -0.805, 0.88}, {-0.43, 0.805, 1.37}, {0.9, 0.825}, 0.02, kBody));  // B pillar
  parts.push_back(block({kL - 0.08, -kW + 0.02, 0.20}, {kL + 0.04, kW - 0.02, 0.40}, kTrim));
  parts.push_back(block({-kL - 0.04, -kW + 0.02, 0.20}, {-kL + 0.08, kW - 0.02, 0.40}, kTrim));
  for (const double x : {-1.28, 1.30}) {
    for (const double side : {-1.0, 1.0}) {
      parts.push_back(disc({x, side * (kW - 0.10), 0.31}, 0.31, 0.115, kTyre));
      parts.push_back(disc({x, side * (kW - 0.095), 0.31}, 0.19, 0.118, kHub));
    }
  }
  for (const double side : {-0.62, 0.62}) {
    parts.push_back(block({kL - 0.05, side - 0.18, 0.58}, {kL + 0.015, side + 0.18, 0.72}, kHeadLight));
    parts.push_back(block({-kL - 0.015, side - 0.18, 0.62}, {-kL + 0.05, side + 0.18, 0.76}, kTailLight));
  }
  parts.push_back(block({kL, -0.26, 0.42}, {kL + 0.05, 0.26, 0.53}, kPlate));
  parts.push_back(block({-kL - 0.05, -0.26, 0.42}, {-kL, 0.26, 0.53}, kPlate));
  return parts;
}

}  // namespace

MoverBody make_car(std::uint64_t seed) {
  static constexpr float kPaints[6][3] = {{0.45F, 0.03F, 0.03F}, {0.04F, 0.09F, 0.30F},
                                          {0.60F, 0.61F, 0.63F}, {0.05F, 0.05F, 0.055F},
                                          {0.75F, 0.75F, 0.73F}, {0.06F, 0.22F, 0.14F}};
  NoiseStream draw(seed, NoisePurpose::kCrowd, 1);
  MoverBody body;
  body.kind = MoverBody::Kind::kCar;
  body.height_m = 1.43;
  body.reach_m = 2.45;
  body.width_m = 2.35;
  body.rigid_parts = car_parts();
  const auto& paint = kPaints[draw.bits() % 6];
  const Rgb colour(paint[0], paint[1], paint[2]);
  const auto number = [&] { return static_cast<std::uint32_t>(draw.bits() >> 32U); };
  const auto even = [&](const Rgb& c, float contrast, float reflectivity) {
    return Material{Pattern::kPaint, c, c, 1.0F, contrast, reflectivity, number()};
  };
  body.materials = {
      even(colour, 0.06F, 0.15F + 0.5F * colour.mean()),
      {Pattern::kPane, Rgb(0.02F, 0.025F, 0.03F), Rgb::Zero(), 1.0F, 0.0F, 0.06F, 0},
      even({0.025F, 0.025F, 0.025F}, 0.3F, 0.06F),
      {Pattern::kMetal, Rgb(0.45F, 0.46F, 0.47F), Rgb::Zero(), 1.0F, 0.2F, 0.5F, number()},
      even({0.04F, 0.04F, 0.042F}, 0.2F, 0.1F),
      even({0.80F, 0.80F, 0.78F}, 0.1F, 0.8F),
      even({0.40F, 0.02F, 0.02F}, 0.1F, 0.6F),
      {Pattern::kSign, Rgb(0.75F, 0.75F, 0.72F), Rgb(0.03F, 0.03F, 0.05F), 0.52F, 0.0F, 0.9F, number()}};
  return body;
}

Parts pose_car(const MoverBody& body, const Stance& stance) {
  Parts out = body.rigid_parts;
  Eigen::Matrix3d world_from_car;
  world_from_car << stance.forward.x(), -stance.forward.y(), 0.0, stance.forward.y(), stance.forward.x(), 0.0,
      0.0, 0.0, 1.0;
  for (Primitive& part : out) {
    part.centre_m = stance.foot_m + world_from_car * part.centre_m;
    part.rotate(world_from_car * part.local_from_world.transpose());
  }
  return out;
}

}  // namespace edgesplat::simulate
