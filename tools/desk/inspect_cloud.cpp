// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/gaussian_file.hpp"
#include "common/io/ply_points.hpp"
#include "tools/desk/inspection.hpp"

#include <Eigen/Geometry>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace edgesplat::desk {
namespace {

constexpr std::size_t kHeaderBytes = 8192;

bool holds_gaussians(const std::filesystem::path& path) {
  if (path.extension() != ".ply") return true;
  std::ifstream file(path, std::ios::binary);
  std::string header(kHeaderBytes, '\0');
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  header.resize(std::min(header.find("end_header"), header.size()));
  return header.find("f_dc_0") != std::string::npos || header.find("packed_position") != std::string::npos;
}

nlohmann::json vector_json(const Eigen::Vector3f& v) {
  return {v.x(), v.y(), v.z()};
}

std::string extent_text(const Eigen::AlignedBox3f& box) {
  if (box.isEmpty()) return "";
  const Eigen::Vector3f size = box.sizes();
  return fmt::format("extent {:.1f} x {:.1f} x {:.1f} m, from ({:.1f}, {:.1f}, {:.1f})\n", size.x(), size.y(),
                     size.z(), box.min().x(), box.min().y(), box.min().z());
}

void add_extent(nlohmann::json& json, const Eigen::AlignedBox3f& box) {
  if (box.isEmpty()) return;
  json["min_m"] = vector_json(box.min());
  json["max_m"] = vector_json(box.max());
}

Result<Inspection> inspect_points(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const io::PointCloud cloud, io::read_points_ply(path));
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& point : cloud.points_m) box.extend(point);
  nlohmann::json json = {
      {"kind", "points"}, {"points", cloud.points_m.size()}, {"coloured", !cloud.rgb.empty()}};
  add_extent(json, box);
  return Inspection{fmt::format("{} points, {}\n", cloud.points_m.size(),
                                cloud.rgb.empty() ? "without colours" : "coloured") +
                        extent_text(box),
                    json.dump()};
}

Result<Inspection> inspect_gaussians(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const gaussian::GaussianCloud cloud, io::read_gaussians(path));
  Eigen::AlignedBox3f box;
  double opacity_sum = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    box.extend(Eigen::Vector3f(cloud.means_m[3 * i], cloud.means_m[3 * i + 1], cloud.means_m[3 * i + 2]));
    opacity_sum += 1.0 / (1.0 + std::exp(-static_cast<double>(cloud.opacity_logits[i])));
  }
  const double mean_opacity = cloud.size() == 0 ? 0.0 : opacity_sum / static_cast<double>(cloud.size());
  nlohmann::json json = {{"kind", "gaussians"},
                         {"gaussians", cloud.size()},
                         {"sh_degree", cloud.sh_degree},
                         {"mean_opacity", mean_opacity}};
  add_extent(json, box);
  return Inspection{fmt::format("{} Gaussians, spherical harmonics of degree {}, mean opacity {:.2f}\n",
                                cloud.size(), cloud.sh_degree, mean_opacity) +
                        extent_text(box),
                    json.dump()};
}

}  // namespace

Result<Inspection> inspect_cloud(const std::filesystem::path& path) {
  return holds_gaussians(path) ? inspect_gaussians(path) : inspect_points(path);
}

}  // namespace edgesplat::desk
