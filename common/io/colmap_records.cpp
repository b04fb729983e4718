// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"
#include "common/io/colmap_model.hpp"
#include "common/io/colmap_text.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace edgesplat::io {
namespace {

constexpr std::size_t kLongestName = 1024;

/// Of both forms: COLMAP's pose qw qx qy qz tx ty tz is camera_from_map.
template <typename Reader>
geometry::RigidTransform read_camera_from_map(Reader& in) {
  std::array<double, 7> v{};
  for (double& value : v) value = in.template read<double>();
  return {Eigen::Quaterniond(v[0], v[1], v[2], v[3]), {v[4], v[5], v[6]}};
}

Result<PosedCamera> to_posed(geometry::RigidTransform camera_from_map, std::uint32_t camera_id,
                             std::string name, const ColmapCameras& cameras) {
  const auto bad = [&name](const std::string& why) {
    return fail(Errc::kCorrupt, "image " + name.substr(0, 100) + ": " + why);
  };
  if (name.empty()) return bad("it has no name");
  const double norm = camera_from_map.rotation.norm();
  if (!camera_from_map.is_finite() || !(norm > 1e-6 && norm < 1e6))
    return bad("its pose is no rotation and translation");
  camera_from_map.rotation.normalize();
  const auto camera = cameras.find(camera_id);
  if (camera == cameras.end()) return bad("there is no camera " + std::to_string(camera_id));
  PosedCamera out;
  out.camera = camera->second;
  out.map_from_camera = camera_from_map.inverse();
  if (!out.map_from_camera.is_finite()) return bad("its pose is no rotation and translation");
  out.image = std::move(name);
  return out;
}

/// Up to the zero that ends it.
std::string read_name(ByteReader& in) {
  std::string name;
  for (char letter = in.read<char>(); letter != '\0' && name.size() <= kLongestName; letter = in.read<char>())
    name += letter;
  return name;
}

Result<std::vector<PosedCamera>> parse_binary_images(std::span<const std::byte> bytes,
                                                     const ColmapCameras& cameras) {
  constexpr std::size_t kLeastRecordBytes = 4 + 7 * 8 + 4 + 1 + 8;
  constexpr std::uint64_t kFeatureBytes = 24;
  ByteReader in(bytes);
  const auto count = in.read<std::uint64_t>();
  if (!in.ok() || count > in.remaining() / kLeastRecordBytes)
    return fail(Errc::kCorrupt, "it is cut off, or no images.bin");
  std::vector<PosedCamera> images;
  images.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    in.skip(4);  // its number
    const auto camera_from_map = read_camera_from_map(in);
    const auto camera_id = in.read<std::uint32_t>();
    std::string name = read_name(in);
    const auto features = in.read<std::uint64_t>();
    if (!in.ok() || name.size() > kLongestName || features > in.remaining() / kFeatureBytes)
      return fail(Errc::kCorrupt,
                  "image " + std::to_string(i) + " of " + std::to_string(count) + " is cut off");
    in.skip(static_cast<std::size_t>(features * kFeatureBytes));
    EDGESPLAT_TRY(PosedCamera posed, to_posed(camera_from_map, camera_id, std::move(name), cameras));
    images.push_back(std::move(posed));
  }
  return images;
}

bool is_integer(std::string_view word) {
  colmap::WordReader in(word);
  (void)in.read<std::int64_t>();
  return in.ok();
}

/// X Y POINT3D_ID for each feature, or nothing. Else it is an image's own line, which must not be lost.
bool is_features(std::string_view line) {
  colmap::WordReader in(line);
  std::size_t words = 0;
  std::string_view last;
  for (; !in.rest().empty(); ++words) last = in.word();
  return words == 0 || (words % 3 == 0 && is_integer(last));
}

