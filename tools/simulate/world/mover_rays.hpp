// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/crowd.hpp"
#include "tools/simulate/world/stored_light.hpp"

#include <optional>

namespace edgesplat::simulate {

struct MoverHit {
  std::size_t mover = 0;
  std::size_t part = 0;
  double range_m = 0.0;
  Primitive primitive;  ///< the part as posed
};

/// Nearest part of a mover before `to_m`.
template <typename Movers>
[[nodiscard]] std::optional<MoverHit> nearest_mover(const Movers& movers, const Ray& ray, double to_m);

/// What the movers leave of the ambient light and the lamps' (soft, short) and of the sun's (sharp); exactly
/// 1 away from them.
template <typename Movers>
[[nodiscard]] float mover_light_left(const Movers& movers, const Scene& scene, const FacePoint& at,
                                     float sun_share);

extern template std::optional<MoverHit> nearest_mover(const CrowdAt&, const Ray&, double);
extern template std::optional<MoverHit> nearest_mover(const PosedCrowd&, const Ray&, double);
extern template float mover_light_left(const CrowdAt&, const Scene&, const FacePoint&, float);
extern template float mover_light_left(const PosedCrowd&, const Scene&, const FacePoint&, float);

}  // namespace edgesplat::simulate
