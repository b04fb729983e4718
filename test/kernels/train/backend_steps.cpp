// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/kernels/train/backend_steps.hpp"

#include "kernels/splat/render.hpp"
#include "kernels/splat/tile_lists.hpp"
#include "kernels/train/losses.hpp"

#include <cmath>

#ifdef EDGESPLAT_WITH_CUDA
#include "kernels/train/cuda_train_step.hpp"
#endif

namespace edgesplat::train {
namespace {

struct Drawn {
  explicit Drawn(const splat::View& view)
      : pixels(static_cast<std::size_t>(view.width_px * view.height_px)),
        colour(3 * pixels),
        depth_sum_m(pixels),
        alpha(pixels) {}
  std::size_t pixels;
  std::vector<float> colour, depth_sum_m, alpha;
};

/// Adds what mean opacity and mean scale of the shown do to gradients and loss.
void regularise(const Task& task, const gaussian::GaussianCloud& cloud, GaussianGradients& gradients,
                double& loss) {
  const float share = 1.0F / static_cast<float>(gradients.rows.size());
  for (std::size_t i = 0; i < gradients.rows.size(); ++i) {
    float* by = &gradients.values[i * gradients.stride];
    const std::size_t row = gradients.rows[i];
    const float opacity = 1.0F / (1.0F + std::exp(-cloud.opacity_logits[row]));
    by[ParameterRow::kOpacity] += task.opacity_factor * share * opacity * (1.0F - opacity);
    loss += static_cast<double>(task.opacity_factor * share * opacity);
    for (std::size_t k = 0; k < 3; ++k) {
      const float by_scale = task.scale_factor * share * std::exp(cloud.log_scales[3 * row + k]) / 3.0F;
      by[ParameterRow::kLogScale + k] += by_scale;
      loss += static_cast<double>(by_scale);
    }
  }
}

/// Losses of the picture and dL by it.
StepResult compare(const splat::View& view, const Task& task, const Drawn& drawn, Drawn& by) {
  StepResult result;
  std::vector<float> seen = drawn.colour;
  if (task.exposure) {
    for (std::size_t i = 0; i < seen.size(); ++i)
      seen[i] = (*task.exposure)[i % 3] * seen[i] + (*task.exposure)[3 + i % 3];
  }
  const ColourLoss colour = colour_loss({view.width_px, view.height_px, seen, task.colour, task.weight},
                                        task.ssim_share, by.colour);
  for (std::size_t i = 0; task.exposure && i < seen.size(); ++i) {
    result.by_exposure[i % 3] += static_cast<double>(by.colour[i] * drawn.colour[i]);
    result.by_exposure[3 + i % 3] += static_cast<double>(by.colour[i]);
    by.colour[i] *= (*task.exposure)[i % 3];
  }
  result.l1 = colour.l1;
  result.ssim = colour.ssim;
  result.loss = colour.value;
  if (!task.depth_m.empty()) {
    result.depth_m = depth_loss({drawn.depth_sum_m, drawn.alpha, task.depth_m, task.weight},
                                task.depth_factor, task.depth_min_alpha, by.depth_sum_m, by.alpha);
    result.loss += static_cast<double>(task.depth_factor) * result.depth_m;
  }
  if (task.gap_factor > 0.0F) {
    result.loss += static_cast<double>(task.gap_factor) *
                   add_gap_loss(drawn.alpha, task.weight, task.gap_factor, by.alpha);
  }
  return result;
}

std::vector<StepResult> steps_on_cpu(const splat::View& view, const Task& task, int steps,
                                     gaussian::GaussianCloud& cloud) {
  Adam adam(cloud.sh_degree, task.adam);
  adam.resize(cloud.size());
  std::vector<StepResult> results;
  BlendBackwardScratch scratch;
  for (int i = 0; i < steps; ++i) {
    const auto projected = *splat::project(core::Backend::kCpu, splat::spans_of(cloud), view, task.render);
    const auto tiles = splat::make_tile_lists(projected.splats, view.width_px, view.height_px);
    Drawn drawn(view), by(view);
    splat::blend(projected.splats, tiles, view, task.render, {drawn.colour, drawn.depth_sum_m, drawn.alpha});
    StepResult result = compare(view, task, drawn, by);
    const auto by_splat =
        blend_backward(projected.splats, tiles, view, {drawn.colour, drawn.depth_sum_m, drawn.alpha},
                       {by.colour, by.depth_sum_m, by.alpha}, scratch);
    GaussianGradients gradients =
        gaussian_backward(splat::spans_of(cloud), view, task.render, by_splat.by_row);
    result.by_pose = gradients.pose;
    result.visible = gradients.rows.size();
    regularise(task, cloud, gradients, result.loss);
    adam.step(gradients.rows, gradients.values, task.rates, cloud);
    results.push_back(result);
  }
  return results;
}

GaussianGradients gradients_on_cpu(const gaussian::GaussianCloud& cloud, const splat::View& view,
                                   const splat::RenderOptions& options, const PictureGradients& by_picture) {
  const auto projected = *splat::project(core::Backend::kCpu, splat::spans_of(cloud), view, options);
  const auto tiles = splat::make_tile_lists(projected.splats, view.width_px, view.height_px);
  Drawn drawn(view);
  splat::blend(projected.splats, tiles, view, options, {drawn.colour, drawn.depth_sum_m, drawn.alpha});
  BlendBackwardScratch scratch;
  const auto by_splat = blend_backward(projected.splats, tiles, view,
                                       {drawn.colour, drawn.depth_sum_m, drawn.alpha}, by_picture, scratch);
  return gaussian_backward(splat::spans_of(cloud), view, options, by_splat.by_row);
}

#ifdef EDGESPLAT_WITH_CUDA

constexpr std::size_t kBudget_bytes = std::size_t{1} << 30U;

Result<GaussianGradients> gradients_on_cuda(bool in_order, const gaussian::GaussianCloud& cloud,
                                            const splat::View& view, const splat::RenderOptions& options,
                                            const PictureGradients& by_picture) {
  EDGESPLAT_TRY(const core::Stream stream, core::Stream::create());
  core::VramPool pool(kBudget_bytes);
  CudaTrainStep step(pool, {}, in_order);
  Drawn drawn(view);
  EDGESPLAT_TRY_STATUS(step.set_cloud(stream, splat::spans_of(cloud)));
  EDGESPLAT_TRY_STATUS(
      step.gradients(stream, view, options, {drawn.colour, drawn.depth_sum_m, drawn.alpha}, by_picture));
  GaussianGradients out;
  EDGESPLAT_TRY_STATUS(step.fetch_gradients(stream, out));
  return out;
}

Result<std::vector<StepResult>> steps_on_cuda(bool in_order, const splat::View& view, const Task& task,
                                              int steps, gaussian::GaussianCloud& cloud) {
  EDGESPLAT_TRY(const core::Stream stream, core::Stream::create());
  core::VramPool pool(kBudget_bytes);
  CudaTrainStep step(pool, task.adam, in_order);
  TrainSettings settings;
  settings.rates = task.rates;
  settings.render = task.render;
  settings.ssim_share = task.ssim_share;
  settings.depth_factor = task.depth_factor;
  settings.depth_min_alpha = task.depth_min_alpha;
  settings.gap_factor = task.gap_factor;
  settings.opacity_factor = task.opacity_factor;
  settings.scale_factor = task.scale_factor;
  EDGESPLAT_TRY_STATUS(step.set_cloud(stream, splat::spans_of(cloud)));
  std::vector<StepResult> results;
  for (int i = 0; i < steps; ++i) {
    EDGESPLAT_TRY(const TrainReport report,
                  step.step(stream, view, {task.colour, task.depth_m, task.weight, task.exposure}, settings));
    results.push_back({report.loss, report.l1, report.ssim, report.depth_m, report.visible, report.by_pose,
                       report.by_exposure});
  }
  EDGESPLAT_TRY_STATUS(step.fetch_cloud(stream, cloud));
  return results;
}

#endif

}  // namespace

Result<GaussianGradients> gradients_on(const Way& way, const gaussian::GaussianCloud& cloud,
                                       const splat::View& view, const splat::RenderOptions& options,
                                       const PictureGradients& by_picture) {
  if (way.backend == core::Backend::kCpu) return gradients_on_cpu(cloud, view, options, by_picture);
#ifdef EDGESPLAT_WITH_CUDA
  return gradients_on_cuda(way.in_order, cloud, view, options, by_picture);
#else
  return fail(Errc::kUnavailable, "this build has no CUDA backend");
#endif
}

Result<std::vector<StepResult>> steps_on(const Way& way, const splat::View& view, const Task& task, int steps,
                                         gaussian::GaussianCloud& cloud) {
  if (way.backend == core::Backend::kCpu) return steps_on_cpu(view, task, steps, cloud);
#ifdef EDGESPLAT_WITH_CUDA
  return steps_on_cuda(way.in_order, view, task, steps, cloud);
#else
  return fail(Errc::kUnavailable, "this build has no CUDA backend");
#endif
}

}  // namespace edgesplat::train
