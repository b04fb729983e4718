// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/gaussian_update.hpp"

#include "common/geometry/so3.hpp"
#include "kernels/image/bilinear.hpp"
#include "kernels/image/undistort.hpp"
#include "robot/tracking/iterated_update.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgesplat::tracking {
namespace {

constexpr std::size_t kBlockSize = 512;
/// Residuals of this many sigma count half (Cauchy).
constexpr double kRobustSigma = 2.0;
/// Fewer pixels, or less of the picture filled by the map, tell nothing.
constexpr int kLeastPixels = 300;
constexpr double kLeastCoverage = 0.2;
/// A picture that varies less (grey levels, one sigma) where the map has texture shows nothing.
constexpr double kLeastContrast_grey = 4.0;
/// Of a picture of somewhere else 38 % of the pixels are foretold by chance.
constexpr double kLeastExplained = 0.6;
/// 99.9 % of chi squared with six degrees of freedom.
constexpr double kMostChiSquared = 22.46;
/// What pixels count as, as a share of independent ones: they share the map's errors, this one and the next
/// picture's.
constexpr double kShareBesideLidar = 0.01;
constexpr double kShareAlone = 0.05;
/// The same of the scan's points against the map's depth: the LiDAR's own map had them already.
constexpr double kShareOfDepth = 0.02;
constexpr double kSurfaceSigma_m = 0.03;
constexpr double kMostOffSurface_m = 0.3;
/// Of the normals of the drawn depth.
constexpr double kNormalSigma_rad = 0.05;
/// Steps smaller than these end a size; moves larger than these make a new drawing worth it.
constexpr double kRotationDone_rad = 3e-5;
constexpr double kPositionDone_m = 1e-4;
constexpr double kRotationFar_rad = 0.003;
constexpr double kPositionFar_m = 0.01;

int halvings(const geometry::CameraModel& camera, int width_px) {
  int times = 0;
  while (camera.width_px >> times > width_px && times < 4) ++times;
  return times;
}

/// Bilinear; below 0 out of the picture.
float sample(const sensor::ImageGray8& picture, const Eigen::Vector2d& at) {
  const double x = std::floor(at.x()), y = std::floor(at.y());
  if (!(x >= 0.0 && y >= 0.0 && x + 1.0 < picture.width_px && y + 1.0 < picture.height_px)) return -1.0F;
  return image::bilinear(picture, static_cast<int>(x), static_cast<int>(y), static_cast<float>(at.x() - x),
                         static_cast<float>(at.y() - y));
}

}  // namespace

GaussianUpdater::GaussianUpdater(const GaussianUpdateConfig& config, const sensor::CameraMount& camera,
                                 BlockLoop& loop)
    : config_(config),
      full_(camera.model),
      camera_(image::halved(camera.model, halvings(camera.model, config.width_px))),
      pinhole_(image::undistorted_model(camera_)),
      body_from_camera_(camera.body_from_camera),
      skip_(halvings(camera.model, config.width_px)),
      loop_(loop) {}

void GaussianUpdater::look(int level, const FilterState& state) {
  const std::vector<GaussianPixel>& pixels = drawn_.pixels.levels[static_cast<std::size_t>(level)];
  const geometry::RigidTransform now_from_drawn =
      (state.odom_from_body * body_from_camera_).inverse() * drawn_.odom_from_camera;
  const geometry::CameraModel camera = image::halved(camera_, level);
  const sensor::ImageGray8& picture = picture_.level(level);
  seen_.resize(pixels.size());
  loop_.run(pixels.size(), kBlockSize, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto pixel = camera.project(now_from_drawn * pixels[i].p_in_camera_m.cast<double>());
      seen_[i] = pixel ? sample(picture, *pixel) : -1.0F;
    }
  });
}