Result<std::vector<PosedCamera>> parse_text_images(std::string_view text, const ColmapCameras& cameras) {
  std::vector<PosedCamera> images;
  colmap::LineReader lines(text);
  while (const auto line = lines.next()) {
    colmap::WordReader in(*line);
    (void)in.read<std::uint32_t>();  // its number
    const auto camera_from_map = read_camera_from_map(in);
    const auto camera_id = in.read<std::uint32_t>();
    if (!in.ok() || in.rest().size() > kLongestName) {
      return fail(Errc::kCorrupt, "line " + std::to_string(lines.number()) +
                                      " is not IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
    }
    EDGESPLAT_TRY(PosedCamera posed, to_posed(camera_from_map, camera_id, std::string(in.rest()), cameras));
    images.push_back(std::move(posed));
    const auto features = lines.any();
    if (features && !is_features(*features)) {
      return fail(Errc::kCorrupt, "line " + std::to_string(lines.number()) +
                                      " is not X Y POINT3D_ID ...: after each image comes a line with its "
                                      "features, or an empty one");
    }
  }
  return images;
}

void add_point(const std::array<double, 3>& p_m, const std::array<std::uint8_t, 3>& rgb, PointCloud& cloud) {
  const Eigen::Vector3f point = Eigen::Vector3d(p_m[0], p_m[1], p_m[2]).cast<float>();
  if (!point.allFinite()) return;
  cloud.points_m.push_back(point);
  cloud.rgb.push_back(rgb);
}

Result<PointCloud> parse_binary_points(std::span<const std::byte> bytes) {
  constexpr std::size_t kLeastRecordBytes = 8 + 3 * 8 + 3 + 8 + 8;
  constexpr std::uint64_t kTrackBytes = 8;
  ByteReader in(bytes);
  const auto count = in.read<std::uint64_t>();
  if (!in.ok() || count > in.remaining() / kLeastRecordBytes)
    return fail(Errc::kCorrupt, "it is cut off, or no points3D.bin");
  PointCloud cloud;
  cloud.points_m.reserve(count);
  cloud.rgb.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    in.skip(8);  // its number
    std::array<double, 3> p_m{};
    for (double& value : p_m) value = in.read<double>();
    std::array<std::uint8_t, 3> rgb{};
    for (std::uint8_t& value : rgb) value = in.read<std::uint8_t>();
    in.skip(8);  // its error
    const auto views = in.read<std::uint64_t>();
    if (!in.ok() || views > in.remaining() / kTrackBytes)
      return fail(Errc::kCorrupt,
                  "point " + std::to_string(i) + " of " + std::to_string(count) + " is cut off");
    in.skip(static_cast<std::size_t>(views * kTrackBytes));
    add_point(p_m, rgb, cloud);
  }
  return cloud;
}

Result<PointCloud> parse_text_points(std::string_view text) {
  PointCloud cloud;
  colmap::LineReader lines(text);
  while (const auto line = lines.next()) {
    colmap::WordReader in(*line);
    (void)in.read<std::uint64_t>();  // its number
    std::array<double, 3> p_m{};
    for (double& value : p_m) value = in.read<double>();
    std::array<std::uint8_t, 3> rgb{};
    for (std::uint8_t& value : rgb) value = in.read<std::uint8_t>();
    if (!in.ok()) {
      return fail(Errc::kCorrupt,
                  "line " + std::to_string(lines.number()) + " is not POINT3D_ID X Y Z R G B ERROR ...");
    }
    add_point(p_m, rgb, cloud);
  }
  return cloud;
}

}  // namespace

Result<std::vector<PosedCamera>> parse_colmap_images(std::span<const std::byte> bytes, ColmapForm form,
                                                     const ColmapCameras& cameras) {
  EDGESPLAT_TRY(auto images, form == ColmapForm::kBinary
                                 ? parse_binary_images(bytes, cameras)
                                 : parse_text_images(colmap::as_text(bytes), cameras));
  std::ranges::sort(images, {}, &PosedCamera::image);
  return images;
}

Result<PointCloud> parse_colmap_points(std::span<const std::byte> bytes, ColmapForm form) {
  return form == ColmapForm::kBinary ? parse_binary_points(bytes) : parse_text_points(colmap::as_text(bytes));
}

}  // namespace edgesplat::io
