// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/stored_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLift_m = 2e-3;      ///< shadow rays start this far off the surface
constexpr double kLampReach_m = 9.0;  ///< a lamp farther away adds less than 1/50 of its power
constexpr int kAmbientRays = 20;
constexpr int kMaxTexelsPerSide = 1024;
/// Part of the ambient light that a near thing reflects instead of blocking.
constexpr double kBounce = 0.3;

/// Directions around z, dense where the surface looks (cosine law), on a spiral.
std::array<Vector3d, kAmbientRays> make_hemisphere() {
  std::array<Vector3d, kAmbientRays> out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double r2 = (static_cast<double>(i) + 0.5) / kAmbientRays;
    const double angle = 2.399963229728653 * static_cast<double>(i);  // golden angle
    out[i] = {std::sqrt(r2) * std::cos(angle), std::sqrt(r2) * std::sin(angle), std::sqrt(1.0 - r2)};
  }
  return out;
}

/// Share of the ambient light that is left by things near by.
double openness(const StaticScene& still, const Vector3d& start, const Vector3d& normal) {
  static const std::array<Vector3d, kAmbientRays> kHemisphere = make_hemisphere();
  const Vector3d side =
      (std::abs(normal.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX()).cross(normal).normalized();
  const Vector3d other = normal.cross(side);
  const double reach_m = still.scene().light.ambient_reach_m;
  double sum = 0.0;
  for (const Vector3d& d : kHemisphere) {
    const Vector3d direction = d.x() * side + d.y() * other + d.z() * normal;
    const auto hit = still.nearest(start, direction, 0.0, reach_m);
    sum += hit ? std::max(kBounce, hit->range_m / reach_m) : 1.0;
  }
  return sum / kAmbientRays;
}

Rgb ambient(const Light& light, const Vector3d& normal) {
  const auto up = static_cast<float>(0.5 + 0.5 * normal.z());
  return light.ambient_down + up * (light.ambient_up - light.ambient_down);
}

/// Light of one point of a lamp, before shadows: irradiance per unit of power.
double lamp_gain(const Vector3d& to_lamp, const Vector3d& normal) {
  const double d2 = to_lamp.squaredNorm(), d = std::sqrt(d2);
  const double here = normal.dot(to_lamp) / d, there = to_lamp.z() / d;
  return here <= 0.0 || there <= 0.0 ? 0.0 : here * there / std::max(d2, 0.3);
}

Rgb lamp_light(const StaticScene& still, const Vector3d& start, const Vector3d& normal) {
  Rgb sum = Rgb::Zero();
  for (const Lamp& lamp : still.scene().light.lamps) {
    if ((lamp.centre_m - start).squaredNorm() > kLampReach_m * kLampReach_m) continue;
    double gain = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
      const Vector3d point =
          lamp.centre_m + 0.6 * Vector3d((corner & 1) != 0 ? lamp.half_m.x() : -lamp.half_m.x(),
                                         (corner & 2) != 0 ? lamp.half_m.y() : -lamp.half_m.y(), 0.0);
      const Vector3d to_lamp = point - start;
      const double part = lamp_gain(to_lamp, normal);
      if (part < 1e-4) continue;
      const double distance = to_lamp.norm();
      if (!still.blocked(start, to_lamp / distance, 0.0, distance - kLift_m)) gain += part / 4.0;
    }
    sum += static_cast<float>(gain) * lamp.power;
  }
  return sum;
}

/// Five directions in a cone make the border of a shadow soft.
Rgb sun_light(const StaticScene& still, const Vector3d& start, const Vector3d& normal) {
  const auto& sun = still.scene().light.sun;
  if (!sun || normal.dot(sun->towards) <= 0.0) return Rgb::Zero();
  int lit = 0;
  for (int i = 0; i < 5; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 4.0, spread = i == 4 ? 0.0 : 0.012;
    const Vector3d towards =
        (sun->towards + spread * Vector3d(std::cos(angle), std::sin(angle), 0.0)).normalized();
    if (!still.blocked(start, towards, 0.0, kFarthestRange_m)) ++lit;
  }
  return sun->irradiance * static_cast<float>(normal.dot(sun->towards) * lit / 5.0);
}

Irradiance sum_up(const Rgb& ambient_and_lamps, const Rgb& sun) {
  Irradiance out{ambient_and_lamps + sun, 0.0F};
  const float total = out.total.sum();
  if (total > 0.0F) out.sun_share = sun.sum() / total;
  return out;
}

/// Four times 16 bits; the last one is never 0.
constexpr float kMaxStored = 8.0F;
std::uint64_t pack(const Irradiance& light) {
  std::uint64_t bits = 1 + static_cast<std::uint64_t>(std::clamp(light.sun_share, 0.0F, 1.0F) * 65534.0F);
  for (int i = 0; i < 3; ++i) {
    const float unit = std::clamp(light.total[i] / kMaxStored, 0.0F, 1.0F);
    bits |= static_cast<std::uint64_t>(std::lround(unit * 65535.0F)) << (16U * static_cast<unsigned>(i + 1));
  }
  return bits;
}

