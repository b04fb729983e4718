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
  /// The fourth lane of the box is [0, 1]: with FloatRay's fourth lane it keeps `enter` at or above 0.
  struct Node {
    Eigen::Array4f lo_m{0.0F, 0.0F, 0.0F, 0.0F};
    Eigen::Array4f hi_m{0.0F, 0.0F, 0.0F, 1.0F};
    std::uint32_t first =
        0;  ///< of a leaf: into order_; of an inner node: its left child, the right one follows
    std::uint32_t count = 0;  ///< 0: an inner node
  };
  struct Item {
    Bounds box;
    Eigen::Vector3d centre;
    std::uint32_t index;
  };
  void split(std::uint32_t node, std::span<Item> items, std::uint32_t first);
  static void enclose(Node& node, const Bounds& box);

  struct FloatRay {
    Eigen::Array4f o{0.0F, 0.0F, 0.0F, 0.0F};
    Eigen::Array4f inverse{0.0F, 0.0F, 0.0F, 1e30F};
  };
  static float enter(const Node& node, const FloatRay& ray, float to_m) {
    const Eigen::Array4f a = (node.lo_m - ray.o) * ray.inverse;
    const Eigen::Array4f b = (node.hi_m - ray.o) * ray.inverse;
    const float first = a.min(b).maxCoeff(), last = a.max(b).minCoeff();
    return first <= std::min(last, to_m) ? first : kMiss;
  }
  static constexpr float kMiss = 3e38F;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

template <typename Test>
double Bvh::walk(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction, double to_m,
                 Test&& test) const {
  if (nodes_.empty()) return to_m;
  FloatRay ray;
  for (int i = 0; i < 3; ++i) {
    const double d = std::abs(direction[i]) < 1e-12 ? std::copysign(1e-12, direction[i]) : direction[i];
    ray.o[i] = static_cast<float>(origin_m[i]);
    ray.inverse[i] = static_cast<float>(1.0 / d);
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
