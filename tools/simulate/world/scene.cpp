// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/scene.hpp"

namespace edgesplat::simulate {

void Scene::add_box(const Eigen::Vector3d& lo_m, const Eigen::Vector3d& hi_m, std::uint32_t material) {
  Primitive box;
  box.shape = Shape::kBox;
  box.material = material;
  box.centre_m = (lo_m + hi_m) / 2.0;
  box.half_m = (hi_m - lo_m).cwiseAbs() / 2.0;
  primitives.push_back(box);
}

void Scene::add_pillar(const Eigen::Vector3d& foot_m, double radius_m, double height_m,
                       std::uint32_t material) {
  Primitive pillar;
  pillar.shape = Shape::kCylinder;
  pillar.material = material;
  pillar.centre_m = foot_m + Eigen::Vector3d(0, 0, height_m / 2.0);
  pillar.half_m = {radius_m, radius_m, height_m / 2.0};
  primitives.push_back(pillar);
}

void Scene::add_ellipsoid(const Eigen::Vector3d& centre_m, const Eigen::Vector3d& half_m,
                          std::uint32_t material) {
  Primitive ball;
  ball.shape = Shape::kEllipsoid;
  ball.material = material;
  ball.centre_m = centre_m;
  ball.half_m = half_m;
  primitives.push_back(ball);
}

}  // namespace edgesplat::simulate