Irradiance unpack(std::uint64_t bits) {
  Irradiance light;
  light.sun_share = static_cast<float>((bits & 0xFFFFU) - 1) / 65534.0F;
  for (int i = 0; i < 3; ++i)
    light.total[i] =
        static_cast<float>(bits >> (16U * static_cast<unsigned>(i + 1)) & 0xFFFFU) * (kMaxStored / 65535.0F);
  return light;
}

}  // namespace

Irradiance light_at(const StaticScene& still, const Vector3d& p, const Vector3d& normal) {
  const Vector3d start = p + kLift_m * normal;
  const auto open = static_cast<float>(openness(still, start, normal));
  return sum_up(ambient(still.scene().light, normal) * open + lamp_light(still, start, normal),
                sun_light(still, start, normal));
}

Irradiance open_light_at(const StaticScene& still, const Vector3d& p, const Vector3d& normal) {
  const Light& light = still.scene().light;
  Rgb lamps = Rgb::Zero();
  for (const Lamp& lamp : light.lamps)
    if ((lamp.centre_m - p).squaredNorm() < kLampReach_m * kLampReach_m)
      lamps += static_cast<float>(lamp_gain(lamp.centre_m - p, normal)) * lamp.power;
  Rgb sun = Rgb::Zero();
  if (light.sun && normal.dot(light.sun->towards) > 0.0 &&
      !still.blocked(p + kLift_m * normal, light.sun->towards, 0.0, kFarthestRange_m))
    sun = light.sun->irradiance * static_cast<float>(normal.dot(light.sun->towards));
  return sum_up(0.85F * ambient(light, normal) + lamps, sun);
}

StoredLight::StoredLight(const StaticScene& still) : still_(still) {
  std::uint32_t count = 0;
  const auto cells = [&](double size_m) {
    const auto wanted = static_cast<int>(std::ceil(size_m / still.scene().light.texel_m));
    return static_cast<std::uint16_t>(std::clamp(wanted, 2, kMaxTexelsPerSide));
  };
  for (const Primitive& primitive : still.scene().primitives) {
    for (std::uint32_t face = 0; face < kFacesPerPrimitive; ++face) {
      const Vector2d size = face_size_m(primitive, face);
      Face f;
      if (size.minCoeff() > 0.0) f = {count, cells(size.x()), cells(size.y())};
      count += static_cast<std::uint32_t>(f.columns) * f.rows;
      faces_.push_back(f);
    }
  }
  texels_ = std::vector<std::atomic<std::uint64_t>>(count);
}

Irradiance StoredLight::texel(std::uint32_t surface, const Face& face, int column, int row) const {
  std::atomic<std::uint64_t>& slot = texels_[face.first + static_cast<std::uint32_t>(row) * face.columns +
                                             static_cast<std::uint32_t>(column)];
  std::uint64_t bits = slot.load(std::memory_order_relaxed);
  if (bits == 0) {
    const Primitive& primitive = still_.scene().primitives[surface / kFacesPerPrimitive];
    const std::uint32_t side = surface % kFacesPerPrimitive;
    const Vector2d size = face_size_m(primitive, side);
    const Vector2d uv((column + 0.5) / face.columns * size.x(), (row + 0.5) / face.rows * size.y());
    const FacePoint point = face_point(primitive, side, uv);
    bits = pack(light_at(still_, point.p_in_world_m, point.normal));
    slot.store(bits, std::memory_order_relaxed);
  }
  return unpack(bits);
}

Irradiance StoredLight::at(std::uint32_t surface, const Vector2d& uv_m) const {
  const Face& face = faces_[surface];
  if (face.columns == 0) return {};
  const Vector2d size =
      face_size_m(still_.scene().primitives[surface / kFacesPerPrimitive], surface % kFacesPerPrimitive);
  const double x = std::clamp(uv_m.x() / size.x() * face.columns - 0.5, 0.0, face.columns - 1.0);
  const double y = std::clamp(uv_m.y() / size.y() * face.rows - 0.5, 0.0, face.rows - 1.0);
  const int column = std::min(static_cast<int>(x), face.columns - 2);
  const int row = std::min(static_cast<int>(y), face.rows - 2);
  const auto tx = static_cast<float>(x - column), ty = static_cast<float>(y - row);
  Irradiance out;
  for (int corner = 0; corner < 4; ++corner) {
    const bool right = (corner & 1) != 0, top = (corner & 2) != 0;
    const float weight = (right ? tx : 1.0F - tx) * (top ? ty : 1.0F - ty);
    if (weight <= 0.0F) continue;
    const Irradiance part = texel(surface, face, column + (right ? 1 : 0), row + (top ? 1 : 0));
    out.total += weight * part.total;
    out.sun_share += weight * part.sun_share;
  }
  return out;
}

}  // namespace edgesplat::simulate
