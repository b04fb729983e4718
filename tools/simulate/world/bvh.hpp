// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/primitive.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::simulate {

/// Bounding volume hierarchy over boxes, built with the binned surface area heuristic (Wald 2007).
/// Immutable after build, thread-safe.
class Bvh {
 public:
  Bvh() = default;
  explicit Bvh(std::span<const Bounds> boxes);

  /// Calls test(index, to_m) for each box that the ray meets before to_m, near ones first; test returns the
  /// new to_m, at most the old one (0 ends the walk). Returns the last to_m.
  template <typename Test>
  double walk(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction, double to_m,
              Test&& test) const;

 private:
  struct Node {  ///< 32 bytes; a leaf has count > 0 and owns order_[first .. first + count)
    std::array<float, 3> lo_m;
    std::uint32_t first;  ///< of an inner node: index of the left child; the right one follows it
    std::array<float, 3> hi_m;
    std::uint32_t count;
  };
  struct Item {
    Bounds box;
    Eigen::Vector3d centre;
    std::uint32_t index;
  };
  void split(std::uint32_t node, std::span<Item> items, std::uint32_t first);
  static void enclose(Node& node, const Bounds& box);

  struct FloatRay {
    std::array<float, 3> o;
    std::array<float, 3> inverse;
  };
  static float enter(const Node& node, const FloatRay& ray, float to_m) {
    float t0 = 0.0F, t1 = to_m;
    for (std::size_t i = 0; i < 3; ++i) {
      const float a = (node.lo_m[i] - ray.o[i]) * ray.inverse[i];
      const float b = (node.hi_m[i] - ray.o[i]) * ray.inverse[i];
      t0 = std::max(t0, std::min(a, b));
      t1 = std::min(t1, std::max(a, b));
    }
    return t0 <= t1 ? t0 : kMiss;
  }
  static constexpr float kMiss = 3e38F;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

template <typename Test>
double Bvh::walk(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction, double to_m,
                 Test&& test) const {
  if (nodes_.empty()) return to_m;
  FloatRay ray{};
  for (int i = 0; i < 3; ++i) {
    const double d = std::abs(direction[i]) < 1e-12 ? std::copysign(1e-12, direction[i]) : direction[i];
    ray.o[static_cast<std::size_t>(i)] = static_cast<float>(origin_m[i]);
    ray.inverse[static_cast<std::size_t>(i)] = static_cast<float>(1.0 / d);
  }
  struct Pending {
    std::uint32_t node;
    float enter;
  };
  std::array<Pending, 64> stack;
  std::size_t depth = 0;
  stack[depth++] = {0, enter(nodes_[0], ray, static_cast<float>(to_m))};
  while (depth > 0) {
    const Pending pending = stack[--depth];
    if (pending.enter > to_m) continue;
    const Node& node = nodes_[pending.node];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) to_m = test(order_[i], to_m);
      continue;
    }
    Pending near{node.first, enter(nodes_[node.first], ray, static_cast<float>(to_m))};
    Pending far{node.first + 1, enter(nodes_[node.first + 1], ray, static_cast<float>(to_m))};
    if (far.enter < near.enter) std::swap(near, far);
    if (far.enter < kMiss) stack[depth++] = far;
    if (near.enter < kMiss) stack[depth++] = near;
  }
  return to_m;
}

}  // namespace edgesplat::simulate
