// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/map_samples.hpp"

#include "common/map/row_codec.hpp"
#include "test/support/random.hpp"

#include <memory>

namespace edgesplat::test {
namespace {

float small(Random& random) {
  return static_cast<float>(random.uniform(-1.0, 1.0));
}

sensor::CameraMount sample_camera() {
  sensor::CameraMount mount;
  mount.model.kind = geometry::CameraKind::kFisheye;
  mount.model.width_px = 640;
  mount.model.height_px = 480;
  mount.model.fx_px = 320.5;
  mount.model.fy_px = 321.5;
  mount.model.cx_px = 319.25;
  mount.model.cy_px = 239.75;
  mount.model.distortion = {0.01, -0.02, 0.003, -0.0004};
  mount.body_from_camera.translation_m = {0.1, 0.0, 0.05};
  mount.stamp_delay_s = 0.002;
  return mount;
}

}  // namespace

gaussian::GaussianCloud random_gaussians(std::size_t count, std::uint64_t seed, int sh_degree,
                                         std::uint16_t origin) {
  Random random(seed);
  gaussian::GaussianCloud cloud;
  cloud.sh_degree = sh_degree;
  cloud.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.ids[i] = gaussian::GaussianId(origin, i + 1);
    const Eigen::Quaterniond q = random.rotation();
    for (std::size_t k = 0; k < 4; ++k) {
      cloud.quats_xyzw[4 * i + k] = static_cast<float>(q.coeffs()[static_cast<Eigen::Index>(k)]);
    }
    cloud.anchors[i] = {3, 0};
  }
  for (float& v : cloud.means_m) v = 25.0F * small(random);
  for (float& v : cloud.log_scales) v = -3.0F + small(random);
  for (float& v : cloud.opacity_logits) v = 2.0F * small(random);
  for (float& v : cloud.sh) v = small(random);
  return cloud;
}

map::QuantisedRows quantised(const gaussian::GaussianCloud& cloud) {
  map::QuantisedRows rows;
  rows.sh_degree = cloud.sh_degree;
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    const float* m = cloud.means_m.data() + 3 * row;
    map::append_quantised(cloud, row, map::chunk_of({m[0], m[1], m[2]}), rows);
  }
  return map::sorted_by_chunk(rows);
}

map::QuantisedRows random_rows(std::size_t count, std::uint64_t seed, int sh_degree) {
  return quantised(random_gaussians(count, seed, sh_degree));
}

map::Keyframe random_keyframe(std::uint32_t id, std::size_t points, std::uint64_t seed) {
  Random random(seed);
  map::Keyframe keyframe;
  keyframe.id.value = id;
  keyframe.stamp = HostTime(nanoseconds(123456789012345));
  keyframe.odom_from_body = random.transform();
  keyframe.pose_covariance.setIdentity();
  keyframe.pose_covariance(0, 5) = keyframe.pose_covariance(5, 0) = 0.25;
  keyframe.pose_version = 2;
  keyframe.exposure_s = 0.004F;
  keyframe.camera = sample_camera();
  auto image = std::make_shared<map::EncodedImage>();
  image->width_px = 640;
  image->height_px = 480;
  for (int i = 0; i < 300; ++i) image->bytes.push_back(static_cast<std::byte>(random.below(256)));
  keyframe.image = std::move(image);
  for (std::size_t i = 0; i < points; ++i) {
    map::ColouredPoint point;
    point.p_in_body_m = random.vector(30.0).cast<float>();
    for (auto& c : point.rgb) c = static_cast<std::uint8_t>(random.below(256));
    point.has_colour = random.below(3) != 0;
    keyframe.points_in_body.push_back(point);
  }
  return keyframe;
}

map::Keyframe wall_keyframe(std::uint32_t id, std::size_t points, double first_y_m) {
  Random random(id);
  map::Keyframe keyframe;
  keyframe.id.value = id;
  keyframe.camera = sample_camera();
  for (std::size_t i = 0; i < points; ++i) {
    map::ColouredPoint point;
    const double y_m = random.uniform(first_y_m, first_y_m + 4.0);
    point.p_in_body_m = Eigen::Vector3d(3.0, y_m, random.uniform(-1.0, 1.0)).cast<float>();
    point.rgb = {200, 100, 50};
    point.has_colour = true;
    keyframe.points_in_body.push_back(point);
  }
  return keyframe;
}

}  // namespace edgesplat::test
