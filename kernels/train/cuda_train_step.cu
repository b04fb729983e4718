// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/cuda_train_step.hpp"

#include "kernels/train/cuda_train_state.cuh"

#include <algorithm>
#include <vector>

namespace edgesplat::train {
namespace {

Status check(const splat::View& view, const TrainTarget& target) {
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  const auto fits = [pixels](std::span<const float> values) {
    return values.empty() || values.size() == pixels;
  };
  if (view.width_px > 0 && view.height_px > 0 && target.colour.size() == 3 * pixels && fits(target.depth_m) &&
      fits(target.weight)) {
    return {};
  }
  return fail(Errc::kInvalidArgument, "the training pictures do not have the view's size");
}

Result<std::array<double, kStepScalars>> fetch_scalars(const core::Stream& stream,
                                                       const core::DeviceBuffer<double>& scalars) {
  std::array<double, kStepScalars> values{};
  EDGESPLAT_TRY_STATUS(core::download(stream, scalars, std::span<double>(values)));
  EDGESPLAT_TRY_STATUS(stream.synchronise());
  return values;
}

TrainReport report_of(const std::array<double, kStepScalars>& scalars, const TrainSettings& settings) {
  TrainReport report;
  const auto mean = [&scalars](StepScalar sum, double total) {
    return total > 0.0 ? scalars[sum] / total : 0.0;
  };
  const double total = scalars[kTotalWeight];
  const auto share = static_cast<double>(settings.ssim_share);
  report.l1 = mean(kL1Sum, 3.0 * total);
  report.ssim = mean(kSsimSum, 3.0 * total);
  report.depth_m = mean(kDepthSum_m, scalars[kMeasuredWeight]);
  report.loss = (1.0 - share) * report.l1 + (total > 0.0 ? share * (1.0 - report.ssim) : 0.0) +
                static_cast<double>(settings.depth_factor) * report.depth_m +
                static_cast<double>(settings.gap_factor) * mean(kGapSum, total) + scalars[kRegular];
  for (std::size_t k = 0; k < 6; ++k) {
    report.by_pose[k] = scalars[kByPose + k];
    report.by_exposure[k] = scalars[kByExposure + k];
  }
  return report;
}

}  // namespace

CudaTrainStep::CudaTrainStep(core::VramPool& pool, const AdamOptions& adam, bool in_order)
    : state_(std::make_unique<State>(pool, adam, in_order)) {}
CudaTrainStep::~CudaTrainStep() = default;
CudaTrainStep::CudaTrainStep(CudaTrainStep&&) noexcept = default;

Status CudaTrainStep::set_cloud(const core::Stream& stream, const splat::GaussianSpans& gaussians) {
  State& s = *state_;
  EDGESPLAT_TRY_STATUS(s.cloud.set(stream, gaussians));
  const std::size_t floats = gaussians.size() * ParameterRow::stride(gaussians.sh_degree);
  EDGESPLAT_TRY_STATUS(s.first.reserve(floats));
  EDGESPLAT_TRY_STATUS(s.second.reserve(floats));
  EDGESPLAT_TRY_STATUS(s.steps.reserve(gaussians.size()));
  EDGESPLAT_TRY_STATUS(core::fill_bytes(stream, s.first, 0, floats));
  EDGESPLAT_TRY_STATUS(core::fill_bytes(stream, s.second, 0, floats));
  EDGESPLAT_TRY_STATUS(core::fill_bytes(stream, s.steps, 0, gaussians.size()));
  return stream.synchronise();
}

Status CudaTrainStep::replace_cloud(const core::Stream& stream, const splat::GaussianSpans& gaussians,
                                    std::span<const std::uint32_t> from_rows) {
  State& s = *state_;
  const std::size_t old_rows = s.cloud.size();
  bool ascending = true;
  std::uint32_t next = 0;
  for (const std::uint32_t row : from_rows) {
    if (row == kFreshRow) continue;
    ascending = ascending && row >= next && row < old_rows;
    next = row + 1;
  }
  if (from_rows.size() != gaussians.size() || !ascending ||
      (old_rows > 0 && gaussians.sh_degree != s.cloud.sh_degree()))
    return fail(Errc::kInvalidArgument, "an old row for each new one, ascending, of the same SH degree");
  EDGESPLAT_TRY_STATUS(s.move_moments(stream, from_rows, ParameterRow::stride(gaussians.sh_degree)));
  EDGESPLAT_TRY_STATUS(s.cloud.set(stream, gaussians));
  return stream.synchronise();
}

Status CudaTrainStep::fetch_moved(const core::Stream& stream, GaussianGradients& out) {
  EDGESPLAT_TRY_STATUS(parameters_on_device(stream, state_->reverse));
  return fetch_gradients(stream, out);
}

Status CudaTrainStep::fetch_cloud(const core::Stream& stream, gaussian::GaussianCloud& cloud) const {
  const splat::DeviceCloud& from = state_->cloud;
  if (cloud.size() != from.size() || cloud.sh_degree != from.sh_degree() || !cloud.consistent())
    return fail(Errc::kInvalidArgument, "the cloud is not as long as the one that was set");
  EDGESPLAT_TRY_STATUS(
      from.fetch(stream, cloud.means_m, cloud.log_scales, cloud.quats_xyzw, cloud.opacity_logits, cloud.sh));
  return stream.synchronise();
}

Result<TrainReport> CudaTrainStep::step(const core::Stream& stream, const splat::View& view,
                                        const TrainTarget& target, const TrainSettings& settings) {
  EDGESPLAT_TRY_STATUS(check(view, target));
  State& s = *state_;
  const splat::DeviceView on_device = splat::device_view(view, settings.render);
  EDGESPLAT_TRY_STATUS(s.size_pictures(on_device, target, settings));
  EDGESPLAT_TRY_STATUS(s.upload_target(stream, target));
  for (int tries = 0; tries < 3; ++tries) {
    EDGESPLAT_TRY_STATUS(s.start(stream, on_device, settings));
    EDGESPLAT_TRY(const splat::FrameCounts counts, s.pass.wait(stream));
    const bool done = s.pass.complete(counts);
    EDGESPLAT_TRY_STATUS(s.pass.fit_room(counts));
    if (!done) continue;
    std::uint32_t shown = 0;
    EDGESPLAT_TRY_STATUS(core::download(stream, s.shown, std::span(&shown, 1)));
    EDGESPLAT_TRY(const auto scalars, fetch_scalars(stream, s.scalars));
    s.visible = counts.visible;
    TrainReport report = report_of(scalars, settings);
    report.visible = shown;
    report.tile_pairs = static_cast<std::size_t>(counts.pairs);
    return report;
  }
  return fail(Errc::kIo, "the GPU counts differently each time it draws the same picture: check its memory");
}

Status CudaTrainStep::gradients(const core::Stream& stream, const splat::View& view,
                                const splat::RenderOptions& render, const splat::BlendOutputs& drawn,
                                const PictureGradients& by_picture) {
  State& s = *state_;
  const splat::DeviceView on_device = splat::device_view(view, render);
  const std::size_t pixels = on_device.pixels();
  const auto fits = [pixels](std::span<const float> values) {
    return values.empty() || values.size() == pixels;
  };
  if (drawn.colour.size() != 3 * pixels || drawn.depth_sum_m.size() != pixels ||
      drawn.alpha.size() != pixels || by_picture.colour.size() != 3 * pixels || !fits(by_picture.depth_sum) ||
      !fits(by_picture.alpha)) {
    return fail(Errc::kInvalidArgument, "the pictures and their gradients do not have the view's size");
  }
  TrainTarget all;  // a depth asks for the gradients of depth and alpha; those that are empty are set to zero
  all.depth_m = drawn.depth_sum_m;
  TrainSettings settings;
  settings.depth_factor = 1.0F;
  EDGESPLAT_TRY_STATUS(s.size_pictures(on_device, all, settings));
  EDGESPLAT_TRY(const splat::FrameCounts counts, s.pass.draw(stream, s.cloud, on_device, s.loss.drawn));
  s.visible = counts.visible;
  EDGESPLAT_TRY_STATUS(s.size_reverse());
  const auto bring = [&stream](std::span<const float> from, float* to, std::size_t count) {
    return core::cuda_status(from.empty() ? cudaMemsetAsync(to, 0, count * sizeof(float), stream.get())
                                          : cudaMemcpyAsync(to, from.data(), from.size_bytes(),
                                                            cudaMemcpyHostToDevice, stream.get()),
                             "bringing gradients");
  };
  EDGESPLAT_TRY_STATUS(bring(by_picture.colour, s.loss.by_colour, 3 * pixels));
  EDGESPLAT_TRY_STATUS(bring(by_picture.depth_sum, s.loss.by_depth_sum, pixels));
  EDGESPLAT_TRY_STATUS(bring(by_picture.alpha, s.loss.by_alpha, pixels));
  EDGESPLAT_TRY_STATUS(s.start_reverse(stream));
  const float* next = s.loss.drawn.colour;
  for (const std::span<float> picture : {drawn.colour, drawn.depth_sum_m, drawn.alpha}) {
    EDGESPLAT_CUDA_TRY(
        cudaMemcpyAsync(picture.data(), next, picture.size_bytes(), cudaMemcpyDeviceToHost, stream.get()));
    next += picture.size();
  }
  return stream.synchronise();
}

Status CudaTrainStep::fetch_gradients(const core::Stream& stream, GaussianGradients& out) const {
  const State& s = *state_;
  const std::size_t stride = s.reverse.stride;
  std::vector<float> rows(s.visible * stride);
  std::vector<Sighting> sightings(s.visible);
  std::vector<std::uint32_t> numbers(s.visible);
  EDGESPLAT_TRY_STATUS(core::download(stream, s.rows, std::span(rows)));
  EDGESPLAT_TRY_STATUS(core::download(stream, s.sightings, std::span(sightings)));
  if (!numbers.empty()) {
    EDGESPLAT_CUDA_TRY(cudaMemcpyAsync(numbers.data(), s.reverse.frame.visible_rows,
                                       numbers.size() * sizeof(std::uint32_t), cudaMemcpyDeviceToHost,
                                       stream.get()));
  }
  EDGESPLAT_TRY(const auto scalars, fetch_scalars(stream, s.scalars));
  out = {};
  out.stride = stride;
  for (std::size_t j = 0; j < s.visible; ++j) {
    if (!(sightings[j].weight > 0.0F)) continue;  // no pixel shows it
    out.rows.push_back(numbers[j]);
    out.sightings.push_back(sightings[j]);
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(j * stride);
    out.values.insert(out.values.end(), first, first + static_cast<std::ptrdiff_t>(stride));
  }
  std::copy_n(scalars.begin() + kByPose, 6, out.pose.begin());
  return {};
}

}  // namespace edgesplat::train
