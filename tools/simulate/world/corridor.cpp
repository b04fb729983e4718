// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/curve.hpp"
#include "tools/simulate/world/places.hpp"

namespace edgesplat::simulate {

Scene make_corridor(std::uint64_t /*seed*/) {
  Scene s;
  const auto wall =
      s.add(Material{.pattern = Pattern::kPlaster, .base = {0.7F, 0.68F, 0.62F}, .reflectivity = 0.7F});
  const auto wood =
      s.add(Material{.pattern = Pattern::kWood, .base = {0.4F, 0.25F, 0.12F}, .reflectivity = 0.4F});
  s.add_box({-2, -2, -0.2}, {20, 14, 0}, wall);
  s.add_box({-2, -2, 2.8}, {20, 14, 3.0}, wall);
  s.add_box({1.5, 1.5, 0}, {16.5, 10.5, 2.8}, wall);
  s.add_box({-2, -2, 0}, {20, -1.5, 2.8}, wall);
  s.add_box({-2, 13.5, 0}, {20, 14, 2.8}, wall);
  s.add_box({-2, -1.5, 0}, {-1.5, 13.5, 2.8}, wall);
  s.add_box({19.5, -1.5, 0}, {20, 13.5, 2.8}, wall);
  for (int i = 0; i < 8; ++i) s.add_box({1.0 + 2 * i, -1.5, 0}, {1.9 + 2 * i, -1.44, 2.1}, wood);
  const Polyline corners{{0, 0, 0.6}, {18, 0, 0.6}, {18, 12, 0.6}, {0, 12, 0.6}};
  s.path = {resample(smooth_closed(corners, 0.8), true, 0.3), true, 1.3};
  return s;
}

}  // namespace edgesplat::simulate
