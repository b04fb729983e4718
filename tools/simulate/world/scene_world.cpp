// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/crowd.hpp"
#include "tools/simulate/world/mover_rays.hpp"
#include "tools/simulate/world/places.hpp"
#include "tools/simulate/world/shading.hpp"
#include "tools/simulate/world/static_scene.hpp"
#include "tools/simulate/world/stored_light.hpp"

#include <utility>

namespace edgesplat::simulate {
namespace {

Hit describe(const Primitive& primitive, std::uint32_t number, const Ray& ray, double range_m) {
  const SurfacePoint at = surface_at(primitive, ray.origin_m + range_m * ray.direction);
  Hit hit;
  hit.range_m = range_m;
  hit.normal = at.normal.dot(ray.direction) > 0.0 ? Eigen::Vector3d(-at.normal) : at.normal;
  hit.surface = number * kFacesPerPrimitive + at.face;
  hit.uv_m = at.uv_m;
  return hit;
}

/// The static scene with its stored light, and everybody in it. Immutable, thread-safe.
struct Place {
  Place(Scene scene, const WorldConfig& config)
      : still(std::move(scene)), light(still), crowd(still.scene(), config) {}
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  template <typename Movers>
  [[nodiscard]] std::optional<Hit> cast(const Movers& movers, const Ray& ray, Visibility visibility) const {
    const auto nearest = still.nearest(ray.origin_m, ray.direction, kNearestRange_m, kFarthestRange_m);
    if (visibility == Visibility::kEverything) {
      const double limit_m = nearest ? nearest->range_m : kFarthestRange_m;
      if (const auto found = nearest_mover(movers, ray, limit_m)) {
        Hit hit = describe(found->primitive, static_cast<std::uint32_t>(found->part), ray, found->range_m);
        hit.mover = static_cast<std::uint16_t>(found->mover + 1);
        hit.reflectivity = crowd.body(found->mover).materials[found->primitive.material].reflectivity;
        return hit;
      }
    }
    if (!nearest) return std::nullopt;
    const Primitive& primitive = still.scene().primitives[nearest->primitive];
    Hit hit = describe(primitive, nearest->primitive, ray, nearest->range_m);
    hit.reflectivity = still.scene().materials[primitive.material].reflectivity;
    return hit;
  }

  template <typename Movers>
  [[nodiscard]] float shade(const Movers& movers, const Ray& ray, const Hit& hit) const {
    if (movers.size() == 0 || hit.mover != 0) return 1.0F;
    const Material& material = material_of(hit);
    if (material.pattern == Pattern::kLamp || material.pattern == Pattern::kWindowView) return 1.0F;
    const float sun_share = still.scene().light.sun ? light.at(hit.surface, hit.uv_m).sun_share : 0.0F;
    return mover_light_left(movers, still.scene(), {ray.origin_m + hit.range_m * ray.direction, hit.normal},
                            sun_share);
  }

  template <typename Movers>
  [[nodiscard]] Rgb radiance(const Movers& movers, const Ray& ray, const std::optional<Hit>& hit,
                             double footprint_m, Visibility visibility) const {
    if (!hit) return sky_radiance(ray.direction);
    if (hit->mover != 0) {
      const Eigen::Vector3d p = ray.origin_m + hit->range_m * ray.direction;
      const Material& material = crowd.body(hit->mover - 1U).materials[movers_material(movers, *hit)];
      return surface_radiance(material, ray, *hit, open_light_at(still, p, hit->normal).total, footprint_m);
    }
    const Rgb colour =
        surface_radiance(material_of(*hit), ray, *hit, light.at(hit->surface, hit->uv_m).total, footprint_m);
    return visibility == Visibility::kEverything ? Rgb(colour * shade(movers, ray, *hit)) : colour;
  }

  StaticScene still;
  StoredLight light;
  Crowd crowd;

 private:
  [[nodiscard]] const Material& material_of(const Hit& hit) const {
    return still.scene().materials[still.scene().primitives[hit.surface / kFacesPerPrimitive].material];
  }
  template <typename Movers>
  [[nodiscard]] static std::uint32_t movers_material(const Movers& movers, const Hit& hit) {
    return movers.parts(hit.mover - 1U)[hit.surface / kFacesPerPrimitive].material;
  }
};

class FrozenWorld final : public World {
 public:
  FrozenWorld(const Place& place, double time_s) : place_(place), crowd_(place.crowd, time_s) {}
  [[nodiscard]] std::optional<Hit> cast(const Ray& ray, Visibility visibility) const override {
    return place_.cast(crowd_, ray, visibility);
  }
  [[nodiscard]] Eigen::Vector3f radiance(const Ray& ray, const std::optional<Hit>& hit, double footprint_m,
                                         Visibility visibility) const override {
    return place_.radiance(crowd_, ray, hit, footprint_m, visibility);
  }
  [[nodiscard]] float mover_shade(const Ray& ray, const Hit& hit) const override {
    return place_.shade(crowd_, ray, hit);
  }
  [[nodiscard]] Path path() const override { return place_.still.scene().path; }

 private:
  const Place& place_;
  PosedCrowd crowd_;
};

class SceneWorld final : public World {
 public:
  SceneWorld(Scene scene, const WorldConfig& config) : place_(std::move(scene), config) {}
  [[nodiscard]] std::optional<Hit> cast(const Ray& ray, Visibility visibility) const override {
    return place_.cast(CrowdAt(place_.crowd, ray.time_s), ray, visibility);
  }
  [[nodiscard]] Eigen::Vector3f radiance(const Ray& ray, const std::optional<Hit>& hit, double footprint_m,
                                         Visibility visibility) const override {
    return place_.radiance(CrowdAt(place_.crowd, ray.time_s), ray, hit, footprint_m, visibility);
  }
  [[nodiscard]] float mover_shade(const Ray& ray, const Hit& hit) const override {
    return place_.shade(CrowdAt(place_.crowd, ray.time_s), ray, hit);
  }
  [[nodiscard]] std::unique_ptr<const World> frozen_at(double time_s) const override {
    return std::make_unique<FrozenWorld>(place_, time_s);
  }
  [[nodiscard]] Path path() const override { return place_.still.scene().path; }

 private:
  Place place_;
};

}  // namespace

Result<std::unique_ptr<World>> World::create(const WorldConfig& config) {
  if (config.pedestrians < 0 || config.pedestrians > 100)
    return fail(Errc::kInvalidConfig, "world: pedestrians must be 0..100");
  if (config.cars < 0 || config.cars > 50) return fail(Errc::kInvalidConfig, "world: cars must be 0..50");
  const auto built = [&](Scene scene) -> std::unique_ptr<World> {
    return std::make_unique<SceneWorld>(std::move(scene), config);
  };
  if (config.name == "corridor") return built(make_corridor(config.seed));
  if (config.name == "bare") return built(make_bare_corridor());
  if (config.name == "loop") return built(make_loop(config.seed));
  if (config.name == "stairs") return built(make_stairs(config.seed));
  if (config.name == "street") return built(make_street(config.seed));
  if (config.name == "tunnel") return built(make_tunnel(config.seed));
  if (config.name == "square") return built(make_square(config.seed));
  return fail(Errc::kInvalidConfig, "there is no world '" + config.name +
                                        "': use corridor, bare, loop, stairs, street, tunnel or square");
}

}  // namespace edgesplat::simulate
