// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/image/gray_pyramid.hpp"
#include "robot/tracking/block_loop.hpp"
#include "robot/tracking/calibration.hpp"
#include "robot/tracking/filter_state.hpp"
#include "robot/tracking/patch_residual.hpp"
#include "robot/tracking/visual_selection.hpp"

#include <span>
#include <vector>

namespace edgesplat::tracking {

/// Patches whose mean squared residual is this many times the usual one count half (Cauchy kernel) ...
inline constexpr double kMisfitHalf = 3.0;
/// ... and beyond so many times they are left out.
inline constexpr double kMisfitGate = 12.0;

struct VisualUpdateConfig {
  PatchNoise noise;
  int max_iterations = 5;  ///< at each pyramid level
  int min_patches = 12;
  /// The part of independent pixels that those of a patch count as. They share errors of warp, focus and
  /// depth, and a point's place is as wrong in the next picture as in this one. Found in simulation.
  double share = 0.03;
};

/// The present picture and where its camera sits.
struct PictureView {
  const image::GrayPyramid& pyramid;
  const geometry::CameraModel& camera;  ///< of level 0
  geometry::RigidTransform body_from_camera;
  /// Null: the picture was taken at the state's moment.
  const CalibrationView* calibration = nullptr;
  double believed_delay_s = 0.0;  ///< of the camera, before the picture
};

struct VisualUpdateResult {
  FilterBelief belief;  ///< the posterior; the prior where `updated` is false
  bool updated = false;
  int iterations = 0;
  int patches = 0;           ///< that counted
  double noise_scale = 1.0;  ///< how much larger the residuals are than the noise explains, as variances
  /// One a selected patch: its mean squared residual over the usual one; below 0 out of the picture.
  std::vector<double> misfit;
  /// It looked as expected.
  [[nodiscard]] bool agreed(std::size_t patch) const {
    return misfit[patch] >= 0.0 && misfit[patch] < kMisfitHalf;
  }
};

/// The iterated update of the filter with the patches of one picture, coarse to fine (FAST-LIVO2, VI), on
/// rotation, position and gain. Keeps its buffers; thread-bound.
class VisualUpdater {
 public:
  VisualUpdater(const VisualUpdateConfig& config, BlockLoop& loop) : config_(config), loop_(loop) {}

  VisualUpdateResult run(const FilterBelief& prior, const VisualMap& map,
                         std::span<const SelectedPatch> patches, const PictureView& picture);

 private:
  /// What a level's patches share between iterations.
  struct Prepared {
    PatchResidual residual;
    PatchView view;
    int level = 0;  ///< of the present picture
  };
  struct Sums {
    Matrix7d information = Matrix7d::Zero();
    Vector7d gradient = Vector7d::Zero();
    int used = 0;
  };
  template <int Errors>
  VisualUpdateResult run_with(const FilterBelief& prior, const VisualMap& map,
                              std::span<const SelectedPatch> patches, const PictureView& picture);
  void prepare(int level, const FilterState& state, const VisualMap& map,
               std::span<const SelectedPatch> patches, const PictureView& picture);
  /// Equations of every patch at a state; chi squared below 0 for one that is out of the picture.
  void evaluate(const FilterState& state, const VisualMap& map, std::span<const SelectedPatch> patches,
                const PictureView& picture);
  [[nodiscard]] double noise_scale() const;
  [[nodiscard]] Sums sum(double scale) const;
  [[nodiscard]] double guess_log_gain(const FilterState& state, const VisualMap& map,
                                      std::span<const SelectedPatch> patches,
                                      const PictureView& picture) const;

  VisualUpdateConfig config_;
  BlockLoop& loop_;
  std::vector<Prepared> prepared_;
  std::vector<PatchEquations> equations_;
};

}  // namespace edgesplat::tracking
