// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/visual_front.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace edgesplat::tracking {
namespace {

/// Pictures are halved until they are at most this wide: finer ones cost more than they tell.
constexpr int kMaxWidth_px = 640;
/// Of the log gain, from picture to picture, where the exposure is not known: it changes in steps.
constexpr double kGainSigma = 0.3;
/// Of the log gain that a known exposure makes: vignetting, and that no camera encodes exactly as sRGB does.
constexpr double kExposureSigma = 0.05;
/// A picture whose coarsest level varies less than this (grey levels) shows nothing.
constexpr double kMinContrast = 2.0;

int halvings(const geometry::CameraModel& camera) {
  int times = 0;
  while (camera.width_px >> times > kMaxWidth_px && times < 4) ++times;
  return times;
}

/// Standard deviation of a picture's values.
double contrast(const sensor::ImageGray8& picture) {
  double sum = 0.0, squares = 0.0;
  for (const std::uint8_t value : picture.values) {
    sum += value;
    squares += static_cast<double>(value) * value;
  }
  const auto n = static_cast<double>(picture.values.size());
  return std::sqrt(std::max(0.0, squares / n - sum / n * sum / n));
}

/// What exposure and gain do to the values (see kToeGrey).
std::optional<double> log_gain_of(const sync::GroupImage& picture) {
  if (!(picture.exposure_s > 0.0F) || !std::isfinite(picture.gain_db)) return std::nullopt;
  constexpr double kGamma = 2.4;
  return (std::log(static_cast<double>(picture.exposure_s)) +
          static_cast<double>(picture.gain_db) * std::numbers::ln10 / 20.0) /
         kGamma;
}

}  // namespace

VisualFront::VisualFront(const TrackingConfig& config, const sensor::CameraMount& camera,
                         const PointNoise& scan_noise, BlockLoop& loop)
    : config_(config),
      full_(camera.model),
      camera_(image::halved(camera.model, halvings(camera.model))),
      body_from_camera_(camera.body_from_camera),
      skip_(halvings(camera.model)),
      grid_(camera_.width_px, camera_.height_px),
      updater_({}, loop),
      map_(static_cast<std::size_t>(config.visual_map_max_mb) << 20U),
      depths_(scan_noise) {}

bool VisualFront::take(const sync::GroupImage& picture) {
  if (picture.image->width_px != full_.width_px || picture.image->height_px != full_.height_px) return false;
  exposure_log_gain_ = log_gain_of(picture);
  if (!first_exposure_log_gain_) first_exposure_log_gain_ = exposure_log_gain_;
  pyramid_.build(*picture.image, skip_, kPatchLevels);
  return contrast(pyramid_.level(kPatchLevels - 1)) > kMinContrast;
}

// The first picture defines gain 1. Later ones have nothing to do with the one before where the exposure is
// known.
FilterBelief VisualFront::with_gain(const FilterBelief& prior) const {
  FilterBelief belief = prior;
  double variance = belief.covariance(kGain, kGain) + kGainSigma * kGainSigma;
  if (exposure_log_gain_ && first_exposure_log_gain_) {
    belief.state.log_gain = *exposure_log_gain_ - *first_exposure_log_gain_;
    variance = kExposureSigma * kExposureSigma;
  }
  belief.covariance.row(kGain).setZero();
  belief.covariance.col(kGain).setZero();
  belief.covariance(kGain, kGain) = std::min(variance, 1.0);
  if (belief.calibration) belief.calibration->with_state.row(kGain).setZero();
  return belief;
}

VisualUpdateResult VisualFront::update(const FilterBelief& prior, std::span<const Eigen::Vector3f> points,
                                       const CalibrationView* calibration) {
  const FilterBelief before = pictures_ > 0 ? with_gain(prior) : prior;
  const geometry::RigidTransform odom_from_camera =
      odom_from_body_of_picture(before.state, calibration) * body_from_camera_;
  const geometry::RigidTransform camera_from_body =
      calibration == nullptr ? body_from_camera_.inverse()
                             : odom_from_camera.inverse() * before.state.odom_from_body;
  depths_.build(points, camera_from_body, camera_);
  patches_ = select_patches(map_, CameraView(camera_, odom_from_camera), grid_, depths_);
  last_ = updater_.run(
      before, map_, patches_,
      {pyramid_, camera_, body_from_camera_, calibration, before.state.calibration.camera_delay_s});
  return last_;
}

std::vector<TrackedPatch> VisualFront::tracked_patches(const CalibrationView* calibration) const {
  std::vector<TrackedPatch> tracked;
  if (!last_.updated) return tracked;
  const CameraView view(camera_,
                        odom_from_body_of_picture(last_.belief.state, calibration) * body_from_camera_);
  const double size = std::ldexp(1.0, skip_);
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    if (last_.misfit[i] < 0.0) continue;
    const auto seen = look_at(view, map_.point(patches_[i].point).p_in_odom_m);
    if (!seen) continue;
    const Eigen::Vector2d at_full_size = (seen->pixel.array() + 0.5) * size - 0.5;
    tracked.push_back({at_full_size.cast<float>(), static_cast<float>(image::kPatchSide * size),
                       static_cast<float>(last_.misfit[i]), last_.misfit[i] <= kMisfitGate});
  }
  return tracked;
}

void VisualFront::extend(const FilterBelief& belief, const PlaneMap& planes,
                         const CalibrationView* calibration) {
  const CameraView view(camera_, odom_from_body_of_picture(belief.state, calibration) * body_from_camera_);
  const PosedPicture picture{pyramid_, view, static_cast<float>(belief.state.log_gain)};
  // Without an update the picture's gain is not known.
  if (!last_.updated && static_cast<int>(patches_.size()) >= VisualUpdateConfig{}.min_patches) return;
  std::vector<bool> occupied(static_cast<std::size_t>(grid_.cells()), false);
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    if (!last_.updated || !last_.agreed(i)) continue;
    const auto seen = look_at(view, map_.point(patches_[i].point).p_in_odom_m);
    if (seen) occupied[static_cast<std::size_t>(grid_.cell_of(seen->pixel))] = true;
  }
  if (last_.updated)
    judge_points(map_, config_.visual_refine_normals ? &planes : nullptr, patches_, last_, picture);
  add_points(map_, planes, picture, grid_, depths_, occupied, pictures_++);
  map_.slide(view.camera_in_odom_m, config_.map_half_extent_m);
}

}  // namespace edgesplat::tracking
