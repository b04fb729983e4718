// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/held_out_views.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace edgesplat::quality {
namespace {

constexpr nanoseconds kSameMoment = from_seconds(0.002);

/// A turn of one radian changes a picture about as much as this many metres.
constexpr double kMetresPerRadian = 3.0;

std::optional<std::size_t> pair_at(std::span<const accuracy::PosePair> truth, HostTime stamp) {
  const auto after = std::lower_bound(truth.begin(), truth.end(), stamp - kSameMoment,
                                      [](const accuracy::PosePair& p, HostTime t) { return p.stamp < t; });
  if (after == truth.end() || after->stamp > stamp + kSameMoment) return std::nullopt;
  return static_cast<std::size_t>(after - truth.begin());
}

/// `most` of `count` numbers, each in the middle of its share.
std::vector<std::size_t> evenly_spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen(std::min(most, count));
  for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = (2 * i + 1) * count / (2 * chosen.size());
  return chosen;
}

}  // namespace

std::size_t most_alike(std::span<const SavedKeyframe> keyframes,
                       const geometry::RigidTransform& map_from_camera) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const auto& pose = keyframes[k].map_from_camera;
    const double difference = (pose.translation_m - map_from_camera.translation_m).norm() +
                              kMetresPerRadian * pose.rotation.angularDistance(map_from_camera.rotation);
    if (difference < least) {
      least = difference;
      best = k;
    }
  }
  return best;
}

Result<geometry::RigidTransform> align_map(std::span<const SavedKeyframe> keyframes,
                                           std::span<const accuracy::PosePair> truth,
                                           const geometry::RigidTransform& body_from_camera) {
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  Eigen::Vector3d in_map = Eigen::Vector3d::Zero();
  Eigen::Vector3d in_world = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const SavedKeyframe& keyframe : keyframes) {
    const auto row = pair_at(truth, keyframe.stamp);
    if (!row) continue;
    const geometry::RigidTransform world_from_camera = truth[*row].reference * body_from_camera;
    rotations +=
        (keyframe.map_from_camera.rotation * world_from_camera.rotation.conjugate()).toRotationMatrix();
    in_map += keyframe.map_from_camera.translation_m;
    in_world += world_from_camera.translation_m;
    count += 1.0;
  }
  if (count == 0.0) return fail(Errc::kNotFound, "no keyframe has a true pose: nothing to align the map by");
  Eigen::Matrix<double, 3, 4> mean;
  mean << rotations / count, Eigen::Vector3d::Zero();
  geometry::RigidTransform map_from_world = geometry::RigidTransform::from_matrix(mean);
  map_from_world.translation_m = (in_map - map_from_world.rotation * in_world) / count;
  return map_from_world;
}

Result<std::vector<HeldOutView>> choose_held_out_views(std::span<const SavedKeyframe> keyframes,
                                                       std::span<const accuracy::PosePair> truth,
                                                       const geometry::RigidTransform& body_from_camera,
                                                       std::size_t most) {
  EDGESPLAT_TRY(const geometry::RigidTransform map_from_world, align_map(keyframes, truth, body_from_camera));
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k + 1 < keyframes.size(); ++k) {
    const HostTime middle = keyframes[k].stamp + (keyframes[k + 1].stamp - keyframes[k].stamp) / 2;
    std::optional<std::size_t> best;
    for (std::size_t row = 0; row < truth.size(); ++row) {
      const HostTime stamp = truth[row].stamp;
      if (stamp < keyframes[k].stamp + kSameMoment || stamp > keyframes[k + 1].stamp - kSameMoment) continue;
      const auto off = [&](std::size_t r) { return std::chrono::abs(truth[r].stamp - middle); };
      if (!best || off(row) < off(*best)) best = row;
    }
    if (best) rows.push_back(*best);
  }
  if (rows.empty()) return fail(Errc::kNotFound, "no true pose lies between two keyframes");
  std::vector<HeldOutView> views;
  for (const std::size_t i : evenly_spread(rows.size(), most)) {
    const accuracy::PosePair& pair = truth[rows[i]];
    HeldOutView view;
    view.stamp = pair.stamp;
    view.world_from_camera = pair.reference * body_from_camera;
    view.map_from_camera = map_from_world * view.world_from_camera;
    view.nearest_keyframe = most_alike(keyframes, view.map_from_camera);
    views.push_back(view);
  }
  return views;
}

Result<std::vector<HeldOutView>> views_of_pictures(std::span<const SavedKeyframe> keyframes,
                                                   std::span<const SavedKeyframe> held_out,
                                                   std::size_t most) {
  std::vector<HeldOutView> views;
  for (const std::size_t i : evenly_spread(held_out.size(), most)) {
    const SavedKeyframe& picture = held_out[i];
    HeldOutView view;
    view.stamp = picture.stamp;
    view.map_from_camera = picture.map_from_camera;
    view.nearest_keyframe = most_alike(keyframes, view.map_from_camera);
    view.picture = picture.image;
    view.block = picture.block;
    views.push_back(std::move(view));
  }
  for (const SavedKeyframe& keyframe : keyframes) {
    for (const HeldOutView& view : views) {
      if (std::chrono::abs(keyframe.stamp - view.stamp) > kSameMoment) continue;
      return fail(Errc::kCorrupt, view.picture.string() + " was not held out: " + keyframe.image.string() +
                                      " is of the same moment");
    }
  }
  return views;
}

}  // namespace edgesplat::quality
