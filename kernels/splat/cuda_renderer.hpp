// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/stream.hpp"
#include "kernels/core/vram_pool.hpp"
#include "kernels/splat/gaussian_spans.hpp"
#include "kernels/splat/render.hpp"

#include <memory>

namespace edgesplat::splat {

/// Draws Gaussians that stay on the GPU from picture to picture; builds with CUDA only. A picture differs
/// from the CPU's by at most one splat of alpha 1/255 in a pixel; the same calls give the same pictures.
/// Memory comes from `pool`, which must outlive it. Single-owner.
class CudaRenderer {
 public:
  /// `half_precision`: the parameters but the means in 16 bits, 34 bytes a Gaussian at SH degree 0 instead of
  /// 56 and 124 at degree 3 instead of 236; pictures move by some thousandths (over 45 dB).
  explicit CudaRenderer(core::VramPool& pool, bool half_precision = false);
  ~CudaRenderer();
  CudaRenderer(CudaRenderer&&) noexcept;

  /// Puts the upload into the stream and waits for it. kInvalidArgument (lengths), kOutOfVram.
  [[nodiscard]] Status set_cloud(const core::Stream& stream, const GaussianSpans& gaussians);
  /// Draws what set_cloud() brought and waits for the pictures. kInvalidArgument (lengths), kOutOfVram.
  [[nodiscard]] Result<RenderStats> draw(const core::Stream& stream, const View& view,
                                         const RenderOptions& options, const BlendOutputs& out);
  /// The same without bringing the pictures to the host, for benchmarks.
  [[nodiscard]] Result<RenderStats> draw_on_device(const core::Stream& stream, const View& view,
                                                   const RenderOptions& options);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace edgesplat::splat
