// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/stream.hpp"
#include "kernels/core/vram_pool.hpp"
#include "kernels/train/adam.hpp"
#include "kernels/train/gaussian_backward.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace edgesplat::train {

/// What a picture should look like. The arrays belong to the caller and must stay until the step is done.
struct TrainTarget {
  std::span<const float> colour;   ///< [H,W,3] sRGB, 0..1
  std::span<const float> depth_m;  ///< [H,W] along z, 0: not measured; empty: no depth
  std::span<const float> weight;   ///< [H,W] 0..1; empty: every pixel counts
  /// seen = gain * colour + offset, a channel: gain 3, offset 3. Without: the picture is taken as it is.
  std::optional<std::array<float, 6>> exposure;
};

/// As mapping::OptimiserOptions; the losses are those of losses.hpp.
struct TrainSettings {
  LearningRates rates;
  splat::RenderOptions render;
  float ssim_share = 0.2F;
  float depth_factor = 0.1F;
  float depth_min_alpha = 0.5F;
  float gap_factor = 0.0F;
  float opacity_factor = 0.0F;  ///< of the mean opacity of what the picture shows
  float scale_factor = 0.0F;    ///< of its mean scale, m
  bool dense = false;           ///< rows that the picture does not show step as well, with gradient 0
};

struct TrainReport {
  double loss = 0.0;  ///< before the step
  double l1 = 0.0, ssim = 0.0, depth_m = 0.0;
  std::size_t visible = 0;  ///< Gaussians that some pixel shows
  std::size_t tile_pairs = 0;
  std::array<double, 6> by_pose{};      ///< dr, dt as in GaussianGradients
  std::array<double, 6> by_exposure{};  ///< dL by gain 3 and offset 3, where there is an exposure
};

/// One step of Gaussians that live on the GPU: draw, compare, go back, Adam (as mapping::Optimiser does on
/// the CPU); builds with CUDA only. Everything goes into the stream in one go; only the scalars come back,
/// and a step whose frame turned out to need more room than it had changes nothing and is done again. Same
/// contracts and tolerances as the CPU's operations. `in_order`: sums in a fixed order, so that the same
/// calls give the same map; without, tiles add up as they come, which is faster and takes 48 bytes a pair of
/// tile and splat less. Memory comes from the pool, which must outlive it. Single-owner.
class CudaTrainStep {
 public:
  CudaTrainStep(core::VramPool& pool, const AdamOptions& adam, bool in_order = true);
  ~CudaTrainStep();
  CudaTrainStep(CudaTrainStep&&) noexcept;

  /// Takes these Gaussians from now on, with moments of zero. Waits. kInvalidArgument (lengths), kOutOfVram.
  [[nodiscard]] Status set_cloud(const core::Stream& stream, const splat::GaussianSpans& gaussians);
  /// Takes these Gaussians in place of those there are: row i with the moments and steps of the old row
  /// from_rows[i], or none where that is kFreshRow. Old rows must ascend. Waits. kInvalidArgument (lengths),
  /// kOutOfVram: then there is no cloud.
  [[nodiscard]] Status replace_cloud(const core::Stream& stream, const splat::GaussianSpans& gaussians,
                                     std::span<const std::uint32_t> from_rows);
  static constexpr std::uint32_t kFreshRow = 0xFFFFFFFFU;
  /// The Gaussians as they are now into `cloud`, which must be as long as what was set. Waits.
  [[nodiscard]] Status fetch_cloud(const core::Stream& stream, gaussian::GaussianCloud& cloud) const;

  /// One step; waits. kInvalidArgument for arrays that do not fit the view, kOutOfVram.
  [[nodiscard]] Result<TrainReport> step(const core::Stream& stream, const splat::View& view,
                                         const TrainTarget& target, const TrainSettings& settings);
  /// The gradients of the last step or gradients() for every Gaussian that a pixel showed. Waits.
  [[nodiscard]] Status fetch_gradients(const core::Stream& stream, GaussianGradients& out) const;
  /// The Gaussians that the last step moved, as they are now, in place of its gradients. Waits.
  [[nodiscard]] Status fetch_moved(const core::Stream& stream, GaussianGradients& out);
  /// Draws into `drawn`, goes back from dL by the pictures and moves nothing: for tests and for poses. Waits.
  [[nodiscard]] Status gradients(const core::Stream& stream, const splat::View& view,
                                 const splat::RenderOptions& render, const splat::BlendOutputs& drawn,
                                 const PictureGradients& by_picture);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace edgesplat::train
