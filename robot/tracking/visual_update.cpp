// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/visual_update.hpp"

#include "common/base/check.hpp"
#include "common/geometry/so3.hpp"
#include "robot/tracking/iterated_update.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace edgesplat::tracking {
namespace {

constexpr std::size_t kBlockSize = 32;
/// Steps smaller than these end a level: about a hundredth of a pixel.
constexpr double kRotationDone_rad = 3e-5;
constexpr double kPositionDone_m = 1e-4;
constexpr double kPixels = image::kPatchPixels;

/// Of a pixel in a picture halved `times` times.
Eigen::Vector2f halved_pixel(const Eigen::Vector2d& pixel, int times) {
  return (((pixel.array() + 0.5) / std::ldexp(1.0, times)) - 0.5).cast<float>();
}

/// Where the body was when the picture was taken. Patches were cut out with about the delay that was believed
/// before the picture: by the mean of what its change moves they would have been moved too.
geometry::RigidTransform odom_from_body_of(const FilterState& state, const PictureView& picture) {
  if (picture.calibration == nullptr) return state.odom_from_body;
  const CalibrationView& calibration = *picture.calibration;
  const Eigen::Matrix<double, 6, 1> change = calibration.rows().col(kErrorSize + kCameraDelay) *
                                             (state.calibration.camera_delay_s - picture.believed_delay_s);
  return plus(moved(state.odom_from_body, calibration.twist, picture.believed_delay_s), change);
}

geometry::RigidTransform odom_from_camera(const FilterState& state, const PictureView& picture) {
  return odom_from_body_of(state, picture) * picture.body_from_camera;
}

template <int Errors>
Correction<Errors> correct_by(const ShiftedPrior<Errors>& prior, const Matrix7d& information,
                              const Vector7d& gradient, const PictureView& picture) {
  if constexpr (Errors == kFullSize) {
    Eigen::Matrix<double, 7, Errors> rows = Eigen::Matrix<double, 7, Errors>::Zero();
    rows.template topRows<6>() = picture.calibration->rows();
    rows(kGain, kGain) = 1.0;
    Matrix7d lasting = Matrix7d::Zero();
    lasting.topLeftCorner<6, 6>() = lasting_pose_errors();
    Correction<Errors> correction = correct(prior, rows, information, gradient, lasting);
    // What the motion does not show of the calibration is only considered (see ScanUpdater).
    ErrorsMatrix<Errors> frozen = ErrorsMatrix<Errors>::Zero();
    frozen.template bottomRightCorner<kCalibrationErrors, kCalibrationErrors>() = picture.calibration->frozen;
    correction.pulled -= (frozen * correction.pulled).eval();
    correction.learnt -= (frozen * correction.learnt * frozen).eval();
    return correction;
  } else {
    return correct(prior, information, gradient);
  }
}

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void VisualUpdater::prepare(int level, const FilterState& state, const VisualMap& map,
                            std::span<const SelectedPatch> patches, const PictureView& picture) {
  const CameraView camera(picture.camera, odom_from_camera(state, picture));
  const geometry::RigidTransform body = odom_from_body_of(state, picture);
  const geometry::RigidTransform body_from_odom = body.inverse();
  const Eigen::Matrix3d rotation = body.rotation.toRotationMatrix();
  const int levels = picture.pyramid.levels();
  prepared_.clear();
  prepared_.reserve(patches.size());
  for (const SelectedPatch& patch : patches) {
    const VisualPoint& point = map.point(patch.point);
    const VisualObservation& observation = map.observation(patch.reference.observation);
    Prepared made{PatchResidual(observation.patches[static_cast<std::size_t>(level)], config_.noise), {}, -1};
    if (const auto seen = look_at(camera, point.p_in_odom_m)) {
      // The level of this picture whose pixels are about as large as the reference's.
      const double zoom = 0.5 * std::log2(std::max(1e-6, patch.reference.warp.determinant()));
      made.level = std::clamp(static_cast<int>(std::lround(level + zoom)), 0, levels - 1);
      const double shrink = std::ldexp(1.0, -made.level);
      made.view.warp.step = (std::ldexp(shrink, level) * patch.reference.warp).cast<float>();
      made.view.warp.growth = (std::ldexp(1.0, level) * patch.reference.growth).cast<float>();
      const Eigen::Vector3d p_in_body = body_from_odom * point.p_in_odom_m;
      Eigen::Matrix<double, 2, 6> by_pose;
      by_pose << seen->pixel_by_odom * rotation * geometry::hat(p_in_body), -seen->pixel_by_odom;
      made.view.pixel_by_pose = (shrink * by_pose).cast<float>();
      made.view.pixel_by_doubt = (shrink * seen->pixel_by_odom * point.doubt_m.cast<double>()).cast<float>();
    }
    prepared_.push_back(made);
  }
}

void VisualUpdater::evaluate(const FilterState& state, const VisualMap& map,
                             std::span<const SelectedPatch> patches, const PictureView& picture) {
  const geometry::RigidTransform camera_from_odom = odom_from_camera(state, picture).inverse();
  equations_.resize(patches.size());
  loop_.run(patches.size(), kBlockSize, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      equations_[i].chi_squared = -1.0F;
      Prepared& made = prepared_[i];
      if (made.level < 0) continue;
      const auto pixel = picture.camera.project(camera_from_odom * map.point(patches[i].point).p_in_odom_m);
      if (!pixel) continue;
      made.view.warp.centre_px = halved_pixel(*pixel, made.level);
      made.view.gain = std::exp(static_cast<float>(state.log_gain) -
                                map.observation(patches[i].reference.observation).log_gain);
      if (!made.residual.evaluate(picture.pyramid.level(made.level), made.view, equations_[i]))
        equations_[i].chi_squared = -1.0F;
    }
  });
}

