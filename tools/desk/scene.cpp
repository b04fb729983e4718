// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/scene.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/colmap_model.hpp"
#include "common/io/image_file.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/image/undistort.hpp"
#include "tools/desk/scene_files.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

namespace edgesplat::desk {
namespace {

constexpr std::uint64_t kMaxDepthFileBytes = std::uint64_t{256} << 20U;
constexpr double kMaxDepthStretch = 0.05;  ///< of a depth picture's sides against its picture's

/// Where to look for a camera's pixels: worked out when its first picture is read and kept until the last.
/// Frames mostly share a few cameras, but in COLMAP's scenes each may have its own. Thread-safe.
class CameraUse {
 public:
  explicit CameraUse(const geometry::CameraModel& camera) : camera_(camera) {}
  [[nodiscard]] const geometry::CameraModel& camera() const { return camera_; }
  void expect_one_more() { ++pictures_left_; }
  /// To be called once for each picture.
  std::shared_ptr<const image::Undistorter> take() {
    const std::lock_guard lock(mutex_);
    if (!undistorter_) undistorter_ = std::make_shared<image::Undistorter>(camera_);
    auto taken = undistorter_;
    if (--pictures_left_ == 0) undistorter_.reset();
    return taken;
  }

 private:
  const geometry::CameraModel camera_;
  std::mutex mutex_;
  std::size_t pictures_left_ = 0;
  std::shared_ptr<const image::Undistorter> undistorter_;
};

CameraUse& use_of(const geometry::CameraModel& camera, std::deque<CameraUse>& uses) {
  auto found = std::ranges::find(uses, camera, &CameraUse::camera);
  CameraUse& use = found == uses.end() ? uses.emplace_back(camera) : *found;
  use.expect_one_more();
  return use;
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
  CameraUse* use = nullptr;
};

/// What the depth picture of a camera with distortion has at the pixels of the pinhole `camera`: the nearest
/// pixel's, since a mean of near and far is neither. Scanners have smaller depth pictures than photos.
Result<std::vector<float>> read_depth(const Frame& frame, const geometry::CameraModel& camera, float unit_m) {
  const auto refused = [&frame](const std::string& why) {
    return fail(Errc::kCorrupt, frame.depth.string() + ": " + why);
  };
  EDGESPLAT_TRY(const auto bytes, io::read_file(frame.depth, kMaxDepthFileBytes));
  auto depth = io::decode_gray16(bytes);
  if (!depth) return refused("depth pictures are PNGs of 16 bits: " + depth.error().context);
  const geometry::CameraModel& full = frame.posed->camera;
  const double of_width = static_cast<double>(depth->width_px) / full.width_px;
  const double of_height = static_cast<double>(depth->height_px) / full.height_px;
  if (std::abs(of_width - of_height) > kMaxDepthStretch * of_width)
    return refused("it does not have its picture's proportions");
  const geometry::CameraModel distorted = full.scaled_to(depth->width_px, depth->height_px);
  std::vector<float> depth_m;
  depth_m.reserve(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const auto at = distorted.project(camera.unproject(Eigen::Vector2d(x, y)));
      const bool inside = at && distorted.contains(*at);
      depth_m.push_back(inside ? unit_m *
                                     static_cast<float>(*depth->pixel(static_cast<int>(std::lround(at->x())),
                                                                      static_cast<int>(std::lround(at->y()))))
                               : 0.0F);
    }
  }
  return depth_m;
}

Result<ScenePicture> read_picture(const Frame& frame, const SceneOptions& options) {
  const io::PosedCamera& posed = *frame.posed;
  const auto taken = frame.use->take();
  const image::Undistorter& undistorter = *taken;
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
    EDGESPLAT_TRY(out.depth_m, read_depth(frame, out.camera, static_cast<float>(options.depth_unit_m)));
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
  EDGESPLAT_TRY(const SceneFiles files, find_scene_files(folder, options.images));
  const auto& [cameras, file] = files;
  Scene scene;
  std::deque<CameraUse> uses;
  std::vector<Frame> frames;
  for (const io::PosedCamera& posed : cameras.cameras) {
    const auto image = io::image_path(file, posed);
    if (posed.image.empty() || !std::filesystem::exists(image, error)) {
      ++scene.images_missing;
      continue;
    }
    const bool has_depth = options.depth && !posed.depth.empty();
    auto depth = has_depth ? file.parent_path() / posed.depth : std::filesystem::path();
    if (has_depth && !std::filesystem::exists(depth, error)) depth.clear();
    frames.push_back({image, std::move(depth), &posed, &use_of(posed.camera, uses)});
  }
  if (frames.empty()) {
    return fail(Errc::kNotFound, "none of the " + std::to_string(cameras.cameras.size()) +
                                     " images that the scene " + folder.string() +
                                     " names is there, such as " +
                                     io::image_path(file, cameras.cameras.front()).string());
  }
  EDGESPLAT_TRY_STATUS(read_pictures(frames, options, scene));
  if (!cameras.points.empty()) {
    EDGESPLAT_TRY(scene.points, io::read_points(file.parent_path() / cameras.points));
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
