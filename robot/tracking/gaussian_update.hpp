// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "robot/tracking/block_loop.hpp"
#include "robot/tracking/filter_state.hpp"
#include "robot/tracking/gaussian_brightness.hpp"
#include "robot/tracking/gaussian_pixels.hpp"
#include "robot/tracking/tracked_group.hpp"

#include <span>
#include <vector>

namespace edgesplat::tracking {

struct GaussianUpdateConfig {
  int width_px = 320;      ///< the map is drawn at the first halving of the camera that is at most so wide
  bool depth = false;      ///< the scan's points against the map's depth, beside the picture
  int max_iterations = 6;  ///< at each size
  int max_drawings = 2;    ///< the map is drawn again where the pose moved
};

struct GaussianUpdateResult {
  FilterBelief belief;  ///< the posterior; the prior but for kUsed
  GaussianVerdict verdict = GaussianVerdict::kNotLooked;
  int pixels = 0;  ///< that were compared
  int drawings = 0;
  double coverage = 0.0;     ///< share of the picture that the map fills
  double explained = 0.0;    ///< share of the pixels that the map foretells better than a guess would
  double noise_grey = 0.0;   ///< of a pixel's residual, one sigma
  double chi_squared = 0.0;  ///< of the innovation, six degrees of freedom
  [[nodiscard]] bool updated() const { return verdict == GaussianVerdict::kUsed; }
};

/// Holds a picture, and the scan's depth, against the Gaussian map drawn from the predicted pose (paper 0,
/// 3.2) and updates the filter: Gauss-Newton on robust residuals, coarse to fine. The pixels of the drawn map
/// are carried to the picture by their depth, with the derivatives of the drawn picture, so that one drawing
/// serves all iterations; gain and offset of the brightness are unknowns of the picture and eliminated.
/// Thread-bound; deterministic for any number of threads.
class GaussianUpdater {
 public:
  GaussianUpdater(const GaussianUpdateConfig& config, const sensor::CameraMount& camera, BlockLoop& loop);

  /// `points_in_body_m`: the scan's at the picture's moment. `alone`: there are directions that nothing but
  /// pictures see.
  GaussianUpdateResult run(const FilterBelief& prior, const sensor::ImageRgb8& picture,
                           std::span<const Eigen::Vector3f> points_in_body_m, GaussianView& map, bool alone);

 private:
  /// Pose, gain, offset.
  using Matrix8d = Eigen::Matrix<double, 8, 8>;
  using Vector8d = Eigen::Matrix<double, 8, 1>;
  struct Sums {
    Matrix8d information = Matrix8d::Zero();
    Vector8d gradient = Vector8d::Zero();
    double cost = 0.0;
    int seen = 0;
  };
  /// Normal equations of the pose alone.
  struct PoseEquations {
    Matrix6d information = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
    double cost = 0.0;
  };
  struct Drawn {
    geometry::RigidTransform odom_from_camera;
    GaussianPixels pixels;
  };

  /// The picture's values where the pixels of a level are seen from a state; below 0 out of the picture.
  void look(int level, const FilterState& state);
  [[nodiscard]] Sums sum(int level, const Brightness& brightness, double noise_grey) const;
  void add_surface(const FilterState& state, PoseEquations& equations) const;
  /// One size of the picture; false where there is too little to compare.
  bool align(int level, const FilterBelief& prior, double share, FilterState& state,
             GaussianUpdateResult& result);
  void judge(const FilterBelief& prior, GaussianUpdateResult& result) const;

  GaussianUpdateConfig config_;
  geometry::CameraModel full_;
  geometry::CameraModel camera_;  ///< halved to the size that is drawn, with its distortion
  geometry::CameraModel pinhole_;
  geometry::RigidTransform body_from_camera_;
  int skip_;
  BlockLoop& loop_;
  image::GrayPyramid picture_;
  GaussianPixelChooser chooser_;
  DepthCells depths_;
  Drawn drawn_;
  std::vector<float> seen_;  ///< one a pixel of the level in hand
  PoseEquations last_;       ///< at the finest size, where it ended
};

}  // namespace edgesplat::tracking
