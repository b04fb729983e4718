// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/places.hpp"
#include "tools/simulate/world/static_scene.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::simulate {
namespace {

class SceneWorld final : public World {
 public:
  explicit SceneWorld(Scene scene) : still_(std::move(scene)) {}

  [[nodiscard]] std::optional<Hit> cast(const Ray& ray, Visibility /*visibility*/) const override {
    const auto nearest = still_.nearest(ray.origin_m, ray.direction, kNearestRange_m, kFarthestRange_m);
    if (!nearest) return std::nullopt;
    const Primitive& primitive = still_.scene().primitives[nearest->primitive];
    const SurfacePoint at = surface_at(primitive, ray.origin_m + nearest->range_m * ray.direction);
    Hit hit;
    hit.range_m = nearest->range_m;
    hit.normal = at.normal.dot(ray.direction) > 0.0 ? Eigen::Vector3d(-at.normal) : at.normal;
    hit.reflectivity = still_.scene().materials[primitive.material].reflectivity;
    hit.surface = nearest->primitive * kFacesPerPrimitive + at.face;
    hit.uv_m = at.uv_m;
    return hit;
  }
  [[nodiscard]] Eigen::Vector3f radiance(const Ray& ray, const std::optional<Hit>& hit,
                                         double /*footprint_m*/, Visibility /*visibility*/) const override {
    if (!hit) return {0.5F, 0.6F, 0.8F};
    const Primitive& primitive = still_.scene().primitives[hit->surface / kFacesPerPrimitive];
    const auto facing = static_cast<float>(-hit->normal.dot(ray.direction));
    return still_.scene().materials[primitive.material].base * (0.4F + 0.5F * facing);
  }
  [[nodiscard]] Path path() const override { return still_.scene().path; }

 private:
  StaticScene still_;
};

}  // namespace

Result<std::unique_ptr<World>> World::create(const WorldConfig& config) {
  if (config.name == "corridor") return std::make_unique<SceneWorld>(make_corridor(config.seed));
  return fail(Errc::kInvalidConfig,
              "there is no world '" + config.name + "': use corridor, street, tunnel or square");
}

}  // namespace edgesplat::simulate
