// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/repose.hpp"

#include <cmath>

namespace edgesplat::map {
namespace {

using Quat = std::array<double, 4>;
using Vec3 = std::array<double, 3>;

Quat product(const Quat& a, const Quat& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

Quat normalised(Quat q) {
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (double& v : q) v /= norm;
  return q;
}

std::array<double, 9> matrix(const Quat& q) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
}

Vec3 rotated(const std::array<double, 9>& r, const Vec3& v) {
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
          r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}

Quat quat_of(const geometry::RigidTransform& pose) {
  const auto& q = pose.rotation;
  return normalised({q.x(), q.y(), q.z(), q.w()});
}

Vec3 translation_of(const geometry::RigidTransform& pose) {
  return {pose.translation_m.x(), pose.translation_m.y(), pose.translation_m.z()};
}

bool in_map(const Vec3& p_m) {
  const auto limit_m = static_cast<double>(kMapLimit_m);
  return std::abs(p_m[0]) <= limit_m && std::abs(p_m[1]) <= limit_m && std::abs(p_m[2]) <= limit_m;
}

Eigen::Vector3f as_point(const Vec3& p_m) {
  return {static_cast<float>(p_m[0]), static_cast<float>(p_m[1]), static_cast<float>(p_m[2])};
}

/// Turns what `sh` holds above degree 0, [(degree+1)^2-1,3].
template <typename T, typename Round>
void turn_colours(const gaussian::ShRotation& rotation, int degree, T* sh, Round&& round) {
  const auto count = static_cast<std::size_t>((degree + 1) * (degree + 1) - 1);
  for (std::size_t colour = 0; count > 0 && colour < 3; ++colour) {
    gaussian::ShRotation::Coefficients values{};
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<double>(sh[3 * i + colour]);
    values = rotation.turned(degree, values);
    for (std::size_t i = 0; i < count; ++i) sh[3 * i + colour] = round(values[i]);
  }
}

}  // namespace

Repose::Repose(std::span<const PoseCorrection> corrections) {
  for (const PoseCorrection& correction : corrections) {
    const Quat old = quat_of(correction.old_map_from_body);
    const Quat turn =
        normalised(product(quat_of(correction.new_map_from_body), {-old[0], -old[1], -old[2], old[3]}));
    const auto rotation = matrix(turn);
    const Vec3 turned = rotated(rotation, translation_of(correction.old_map_from_body));
    Vec3 translation_m = translation_of(correction.new_map_from_body);
    for (std::size_t k = 0; k < 3; ++k) translation_m[k] -= turned[k];
    motions_.insert_or_assign(correction.keyframe, Motion{correction.version, turn, rotation, translation_m,
                                                          gaussian::ShRotation(rotation)});
  }
}

DecodedPose Repose::Motion::operator*(const DecodedPose& pose) const {
  DecodedPose moved{};
  const Vec3 turned = rotated(rotation, pose.mean_m);
  for (std::size_t k = 0; k < 3; ++k) moved.mean_m[k] = turned[k] + translation_m[k];
  moved.quat_xyzw = product(quat_xyzw, pose.quat_xyzw);
  return moved;
}

const Repose::Motion* Repose::motion_of(const gaussian::Anchor& anchor) const {
  const auto found = motions_.find(anchor.keyframe);
  return found != motions_.end() && anchor.pose_version < found->second.version ? &found->second : nullptr;
}

bool Repose::move(QuantisedRows& rows, std::size_t row) const {
  gaussian::Anchor& anchor = rows.anchors[row];
  const Motion* motion = motion_of(anchor);
  if (motion == nullptr) return false;
  ChunkId& chunk = rows.chunks[row];
  Channels& channels = rows.channels[row];
  const DecodedPose moved = *motion * decode_pose(chunk, channels);
  anchor.pose_version = motion->version;
  if (!in_map(moved.mean_m)) return true;  // a correction out of this world: it stays where it was
  chunk = chunk_after_move(chunk, as_point(moved.mean_m));
  encode_pose(chunk, moved, channels);
  std::int8_t* sh = rows.sh_rest.data() + rows.sh_rest_each() * row;
  turn_colours(motion->sh, rows.sh_degree, sh, [](double steps) { return round_sh(steps); });
  return true;
}

bool Repose::move(gaussian::GaussianCloud& cloud, std::size_t row) const {
  const Motion* motion = motion_of(cloud.anchors[row]);
  if (motion == nullptr) return false;
  float* mean_m = cloud.means_m.data() + 3 * row;
  float* quat = cloud.quats_xyzw.data() + 4 * row;
  const DecodedPose moved =
      *motion * DecodedPose{{mean_m[0], mean_m[1], mean_m[2]}, {quat[0], quat[1], quat[2], quat[3]}};
  cloud.anchors[row].pose_version = motion->version;
  if (!in_map(moved.mean_m)) return true;
  for (std::size_t k = 0; k < 3; ++k) mean_m[k] = static_cast<float>(moved.mean_m[k]);
  for (std::size_t k = 0; k < 4; ++k) quat[k] = static_cast<float>(moved.quat_xyzw[k]);
  float* sh_rest = cloud.sh.data() + cloud.sh_floats_each() * row + 3;
  turn_colours(motion->sh, cloud.sh_degree, sh_rest, [](double value) { return static_cast<float>(value); });
  return true;
}

}  // namespace edgesplat::map