double VisualUpdater::noise_scale() const {
  std::vector<float> seen;
  for (const PatchEquations& one : equations_)
    if (one.chi_squared >= 0.0F) seen.push_back(one.chi_squared);
  return seen.empty() ? 1.0 : std::max(1.0, static_cast<double>(median(seen)) / kPixels);
}

VisualUpdater::Sums VisualUpdater::sum(double scale) const {
  Sums sums;
  for (const PatchEquations& one : equations_) {
    if (one.chi_squared < 0.0F) continue;
    const double ratio = static_cast<double>(one.chi_squared) / (kPixels * scale);
    if (ratio > kMisfitGate) continue;
    const double weight = config_.share / (scale * (1.0 + ratio / kMisfitHalf));
    sums.information += weight * one.information;
    sums.gradient += weight * one.gradient;
    ++sums.used;
  }
  return sums;
}

/// The median ratio of brightness: a step of exposure would look like noise to the first linearisation.
double VisualUpdater::guess_log_gain(const FilterState& state, const VisualMap& map,
                                     std::span<const SelectedPatch> patches,
                                     const PictureView& picture) const {
  const geometry::RigidTransform camera_from_odom = odom_from_camera(state, picture).inverse();
  std::vector<float> guesses;
  for (const SelectedPatch& patch : patches) {
    const auto pixel = picture.camera.project(camera_from_odom * map.point(patch.point).p_in_odom_m);
    if (!pixel) continue;
    image::PatchValues seen;
    if (!image::sample_patch(picture.pyramid.level(0), {halved_pixel(*pixel, 0)}, seen)) continue;
    const VisualObservation& reference = map.observation(patch.reference.observation);
    const float before = std::accumulate(reference.patches[0].begin(), reference.patches[0].end(), 0.0F) /
                         static_cast<float>(reference.patches[0].size());
    const float now = std::accumulate(seen.begin(), seen.end(), 0.0F) / static_cast<float>(seen.size());
    guesses.push_back(std::log((now + kToeGrey) / (before + kToeGrey)) + reference.log_gain);
  }
  return guesses.empty() ? state.log_gain : static_cast<double>(median(guesses));
}

VisualUpdateResult VisualUpdater::run(const FilterBelief& prior, const VisualMap& map,
                                      std::span<const SelectedPatch> patches, const PictureView& picture) {
  EDGESPLAT_CHECK(!prior.calibration || picture.calibration != nullptr, "a doubted calibration has a view");
  return prior.calibration ? run_with<kFullSize>(prior, map, patches, picture)
                           : run_with<kErrorSize>(prior, map, patches, picture);
}

template <int Errors>
VisualUpdateResult VisualUpdater::run_with(const FilterBelief& prior, const VisualMap& map,
                                           std::span<const SelectedPatch> patches,
                                           const PictureView& picture) {
  VisualUpdateResult result;
  result.belief = prior;
  if (static_cast<int>(patches.size()) < config_.min_patches) return result;
  FilterState present = prior.state;
  present.log_gain = guess_log_gain(prior.state, map, patches, picture);
  for (int level = kPatchLevels - 1; level >= 0; --level) {
    prepare(level, present, map, patches, picture);
    double scale = 0.0;
    // Every step is taken. One that makes the pixels fit worse is right where the prior asks for it: refusing
    // it would leave the pose of the coarser level.
    for (int i = 0; i < config_.max_iterations; ++i) {
      evaluate(present, map, patches, picture);
      if (scale <= 0.0) scale = noise_scale();
      const Sums sums = sum(scale);
      ++result.iterations;
      if (sums.used < config_.min_patches) break;
      const ShiftedPrior<Errors> shifted = shift<Errors>(prior, present);
      const Correction<Errors> correction =
          correct_by<Errors>(shifted, sums.information, sums.gradient, picture);
      const ErrorsVector<Errors> step = shifted.offset + correction.pulled;
      if (!step.allFinite()) return without_update(prior, result);
      present = moved_by<Errors>(present, step);
      if (level == 0) {
        const ErrorsMatrix<Errors> posterior = shifted.covariance - correction.learnt;
        set_covariance<Errors>(result.belief, 0.5 * (posterior + posterior.transpose()));
        result.patches = sums.used;
        result.noise_scale = scale;
        result.updated = true;
        result.misfit.clear();
        for (const PatchEquations& one : equations_)
          result.misfit.push_back(static_cast<double>(one.chi_squared) / (kPixels * scale));
      }
      if (step.template segment<3>(kRot).norm() < kRotationDone_rad &&
          step.template segment<3>(kPos).norm() < kPositionDone_m)
        break;
    }
  }
  if (!result.updated) return without_update(prior, result);
  result.belief.state = present;
  return result;
}

}  // namespace edgesplat::tracking