GaussianUpdater::Sums GaussianUpdater::sum(int level, const Brightness& brightness, double noise_grey) const {
  const std::vector<GaussianPixel>& pixels = drawn_.pixels.levels[static_cast<std::size_t>(level)];
  std::vector<Sums> blocks(BlockLoop::blocks(pixels.size(), kBlockSize));
  const double half = 1.0 / (kRobustSigma * noise_grey);
  loop_.run(pixels.size(), kBlockSize, [&](std::size_t block, std::size_t first, std::size_t last) {
    Sums& sums = blocks[block];
    for (std::size_t i = first; i < last; ++i) {
      if (seen_[i] < 0.0F) continue;
      const double map = static_cast<double>(pixels[i].value);
      const double residual = static_cast<double>(seen_[i]) - brightness.gain * map - brightness.offset;
      const double ratio = residual * half * residual * half;
      const double weight = 1.0 / (1.0 + ratio);
      Vector8d row;
      row << brightness.gain * pixels[i].value_by_pose.cast<double>(), -map, -1.0;
      sums.information.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
      sums.gradient += weight * residual * row;
      sums.cost += std::log1p(ratio);
      ++sums.seen;
    }
  });
  Sums total;
  for (const Sums& block : blocks) {
    total.information += block.information;
    total.gradient += block.gradient;
    total.cost += block.cost;
    total.seen += block.seen;
  }
  total.information = total.information.selfadjointView<Eigen::Lower>();
  return total;
}

void GaussianUpdater::add_surface(const FilterState& state, PoseEquations& equations) const {
  const Eigen::Matrix3d rotation = state.odom_from_body.rotation.toRotationMatrix();
  NormalEquations sums;
  for (const SurfacePoint& at : drawn_.pixels.surface) {
    const Eigen::Vector3d p = at.p_in_body_m.cast<double>();
    const double off = at.normal_in_odom.dot(state.odom_from_body * p - at.on_surface_in_odom_m);
    if (std::abs(off) > kMostOffSurface_m) continue;
    const double ratio = std::pow(off / (kRobustSigma * kSurfaceSigma_m), 2);
    const double weight = kShareOfDepth / (kSurfaceSigma_m * kSurfaceSigma_m * (1.0 + ratio));
    Eigen::Matrix<double, 6, 3> by_normal;
    by_normal << geometry::hat(p) * rotation.transpose(), Eigen::Matrix3d::Identity();
    const Vector6d row = by_normal * at.normal_in_odom;
    sums.information += weight * row * row.transpose();
    sums.gradient += weight * off * row;
    const Eigen::Matrix3d tilt =
        Eigen::Matrix3d::Identity() - at.normal_in_odom * at.normal_in_odom.transpose();
    sums.noise += weight * kNormalSigma_rad * kNormalSigma_rad * by_normal * tilt * by_normal.transpose();
  }
  const ObservedPart part = keep_observed(sums);
  equations.information += part.information;
  equations.gradient += part.gradient;
}

bool GaussianUpdater::align(int level, const FilterBelief& prior, double share, FilterState& state,
                            GaussianUpdateResult& result) {
  const std::vector<GaussianPixel>& pixels = drawn_.pixels.levels[static_cast<std::size_t>(level)];
  const int least = kLeastPixels >> (2 * level);
  if (static_cast<int>(pixels.size()) < least) return false;
  look(level, state);
  Brightness brightness = guess_brightness(pixels, seen_);
  const double noise_grey = residual_noise_grey(pixels, seen_, brightness);
  FilterState present = state;
  double least_cost = std::numeric_limits<double>::infinity();
  for (int i = 0; i < config_.max_iterations; ++i) {
    if (i > 0) look(level, present);
    const Sums sums = sum(level, brightness, noise_grey);
    if (sums.seen < least) return false;
    if (sums.cost / sums.seen >= least_cost) break;
    least_cost = sums.cost / sums.seen;
    state = present;
    // Gain and offset eliminated; the least of a prior keeps a map of one grey regular.
    Eigen::Matrix2d of_brightness = sums.information.bottomRightCorner<2, 2>();
    of_brightness.diagonal().array() += 1e-3;
    const Eigen::LDLT<Eigen::Matrix2d> solve(of_brightness);
    const Eigen::Matrix<double, 2, 6> mixed = sums.information.bottomLeftCorner<2, 6>();
    const double weight = share / (noise_grey * noise_grey);
    PoseEquations equations;
    equations.information =
        weight * (sums.information.topLeftCorner<6, 6>() - mixed.transpose() * solve.solve(mixed));
    equations.gradient =
        weight * (sums.gradient.head<6>() - mixed.transpose() * solve.solve(sums.gradient.tail<2>()));
    if (config_.depth) add_surface(present, equations);
    if (level == 0) {
      last_ = equations;
      result.pixels = sums.seen;
      result.noise_grey = noise_grey;
    }
    const ShiftedPrior shifted = shift(prior, present);
    const ErrorVector step =
        shifted.offset + correct<6>(shifted, equations.information, equations.gradient).pulled;
    if (!step.allFinite()) return false;
    present = plus(present, step);
    const Eigen::Vector2d brighter = solve.solve(-sums.gradient.tail<2>() - mixed * step.head<6>());
    brightness.gain += brighter.x();
    brightness.offset += brighter.y();
    if (step.segment<3>(kRot).norm() < kRotationDone_rad && step.segment<3>(kPos).norm() < kPositionDone_m) {
      state = present;
      break;
    }
  }
  return true;
}

