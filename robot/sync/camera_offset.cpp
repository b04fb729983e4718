// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/camera_offset.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace edgesplat::sync {
namespace {

constexpr int kCell_px = 32;  // one patch in each cell of the small picture
constexpr double kNearest_m = 0.5;
constexpr double kMostOff_px = 3.0;  // further off: something that moves by itself
constexpr double kProbe_s = 0.01;    // for the derivative by the delay
constexpr auto kMaxGap = std::chrono::milliseconds(350);
constexpr auto kJudgementPeriod = std::chrono::seconds(2);
constexpr double kSigmas = 3.0;
constexpr int kOverInARow = 2;

}  // namespace

std::optional<Eigen::Vector2d> CameraOffset::small_pixel(const Eigen::Vector3d& p_in_camera_m,
                                                         double scale) const {
  const auto pixel = mount_.model.project(p_in_camera_m);
  if (!pixel || !mount_.model.contains(*pixel)) return std::nullopt;
  return (*pixel + Eigen::Vector2d::Constant(0.5)) * scale - Eigen::Vector2d::Constant(0.5);
}

void CameraOffset::add(HostTime stamp, const geometry::RigidTransform& odom_from_body,
                       std::span<const Eigen::Vector3f> points_in_body_m, const sensor::ImageRgb8& picture) {
  if (!moments_.empty() && (stamp <= moments_.back().stamp || stamp - moments_.back().stamp > kMaxGap)) {
    moments_.clear();
    misses_.clear();
    newest_misses_.clear();
  }
  Moment moment{stamp, odom_from_body * mount_.body_from_camera, shrink(picture), {}};
  moment.points_in_camera_m = choose_points(moment, points_in_body_m);
  if (!moments_.empty()) {
    misses_ = std::exchange(newest_misses_, compare(moments_.back(), moment));
  }
  moments_.push_back(std::move(moment));
  if (moments_.size() > 4) moments_.pop_front();
  if (moments_.size() == 4) settle_pair();
  judge(stamp);
}

/// The nearest point of each cell of the picture: what lies behind it may be hidden.
std::vector<Eigen::Vector3d> CameraOffset::choose_points(
    const Moment& moment, std::span<const Eigen::Vector3f> points_in_body_m) const {
  const geometry::RigidTransform camera_from_body = mount_.body_from_camera.inverse();
  const int columns = moment.picture.grey.width_px / kCell_px + 1;
  const int rows = moment.picture.grey.height_px / kCell_px + 1;
  std::vector<std::optional<Eigen::Vector3d>> cells(static_cast<std::size_t>(columns * rows));
  for (const Eigen::Vector3f& p_in_body : points_in_body_m) {
    const Eigen::Vector3d p = camera_from_body * Eigen::Vector3d(p_in_body.cast<double>());
    if (p.z() < kNearest_m) continue;
    const auto pixel = small_pixel(p, moment.picture.scale);
    if (!pixel || pixel->minCoeff() < 0.0) continue;
    const int cell =
        static_cast<int>(pixel->y()) / kCell_px * columns + static_cast<int>(pixel->x()) / kCell_px;
    if (cell >= columns * rows) continue;
    auto& kept = cells[static_cast<std::size_t>(cell)];
    if (!kept || p.z() < kept->z()) kept = p;
  }
  std::vector<Eigen::Vector3d> chosen;
  for (const auto& cell : cells)
    if (cell) chosen.push_back(*cell);
  return chosen;
}

std::vector<CameraOffset::Miss> CameraOffset::compare(const Moment& before, const Moment& now) const {
  const geometry::RigidTransform now_from_before = now.odom_from_camera.inverse() * before.odom_from_camera;
  std::vector<Miss> misses;
  for (const Eigen::Vector3d& p : before.points_in_camera_m) {
    const auto at_px = small_pixel(p, before.picture.scale);
    const auto expected_px = small_pixel(now_from_before * p, now.picture.scale);
    if (!at_px || !expected_px) continue;
    const auto found_px = find_patch(before.picture, *at_px, now.picture, *expected_px);
    if (!found_px) continue;
    const Eigen::Vector2d off_px = *found_px - *expected_px;
    if (off_px.norm() <= kMostOff_px) misses.push_back({p, off_px});
  }
  return misses;
}

/// Between the second and the third of four pictures: with one more on either side the poses a moment earlier
/// and later are known.
void CameraOffset::settle_pair() {
  const auto pose_at = [this](std::size_t i, double shift_s) {
    const Moment& from = moments_[shift_s < 0 ? i - 1 : i];
    const Moment& to = moments_[shift_s < 0 ? i : i + 1];
    const double whole_s = to_seconds(to.stamp - from.stamp);
    const double t = shift_s < 0 ? 1.0 + shift_s / whole_s : shift_s / whole_s;
    return geometry::interpolate(from.odom_from_camera, to.odom_from_camera, t);
  };
  // Stamps that are late by d: the pictures were taken d earlier.
  const auto relative = [&](double late_s) { return pose_at(2, -late_s).inverse() * pose_at(1, -late_s); };
  const geometry::RigidTransform late = relative(kProbe_s), early = relative(-kProbe_s);
  const double scale = moments_[1].picture.scale;
  Pair pair{moments_[2].stamp, 0.0, 0.0};
  for (const Miss& miss : misses_) {
    const auto a = small_pixel(late * miss.p_in_camera_m, scale);
    const auto b = small_pixel(early * miss.p_in_camera_m, scale);
    if (!a || !b) continue;
    const Eigen::Vector2d slope = (*a - *b) / (2.0 * kProbe_s);
    pair.information += slope.squaredNorm();
    pair.pull += slope.dot(miss.off_px);
  }
  if (pair.information > 0.0) pairs_.push_back(pair);
}

std::optional<CameraOffset::Estimate> CameraOffset::estimate() const {
  if (static_cast<int>(pairs_.size()) < config_.least_pictures) return std::nullopt;
  double information = 0.0, pull = 0.0;
  for (const Pair& pair : pairs_) {
    information += pair.information;
    pull += pair.pull;
  }
  Estimate estimate;
  estimate.delay_s = pull / information;
  estimate.pictures = static_cast<int>(pairs_.size());
  // Errors of the poses are common to all patches of a picture: the scatter between pictures tells.
  double scatter = 0.0;
  for (const Pair& pair : pairs_) {
    const double left = pair.pull - pair.information * estimate.delay_s;
    scatter += left * left;
  }
  estimate.sigma_s = std::sqrt(scatter) / information;
  if (estimate.sigma_s > config_.sigma_s) return std::nullopt;
  return estimate;
}

void CameraOffset::judge(HostTime now) {
  while (!pairs_.empty() && now - pairs_.front().stamp > from_seconds(config_.window_s)) pairs_.pop_front();
  if (now < next_judgement_) return;
  next_judgement_ = now + kJudgementPeriod;
  const auto found = estimate();
  if (!found) return;
  const double off_s = std::abs(found->delay_s);
  over_ = off_s - kSigmas * found->sigma_s > config_.limit_s ? over_ + 1 : 0;
  if (in_sync_ && over_ >= kOverInARow) {
    in_sync_ = false;
    ++alarms_;
  } else if (!in_sync_ && off_s < config_.limit_s) {
    in_sync_ = true;
  }
}

}  // namespace edgesplat::sync
