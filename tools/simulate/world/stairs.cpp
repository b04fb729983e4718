// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/noise.hpp"
#include "tools/simulate/world/curve.hpp"
#include "tools/simulate/world/places.hpp"
#include "tools/simulate/world/wall.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace edgesplat::simulate {
namespace {

/// Four flights around a wall, of ten steps each, landings between them. Even flights climb along +x at the
/// side of small y, odd ones back along -x at the other side.
constexpr int kFlights = 4, kSteps = 10;
constexpr double kRun_m = 0.28, kRise_m = 0.17;
constexpr double kLanding_m = 2.4, kFlight_m = kSteps * kRun_m, kLength_m = 2 * kLanding_m + kFlight_m;
constexpr double kWidth_m = 2.0, kSpine_m = 0.3, kDepth_m = 2 * kWidth_m + kSpine_m;
constexpr double kFlightRise_m = kSteps * kRise_m;
constexpr double kHeight_m = kFlights * kFlightRise_m + 3.0;
constexpr double kSlab_m = 0.25;

void add_flight(Scene& s, int flight, std::uint32_t step, std::uint32_t slab) {
  const bool onward = flight % 2 == 0;
  const double y0 = onward ? 0.0 : kWidth_m + kSpine_m;
  const double foot_m = flight * kFlightRise_m;
  for (int i = 0; i < kSteps; ++i) {
    const double from_foot_m = i * kRun_m;
    const double x0 = onward ? kLanding_m + from_foot_m : kLanding_m + kFlight_m - from_foot_m - kRun_m;
    const double top_m = foot_m + (i + 1) * kRise_m;
    s.add_box({x0, y0, top_m - kRise_m - kSlab_m}, {x0 + kRun_m, y0 + kWidth_m, top_m}, step);
  }
  const double landing_x0 = onward ? kLanding_m + kFlight_m : 0.0;
  const double top_m = foot_m + kFlightRise_m;
  s.add_box({landing_x0, 0.0, top_m - kSlab_m}, {landing_x0 + kLanding_m, kDepth_m, top_m}, slab);
}

void add_shell(Scene& s, std::uint32_t seed) {
  const auto concrete = [&](const Rgb& colour, std::uint32_t number) {
    return s.add({Pattern::kConcrete, colour, colour * 0.8F, 1.2F, 0.12F, 0.5F, seed + number});
  };
  const auto walls = concrete({0.56F, 0.55F, 0.52F}, 1), spine = concrete({0.50F, 0.42F, 0.33F}, 2);
  const auto floor =
      s.add({Pattern::kTiles, {0.42F, 0.40F, 0.37F}, {0.16F, 0.15F, 0.14F}, 0.4F, 0.16F, 0.35F, seed + 3});
  const auto step =
      s.add({Pattern::kTiles, {0.36F, 0.35F, 0.33F}, {0.15F, 0.15F, 0.14F}, 0.5F, 0.2F, 0.4F, seed + 4});
  s.add_box({-0.2, -0.2, -0.2}, {kLength_m + 0.2, kDepth_m + 0.2, 0.0}, floor);
  s.add_box({-0.2, -0.2, kHeight_m}, {kLength_m + 0.2, kDepth_m + 0.2, kHeight_m + 0.2}, walls);
  s.add_box({-0.2, -0.2, 0.0}, {kLength_m + 0.2, 0.0, kHeight_m}, walls);
  s.add_box({-0.2, kDepth_m, 0.0}, {kLength_m + 0.2, kDepth_m + 0.2, kHeight_m}, walls);
  s.add_box({-0.2, 0.0, 0.0}, {0.0, kDepth_m, kHeight_m}, walls);
  s.add_box({kLength_m, 0.0, 0.0}, {kLength_m + 0.2, kDepth_m, kHeight_m}, walls);
  s.add_box({kLanding_m, kWidth_m, 0.0}, {kLanding_m + kFlight_m, kWidth_m + kSpine_m, kHeight_m}, spine);
  for (int flight = 0; flight < kFlights; ++flight) add_flight(s, flight, step, floor);
}

/// On every landing's end wall two things to see, and a lamp over it.
void add_fittings_of_landings(Scene& s, std::uint64_t seed) {
  const auto number = static_cast<std::uint32_t>(mix_bits(seed));
  const Fittings with = add_fittings(s, number + 100);
  const auto glow = s.add({Pattern::kLamp, {0.97F, 0.97F, 0.93F}, Rgb::Ones(), 1.0F, 0.0F, 0.8F, 0, 0.97F});
  for (int landing = 0; landing <= kFlights; ++landing) {
    const bool at_start = landing % 2 == 0;
    Wall end = at_start ? make_wall({0.0, 0.0}, {0.0, kDepth_m})
                        : make_wall({kLength_m, kDepth_m}, {kLength_m, 0.0});
    end.foot_m = landing * kFlightRise_m;
    for (const double middle_m : {0.9, 2.1, 3.4}) {
      NoiseStream draw(seed, NoisePurpose::kPlace, static_cast<std::uint64_t>(10 * landing + middle_m));
      add_poster(s, end, with,
                 {middle_m + 0.2 * draw.uniform(), static_cast<std::uint32_t>(draw.bits() >> 32U)});
    }
    const double x = at_start ? 0.5 * kLanding_m : kLength_m - 0.5 * kLanding_m;
    const double up_m = std::min(landing * kFlightRise_m + 2 * kFlightRise_m - kSlab_m, kHeight_m);
    const Eigen::Vector3d at(x, 0.5 * kDepth_m, up_m);
    s.add_box(at - Eigen::Vector3d(0.15, 0.6, 0.04), at + Eigen::Vector3d(0.15, 0.6, 0.0), glow);
    s.light.lamps.push_back({at - Eigen::Vector3d(0, 0, 0.05), {0.15, 0.6}, Rgb(4.0F, 3.9F, 3.6F)});
  }
}

/// Up the middle of the flights, over the line of the steps' edges.
Polyline climb(double over_m) {
  constexpr double kTurn_m = 0.5 * (kWidth_m + kSpine_m);  // radius on the landings
  constexpr double kStep_m = 0.2;
  Polyline line;
  const auto add = [&](double x, double y, double z) { line.push_back({x, y, z + over_m}); };
  for (int flight = 0; flight < kFlights; ++flight) {
    const bool onward = flight % 2 == 0;
    const double y = onward ? 0.5 * kWidth_m : 1.5 * kWidth_m + kSpine_m;
    const auto x_of = [&](double along_m) { return onward ? along_m : kLength_m - along_m; };
    const double first_m = flight == 0 ? 1.0 : kLanding_m - 0.05;
    for (double along_m = first_m; along_m < kLanding_m + kFlight_m + 0.05; along_m += kStep_m) {
      const double climbed = std::clamp((along_m - kLanding_m + 0.5 * kRun_m) / kFlight_m, 0.0, 1.0);
      add(x_of(along_m), y, (flight + climbed) * kFlightRise_m);
    }
    const Eigen::Vector2d centre(x_of(kLanding_m + kFlight_m + 0.05), 0.5 * kDepth_m);
    constexpr int kParts = 16;
    for (int i = 1; i < kParts && flight + 1 < kFlights; ++i) {
      const double angle = std::numbers::pi * i / kParts;
      add(centre.x() + (onward ? 1.0 : -1.0) * kTurn_m * std::sin(angle),
          centre.y() - (onward ? 1.0 : -1.0) * kTurn_m * std::cos(angle), (flight + 1) * kFlightRise_m);
    }
  }
  return line;
}

/// Nobody's body follows the edge at which a flight begins.
Polyline rounded(const Polyline& line) {
  Polyline out = line;
  for (std::size_t i = 1; i + 1 < line.size(); ++i)
    out[i] = 0.25 * line[i - 1] + 0.5 * line[i] + 0.25 * line[i + 1];
  return out;
}

}  // namespace

/// A stairwell over two storeys, climbed: the way goes up, nods and turns on the spot.
Scene make_stairs(std::uint64_t seed) {
  Scene s;
  add_shell(s, static_cast<std::uint32_t>(mix_bits(seed)));
  add_fittings_of_landings(s, seed);
  s.light.ambient_up = {0.32F, 0.32F, 0.31F};
  s.light.ambient_down = {0.40F, 0.39F, 0.36F};
  s.light.ambient_reach_m = 1.2;
  s.light.texel_m = 0.15;
  s.path = {rounded(climb(0.6)), false, 1.0};
  const Polyline ground = climb(0.0);
  s.footways = {{offset_left(ground, false, -0.6), false, 0.7},
                {offset_left(ground, false, 0.6), false, -0.6}};
  return s;
}

}  // namespace edgesplat::simulate
