// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/scene.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/camera_set.hpp"
#include "common/io/image_file.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/image/undistort.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace edgesplat::desk {
namespace {

constexpr std::uint64_t kMaxDepthFileBytes = std::uint64_t{256} << 20U;

/// Frames mostly share one camera: where to look is worked out once for it.
using Undistorters = std::vector<std::pair<geometry::CameraModel, std::shared_ptr<const image::Undistorter>>>;

bool same(const geometry::CameraModel& a, const geometry::CameraModel& b) {
  return a.kind == b.kind && a.width_px == b.width_px && a.height_px == b.height_px && a.fx_px == b.fx_px &&
         a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px && a.distortion == b.distortion;
}

const std::shared_ptr<const image::Undistorter>& undistorter_of(const geometry::CameraModel& camera,
                                                                Undistorters& known) {
  for (const auto& [model, undistorter] : known) {
    if (same(model, camera)) return undistorter;
  }
  known.emplace_back(camera, std::make_shared<image::Undistorter>(camera));
  return known.back().second;
}

double shrink_factor(const geometry::CameraModel& camera, const SceneOptions& options) {
  if (options.downscale > 0.0) return 1.0 / options.downscale;
  return std::min(1.0,
                  static_cast<double>(options.max_side_px) / std::max(camera.width_px, camera.height_px));
}

sensor::ImageRgb8 shrink(const sensor::ImageRgb8& picture, int width_px, int height_px) {
  if (picture.width_px == width_px && picture.height_px == height_px) return picture;
  sensor::ImageRgb8 out(width_px, height_px);
  const cv::Mat from(picture.height_px, picture.width_px, CV_8UC3,
                     const_cast<std::uint8_t*>(picture.values.data()));
  cv::Mat to(height_px, width_px, CV_8UC3, out.values.data());
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
  return out;
}

/// A pixel counts where all that it was made of was seen.
std::vector<float> shrink_seen(const image::Undistorter& undistorter, int width_px, int height_px) {
  const auto seen = undistorter.seen();
  if (seen.empty() || std::ranges::all_of(seen, [](float value) { return value > 0.0F; })) return {};
  std::vector<float> out(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  const cv::Mat from(undistorter.model().height_px, undistorter.model().width_px, CV_32FC1,
                     const_cast<float*>(seen.data()));
  cv::Mat to(height_px, width_px, CV_32FC1, out.data());
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
  for (float& value : out) value = value > 0.999F ? 1.0F : 0.0F;
  return out;
}

struct Frame {
  std::filesystem::path file;
  std::filesystem::path depth;  ///< empty: none
  const io::PosedCamera* posed = nullptr;
  std::shared_ptr<const image::Undistorter> undistorter;
};

/// What the depth picture of a camera with distortion has at the pixels of the pinhole `camera`: the nearest
/// pixel's, since a mean of near and far is neither.
Result<std::vector<float>> read_depth(const std::filesystem::path& file,
                                      const geometry::CameraModel& distorted,
                                      const geometry::CameraModel& camera) {
  EDGESPLAT_TRY(const auto bytes, io::read_file(file, kMaxDepthFileBytes));
  auto depth_mm = io::decode_gray16(bytes);
  if (!depth_mm) return fail(Errc::kCorrupt, file.string() + ": " + depth_mm.error().context);
  if (depth_mm->width_px != distorted.width_px || depth_mm->height_px != distorted.height_px) {
    return fail(Errc::kCorrupt, file.string() + " does not have the size of its picture");
  }
  std::vector<float> depth_m;
  depth_m.reserve(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const auto at = distorted.project(camera.unproject(Eigen::Vector2d(x, y)));
      const bool inside = at && distorted.contains(*at);
      depth_m.push_back(
          inside ? 1e-3F * static_cast<float>(*depth_mm->pixel(static_cast<int>(std::lround(at->x())),
                                                               static_cast<int>(std::lround(at->y()))))
                 : 0.0F);
    }
  }
  return depth_m;
}

Result<ScenePicture> read_picture(const Frame& frame, const SceneOptions& options) {
  const io::PosedCamera& posed = *frame.posed;
  const image::Undistorter& undistorter = *frame.undistorter;
  EDGESPLAT_TRY(const auto picture, io::load_rgb8(frame.file));
  if (picture.width_px != posed.camera.width_px || picture.height_px != posed.camera.height_px) {
    return fail(Errc::kCorrupt, frame.file.string() + " is " + std::to_string(picture.width_px) + "x" +
                                    std::to_string(picture.height_px) + ", its camera " +
                                    std::to_string(posed.camera.width_px) + "x" +
                                    std::to_string(posed.camera.height_px));
  }
  ScenePicture out;
  out.name = posed.name;
  out.map_from_camera = posed.map_from_camera;
  out.camera = undistorter.model().scaled(shrink_factor(undistorter.model(), options));
  out.picture = shrink(undistorter.apply(picture), out.camera.width_px, out.camera.height_px);
  out.weight = shrink_seen(undistorter, out.camera.width_px, out.camera.height_px);
  if (!frame.depth.empty()) {
    EDGESPLAT_TRY(out.depth_m, read_depth(frame.depth, posed.camera, out.camera));
  }
  return out;
}

Status read_pictures(const std::vector<Frame>& frames, const SceneOptions& options, Scene& scene) {
  std::vector<Result<ScenePicture>> pictures(frames.size());
  thread::parallel_for(std::size_t{0}, frames.size(),
                       [&](std::size_t i) { pictures[i] = read_picture(frames[i], options); });
  for (auto& picture : pictures) {
    if (!picture) return tl::unexpected(picture.error());
    scene.pictures.push_back(*std::move(picture));
  }
  return {};
}

}  // namespace

Result<Scene> read_scene(const std::filesystem::path& folder, const SceneOptions& options) {
  std::error_code error;
  const auto file = std::filesystem::is_directory(folder, error) ? folder / "transforms.json" : folder;
  EDGESPLAT_TRY(const io::CameraSet cameras, io::read_camera_set(file));
  Scene scene;
  Undistorters undistorters;
  std::vector<Frame> frames;
  for (const io::PosedCamera& posed : cameras.cameras) {
    const auto image = io::image_path(file, posed);
    if (posed.image.empty() || !std::filesystem::exists(image, error)) {
      ++scene.images_missing;
      continue;
    }
    auto depth = posed.depth.empty() ? posed.depth : file.parent_path() / posed.depth;
    if (!depth.empty() && !std::filesystem::exists(depth, error)) depth.clear();
    frames.push_back({image, std::move(depth), &posed, undistorter_of(posed.camera, undistorters)});
  }
  if (frames.empty()) {
    return fail(Errc::kNotFound, "none of the " + std::to_string(cameras.cameras.size()) + " images that " +
                                     file.string() + " names is there");
  }
  EDGESPLAT_TRY_STATUS(read_pictures(frames, options, scene));
  if (!cameras.points.empty()) {
    EDGESPLAT_TRY(scene.points, io::read_points_ply(file.parent_path() / cameras.points));
  }
  return scene;
}

double camera_extent(std::span<const ScenePicture* const> pictures) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const ScenePicture* picture : pictures) centre += picture->map_from_camera.translation_m;
  centre /= static_cast<double>(std::max(std::size_t{1}, pictures.size()));
  double radius = 0.0;
  for (const ScenePicture* picture : pictures) {
    radius = std::max(radius, (picture->map_from_camera.translation_m - centre).norm());
  }
  return std::max(1e-6, 1.1 * radius);
}

}  // namespace edgesplat::desk
