// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/colmap_model.hpp"

#include <cstddef>
#include <cstdint>

/// The first byte chooses file and form, the rest is the file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  using namespace edgesplat;
  using namespace edgesplat::io;
  if (size == 0) return 0;
  const auto bytes = std::as_bytes(std::span(first, size)).subspan(1);
  const auto form = (*first & 1U) == 0 ? ColmapForm::kBinary : ColmapForm::kText;
  switch ((*first >> 1U) % 3U) {
    case 0:
      if (const auto cameras = parse_colmap_cameras(bytes, form)) {
        for (const auto& [id, camera] : *cameras) {
          EDGESPLAT_CHECK(camera.validate().has_value(), "cameras make sense");
          (void)camera.project({0.3, -0.2, 1.0});
        }
      }
      break;
    case 1: {
      geometry::CameraModel camera{geometry::CameraKind::kPinhole, 64, 48, 50.0, 50.0, 31.5, 23.5};
      if (const auto images = parse_colmap_images(bytes, form, {{7, camera}})) {
        for (const PosedCamera& posed : *images)
          EDGESPLAT_CHECK(!posed.image.empty() && posed.map_from_camera.is_finite(),
                          "a name and a pose each");
      }
      break;
    }
    default:
      if (const auto cloud = parse_colmap_points(bytes, form)) {
        EDGESPLAT_CHECK(cloud->rgb.size() == cloud->points_m.size(), "a colour for each point");
        for (const Eigen::Vector3f& point : cloud->points_m)
          EDGESPLAT_CHECK(point.allFinite(), "points are finite");
      }
  }
  return 0;
}
