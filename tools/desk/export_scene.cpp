// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/export_scene.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/image_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/ply_points.hpp"
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"
#include "common/sensor/rig_config.hpp"
#include "robot/keyframe/exposure.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace edgesplat::desk {
namespace {

/// Clocks are disciplined: a device's stamp is host time.
using PosesByTime = std::map<std::int64_t, geometry::RigidTransform>;  // ns, world_from_body

struct Contents {
  sensor::CameraMount camera;
  PosesByTime poses;
  std::vector<std::int64_t> stamps_ns;        ///< of the clean pictures
  std::map<std::int64_t, float> exposures_s;  ///< by stamp
};

Result<sensor::CameraMount> camera_of(const io::McapReader& reader) {
  EDGESPLAT_TRY(const auto attachment, reader.attachment(io::kRigAttachment));
  const std::string text(reinterpret_cast<const char*>(attachment.content.data()), attachment.content.size());
  EDGESPLAT_TRY(const sensor::Rig rig, sensor::parse_rig(text, "rig.toml"));
  if (!rig.camera) return fail(Errc::kNotFound, "the robot of this recording has no camera");
  return *rig.camera;
}

Result<Contents> read_contents(const std::filesystem::path& recording) {
  EDGESPLAT_TRY(io::McapReader reader, io::McapReader::open(recording));
  Contents contents;
  EDGESPLAT_TRY(contents.camera, camera_of(reader));
  reader.select({{std::string(io::kTruthBodyPoseTopic), std::string(io::kTruthCameraCleanTopic),
                  std::string(io::kCameraMetaTopic)}});
  while (const auto message = reader.next()) {
    if (message->channel->topic == io::kTruthBodyPoseTopic) {
      EDGESPLAT_TRY(const auto pose, io::decode_pose_stamped(message->payload));
      contents.poses[to_ns(pose.stamp)] = pose.frame_from_body;
    } else if (message->channel->topic == io::kCameraMetaTopic) {
      EDGESPLAT_TRY(const auto meta, io::decode_frame_meta(message->payload));
      if (meta.stamp_source == sensor::StampSource::kFreeRunning) {
        return fail(Errc::kInvalidArgument, "the camera of " + recording.string() +
                                                " has a free clock, so its pictures have no known pose: "
                                                "simulate with --clock ptp");
      }
      contents.exposures_s[to_ns(meta.stamp)] = meta.exposure_s;
    } else {
      EDGESPLAT_TRY(const auto picture, io::decode_compressed_image(message->payload));
      contents.stamps_ns.push_back(to_ns(picture.stamp));
    }
  }
  if (contents.stamps_ns.empty() || contents.poses.empty()) {
    return fail(Errc::kNotFound, recording.string() + " was not simulated with a camera: it has " +
                                     std::to_string(contents.stamps_ns.size()) + " clean pictures and " +
                                     std::to_string(contents.poses.size()) + " true poses");
  }
  return contents;
}

/// Nothing outside the time of the poses.
std::optional<geometry::RigidTransform> pose_at(const PosesByTime& poses, std::int64_t time_ns) {
  const auto after = poses.lower_bound(time_ns);
  if (after == poses.end()) return std::nullopt;
  if (after->first == time_ns) return after->second;
  if (after == poses.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double share =
      static_cast<double>(time_ns - before->first) / static_cast<double>(after->first - before->first);
  return geometry::interpolate(before->second, after->second, share);
}

/// Pictures with a pose, evenly chosen: stamp and world_from_camera.
std::map<std::int64_t, geometry::RigidTransform> choose_pictures(const Contents& contents, std::size_t most) {
  const std::int64_t delay_ns = from_seconds(contents.camera.stamp_delay_s).count();
  std::vector<std::pair<std::int64_t, geometry::RigidTransform>> posed;
  for (const std::int64_t stamp_ns : contents.stamps_ns) {
    const auto world_from_body = pose_at(contents.poses, stamp_ns + delay_ns);
    if (world_from_body) posed.emplace_back(stamp_ns, *world_from_body * contents.camera.body_from_camera);
  }
  std::map<std::int64_t, geometry::RigidTransform> chosen;
  const std::size_t count = std::min(most, posed.size());
  for (std::size_t i = 0; i < count; ++i) chosen.insert(posed[i * posed.size() / count]);
  return chosen;
}

/// Writes the chosen pictures as they come, and takes points of them.
class SceneWriter {
 public:
  SceneWriter(const SceneExport& options, const Contents& contents,
              std::map<std::int64_t, geometry::RigidTransform> chosen)
      : options_(options), contents_(contents), chosen_(std::move(chosen)), random_(options.seed) {}

  Status make_folders() const {
    for (const char* name : {"images", "depth"}) {
      std::error_code error;
      std::filesystem::create_directories(options_.folder / name, error);
      if (error) {
        return fail(Errc::kIo,
                    "cannot make the folder " + (options_.folder / name).string() + ": " + error.message());
      }
    }
    return {};
  }

  /// A clean or depth picture of the recording; one comes after the other.
  Status take(std::string_view topic, const io::CompressedImage& message) {
    const auto chosen = chosen_.find(to_ns(message.stamp));
    if (chosen == chosen_.end()) return {};
    if (topic == io::kTruthCameraCleanTopic) {
      EDGESPLAT_TRY(const auto clean, io::decode_rgb8(message.encoded));
      const auto exposure_s = contents_.exposures_s.find(chosen->first);
      picture_ =
          equaliser_.equalise(clean, exposure_s == contents_.exposures_s.end() ? 0.0F : exposure_s->second);
      picture_stamp_ns_ = chosen->first;
      return {};
    }
    EDGESPLAT_TRY(const auto depth, io::decode_gray16(message.encoded));
    if (picture_stamp_ns_ != chosen->first || picture_.width_px != depth.width_px ||
        picture_.height_px != depth.height_px || depth.width_px != contents_.camera.model.width_px ||
        depth.height_px != contents_.camera.model.height_px) {
      return fail(Errc::kCorrupt,
                  "a clean picture of the recording has no depth picture of the camera's size");
    }
    return write(chosen->second, depth);
  }

  Result<SceneExportReport> finish() {
    if (frames_.empty()) return fail(Errc::kNotFound, "no clean picture with a depth picture and a pose");
    EDGESPLAT_TRY_STATUS(io::write_points_ply(options_.folder / "points.ply", points_));
    const geometry::CameraModel& c = contents_.camera.model;
    const bool fisheye = c.kind == geometry::CameraKind::kFisheye;
    nlohmann::json file = {{"camera_model", fisheye ? "OPENCV_FISHEYE" : "OPENCV"},
                           {"w", c.width_px},
                           {"h", c.height_px},
                           {"fl_x", c.fx_px},
                           {"fl_y", c.fy_px},
                           {"cx", c.cx_px + 0.5},  // pixel centres at 0 -> at 0.5
                           {"cy", c.cy_px + 0.5},
                           {"k1", c.distortion[0]},
                           {"k2", c.distortion[1]},
                           {fisheye ? "k3" : "p1", c.distortion[2]},
                           {fisheye ? "k4" : "p2", c.distortion[3]},
                           {"ply_file_path", "points.ply"},
                           {"frames", frames_}};
    if (!fisheye) file["k3"] = c.k3;
    EDGESPLAT_TRY_STATUS(io::write_file_atomically(options_.folder / "transforms.json", file.dump(1) + "\n"));
    return SceneExportReport{frames_.size(), points_.points_m.size()};
  }

 private:
  Status write(const geometry::RigidTransform& world_from_camera, const sensor::ImageGray16& depth) {
    const std::string name = fmt::format("{:06}.png", frames_.size());
    EDGESPLAT_TRY_STATUS(io::save_image(options_.folder / "images" / name, picture_));
    EDGESPLAT_TRY_STATUS(io::save_image(options_.folder / "depth" / name, depth));
    Eigen::Matrix<double, 3, 4> rows = world_from_camera.matrix();
    rows.middleCols<2>(1) *= -1.0;  // OpenGL's camera has y up and looks along -z
    nlohmann::json matrix = nlohmann::json::array();
    for (int r = 0; r < 3; ++r) matrix.push_back({rows(r, 0), rows(r, 1), rows(r, 2), rows(r, 3)});
    matrix.push_back({0.0, 0.0, 0.0, 1.0});
    frames_.push_back({{"file_path", "images/" + name},
                       {"depth_file_path", "depth/" + name},
                       {"transform_matrix", matrix}});
    take_points(world_from_camera, depth);
    return {};
  }

  /// An equal share of every picture, drawn among all its pixels.
  void take_points(const geometry::RigidTransform& world_from_camera, const sensor::ImageGray16& depth) {
    const std::size_t share = options_.points * frames_.size() / chosen_.size() - points_.points_m.size();
    const auto width = static_cast<std::uint64_t>(depth.width_px);
    const std::uint64_t pixels = width * static_cast<std::uint64_t>(depth.height_px);
    for (std::size_t i = 0; i < share; ++i) {
      const std::uint64_t pixel = random_() % pixels;
      const std::uint16_t depth_mm = depth.values[pixel];
      if (depth_mm == 0) continue;
      const auto x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
      const Eigen::Vector3d ray = contents_.camera.model.unproject(Eigen::Vector2d(x, y));
      if (ray.z() <= 0.0) continue;
      const Eigen::Vector3d p_in_camera_m = ray * (1e-3 * depth_mm / ray.z());
      points_.points_m.emplace_back((world_from_camera * p_in_camera_m).cast<float>());
      const std::uint8_t* rgb = picture_.pixel(x, y);
      points_.rgb.push_back({rgb[0], rgb[1], rgb[2]});
    }
  }

  const SceneExport& options_;
  const Contents& contents_;
  std::map<std::int64_t, geometry::RigidTransform> chosen_;
  std::mt19937_64 random_;
  keyframe::ExposureEqualiser equaliser_;
  sensor::ImageRgb8 picture_;
  std::int64_t picture_stamp_ns_ = -1;
  nlohmann::json frames_ = nlohmann::json::array();
  io::PointCloud points_;
};

}  // namespace

Result<SceneExportReport> export_scene(const SceneExport& options) {
  if (options.pictures == 0) return fail(Errc::kInvalidArgument, "a scene needs a picture at least");
  EDGESPLAT_TRY(const Contents contents, read_contents(options.recording));
  SceneWriter writer(options, contents, choose_pictures(contents, options.pictures));
  EDGESPLAT_TRY_STATUS(writer.make_folders());
  EDGESPLAT_TRY(io::McapReader reader, io::McapReader::open(options.recording));
  reader.select({{std::string(io::kTruthCameraCleanTopic), std::string(io::kTruthCameraDepthTopic)}});
  while (const auto message = reader.next()) {
    EDGESPLAT_TRY(const auto picture, io::decode_compressed_image(message->payload));
    EDGESPLAT_TRY_STATUS(writer.take(message->channel->topic, picture));
  }
  return writer.finish();
}

}  // namespace edgesplat::desk