// How well the map foretells the picture, and whether the pose is one that the filter can believe.
void GaussianUpdater::judge(const FilterBelief& prior, GaussianUpdateResult& result) const {
  const std::vector<GaussianPixel>& pixels = drawn_.pixels.levels[0];
  const Brightness brightness = guess_brightness(pixels, seen_);
  const Foretold foretold = how_foretold(pixels, seen_, brightness);
  result.explained = foretold.explained;
  // What the picture alone says: the minimum z of its equations, seen from the prior, with covariance A^-1.
  Matrix6d information = last_.information;
  information.diagonal().array() += 1e-9 * information.trace() + 1e-12;
  const Matrix6d alone = information.inverse();
  const Vector6d z = minus(result.belief.state, prior.state).head<6>() - alone * last_.gradient;
  result.chi_squared = z.dot((prior.covariance.topLeftCorner<6, 6>() + alone).ldlt().solve(z));
  if (foretold.spread_grey < kLeastContrast_grey) {
    result.verdict = GaussianVerdict::kNoPicture;
  } else if (!(result.explained > kLeastExplained) || !(brightness.gain > 0.0)) {
    result.verdict = GaussianVerdict::kUnlike;
  } else if (!(result.chi_squared < kMostChiSquared)) {
    result.verdict = GaussianVerdict::kContradicts;
  } else {
    result.verdict = GaussianVerdict::kUsed;
  }
}

GaussianUpdateResult GaussianUpdater::run(const FilterBelief& prior, const sensor::ImageRgb8& picture,
                                          std::span<const Eigen::Vector3f> points, GaussianView& map,
                                          bool alone) {
  GaussianUpdateResult result;
  result.belief = prior;
  result.verdict = GaussianVerdict::kNoPicture;
  if (picture.width_px != full_.width_px || picture.height_px != full_.height_px) return result;
  picture_.build(picture, skip_, kGaussianLevels);
  depths_.build(points, body_from_camera_.inverse(), pinhole_);
  const double share = alone ? kShareAlone : kShareBesideLidar;
  FilterState state = prior.state;
  result.verdict = GaussianVerdict::kNoMap;
  for (; result.drawings < config_.max_drawings; ++result.drawings) {
    const FilterState before = state;
    drawn_.odom_from_camera = state.odom_from_body * body_from_camera_;
    const auto drawn = map.draw(pinhole_, drawn_.odom_from_camera);
    if (!drawn) return result;
    chooser_.choose(*drawn, {pinhole_, state.odom_from_body, body_from_camera_}, depths_, points,
                    drawn_.pixels);
    result.coverage = drawn_.pixels.coverage;
    if (drawn_.pixels.coverage < kLeastCoverage) return result;
    for (int level = result.drawings == 0 ? kGaussianLevels - 1 : 1; level >= 0; --level)
      if (!align(level, prior, share, state, result)) return result;
    const ErrorVector moved = minus(state, before);
    if (moved.segment<3>(kRot).norm() < kRotationFar_rad && moved.segment<3>(kPos).norm() < kPositionFar_m) {
      ++result.drawings;
      break;
    }
  }
  look(0, state);
  result.belief.state = state;
  judge(prior, result);
  if (!result.updated()) {
    result.belief = prior;
    return result;
  }
  const ShiftedPrior shifted = shift(prior, state);
  const ErrorMatrix posterior =
      shifted.covariance - correct<6>(shifted, last_.information, last_.gradient).learnt;
  result.belief.covariance = 0.5 * (posterior + posterior.transpose());
  return result;
}

}  // namespace edgesplat::tracking
