// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/optimiser.hpp"

#include "kernels/mapping/step_device.hpp"
#include "kernels/splat/render.hpp"
#include "kernels/train/losses.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace edgesplat::mapping {
namespace {

using gaussian::GaussianCloud;

/// Row `row` of `from`, whose SH degree is no higher than that of `to`, at the end of `to`.
void append_padded(const GaussianCloud& from, std::size_t row, GaussianCloud& to) {
  const auto copy = [row](const auto& source, std::size_t width, auto& target) {
    const auto first = source.begin() + static_cast<std::ptrdiff_t>(row * width);
    target.insert(target.end(), first, first + static_cast<std::ptrdiff_t>(width));
  };
  copy(from.ids, 1, to.ids);
  copy(from.means_m, 3, to.means_m);
  copy(from.log_scales, 3, to.log_scales);
  copy(from.quats_xyzw, 4, to.quats_xyzw);
  copy(from.opacity_logits, 1, to.opacity_logits);
  copy(from.sh, from.sh_floats_each(), to.sh);
  to.sh.resize(to.ids.size() * to.sh_floats_each(), 0.0F);
  copy(from.anchors, 1, to.anchors);
}

/// Time since the last call, for reports.
class Stopwatch {
 public:
  explicit Stopwatch(const Clock& clock) : clock_(clock), last_(clock.now()) {}
  std::chrono::nanoseconds lap() {
    const HostTime now = clock_.now();
    const auto passed = now - last_;
    last_ = now;
    return passed;
  }

 private:
  const Clock& clock_;
  HostTime last_;
};

}  // namespace

Result<Optimiser> Optimiser::create(const OptimiserOptions& options, const Clock& clock) {
  EDGESPLAT_TRY_STATUS(options.validate());
  Optimiser optimiser(options, clock);
  optimiser.open_gpu();
  return optimiser;
}

Optimiser::Optimiser(const OptimiserOptions& options, const Clock& clock)
    : options_(options),
      clock_(&clock),
      adam_(options.sh_degree, options.adam),
      exposures_(options.exposure),
      switches_(options.prune) {
  cloud_.sh_degree = options.sh_degree;
}

std::size_t Optimiser::bytes_per_row() const {
  return (train::ParameterRow::size(options_.sh_degree) +
          2 * train::ParameterRow::stride(options_.sh_degree)) *
             sizeof(float) +
         sizeof(gaussian::GaussianId) + sizeof(gaussian::Anchor) + sizeof(std::uint16_t) +
         sizeof(ChangeMark) + sizeof(RowStatistics);
}

std::size_t Optimiser::room() const {
  const std::size_t most = std::min(options_.max_gaussians, options_.max_bytes / bytes_per_row());
  return most - std::min(most, cloud_.size());
}

Result<std::size_t> Optimiser::add_rows(const GaussianCloud& rows) {
  if (!rows.consistent()) return fail(Errc::kInvalidArgument, "Gaussian arrays of different lengths");
  if (rows.sh_degree > cloud_.sh_degree) {
    return fail(Errc::kInvalidArgument, "rows of SH degree " + std::to_string(rows.sh_degree) +
                                            " in a map of degree " + std::to_string(cloud_.sh_degree));
  }
  const std::size_t count = std::min(rows.size(), room());
  rows_refused_ += rows.size() - count;
  for (std::size_t row = 0; row < count; ++row) append_padded(rows, row, cloud_);
  changes_.begin();
  changes_.resize(cloud_.size());
  if (device_) {
    device_->appended(count);
  } else {
    adam_.resize(cloud_.size());
  }
  switches_.append(cloud_.opacity_logits);
  statistics_.resize(cloud_.size());
  return count;
}

Status Optimiser::remove_rows(std::span<const std::uint32_t> rows) {
  std::vector<bool> gone(cloud_.size(), false);
  for (const std::uint32_t row : rows) {
    if (row >= cloud_.size())
      return fail(Errc::kInvalidArgument, "no row " + std::to_string(row) + " to remove");
    gone[row] = true;
  }
  std::vector<std::uint32_t> kept;
  kept.reserve(cloud_.size());
  for (std::size_t row = 0; row < cloud_.size(); ++row)
    if (!gone[row]) kept.push_back(static_cast<std::uint32_t>(row));
  keep_rows(kept);
  return {};
}

void Optimiser::keep_rows(std::span<const std::uint32_t> rows) {
  for (std::size_t to = 0; to < rows.size(); ++to)
    if (rows[to] != to) cloud_.copy_row(rows[to], to);
  cloud_.resize(rows.size());
  if (device_) {
    device_->kept(rows);
  } else {
    adam_.keep_rows(rows);
  }
  switches_.keep_rows(rows);
  changes_.keep_rows(rows);
  mapping::keep_rows(rows, statistics_);
}

GaussianCloud& Optimiser::edit_rows(std::span<const std::uint32_t> rows) {
  changes_.begin();
  for (const std::uint32_t row : rows) changes_.touch(row);
  if (device_) device_->edited();
  return cloud_;
}

Status Optimiser::raise_sh_degree(int sh_degree) {
  if (sh_degree < cloud_.sh_degree || sh_degree > 3) {
    return fail(Errc::kInvalidArgument, "cannot raise SH degree " + std::to_string(cloud_.sh_degree) +
                                            " to " + std::to_string(sh_degree));
  }
  if (sh_degree == cloud_.sh_degree) return {};
  const std::size_t floats = cloud_.sh_floats_each();
  cloud_.sh_degree = options_.sh_degree = sh_degree;
  const std::size_t wider = cloud_.sh_floats_each();
  std::vector<float> sh(cloud_.size() * wider, 0.0F);
  for (std::size_t row = 0; row < cloud_.size(); ++row)
    std::copy_n(cloud_.sh.begin() + static_cast<std::ptrdiff_t>(row * floats), floats,
                sh.begin() + static_cast<std::ptrdiff_t>(row * wider));
  cloud_.sh = std::move(sh);
  adam_.raise_sh_degree(sh_degree);
  if (device_) restart_gpu();
  changes_.begin();
  for (std::size_t row = 0; row < cloud_.size(); ++row) changes_.touch(row);
  return {};
}

void Optimiser::forget_moments(std::span<const std::uint32_t> rows) {
  for (const std::uint32_t row : rows) {
    if (device_) {
      device_->forget(row);
    } else {
      adam_.reset_row(row);
    }
    if (switches_.enabled()) switches_.forget_moments(row);
  }
}

void Optimiser::reset_statistics() {
  std::fill(statistics_.begin(), statistics_.end(), RowStatistics{});
}

void Optimiser::size_pictures(const TrainingView& view) {
  const std::size_t pixels = view.colour.size() / 3;
  pictures_.colour.resize(3 * pixels);
  pictures_.seen.resize(view.exposure_key ? 3 * pixels : 0);
  pictures_.by_colour.resize(3 * pixels);
  pictures_.depth_sum_m.resize(pixels);
  pictures_.alpha.resize(pixels);
  const bool with_depth = !view.depth_m.empty() && options_.depth_factor > 0.0F;
  pictures_.by_depth_sum.resize(with_depth ? pixels : 0);
  pictures_.by_alpha.resize(with_depth || options_.gap_factor > 0.0F ? pixels : 0);
  if (!with_depth) std::ranges::fill(pictures_.by_alpha, 0.0F);  // the depth loss writes it whole
}

void Optimiser::compare(const TrainingView& view, StepReport& report) {
  Pictures& p = pictures_;
  if (view.exposure_key) apply(exposures_.of(*view.exposure_key), p.colour, p.seen);
  const train::ColourPair pair{view.view.width_px, view.view.height_px, view.exposure_key ? p.seen : p.colour,
                               view.colour, view.weight};
  const train::ColourLoss colour = train::colour_loss(pair, options_.ssim_share, p.by_colour);
  if (view.exposure_key) exposures_.learn(*view.exposure_key, p.colour, p.by_colour);
  report.l1 = colour.l1;
  report.loss = colour.value;
  if (!p.by_depth_sum.empty()) {
    report.depth_m =
        train::depth_loss({p.depth_sum_m, p.alpha, view.depth_m, view.weight}, options_.depth_factor,
                          options_.depth_min_alpha, p.by_depth_sum, p.by_alpha);
    report.loss += static_cast<double>(options_.depth_factor) * report.depth_m;
  }
  if (options_.gap_factor > 0.0F) {
    report.loss += static_cast<double>(options_.gap_factor) *
                   train::add_gap_loss(p.alpha, view.weight, options_.gap_factor, p.by_alpha);
  }
}

double Optimiser::regularise(const train::GradientBlock& block, std::size_t visible) const {
  using train::ParameterRow;
  if (options_.opacity_factor <= 0.0F && options_.scale_factor <= 0.0F) return 0.0;
  const std::size_t stride = ParameterRow::stride(options_.sh_degree);
  const float share = 1.0F / static_cast<float>(visible);
  double loss = 0.0;
  for (std::size_t i = 0; i < block.rows.size(); ++i) {
    const std::size_t row = block.rows[i];
    float* by = &block.values[i * stride];
    const float opacity = 1.0F / (1.0F + std::exp(-cloud_.opacity_logits[row]));
    by[ParameterRow::kOpacity] += options_.opacity_factor * share * opacity * (1.0F - opacity);
    loss += static_cast<double>(options_.opacity_factor * share * opacity);
    for (std::size_t k = 0; k < 3; ++k) {
      const float scale_m = std::exp(cloud_.log_scales[3 * row + k]);
      by[ParameterRow::kLogScale + k] += options_.scale_factor * share * scale_m / 3.0F;
      loss += static_cast<double>(options_.scale_factor * share * scale_m / 3.0F);
    }
  }
  return loss;
}

void Optimiser::move_rows(const splat::View& view, const train::BlendGradients& gradients,
                          StepReport& report) {
  changes_.begin();
  const float half_width_px = 0.5F * static_cast<float>(view.width_px);
  std::vector<double> losses(train::gradient_blocks(gradients.by_row.size()), 0.0);
  report.by_pose = train::gaussian_backward_in_blocks(
      splat::spans_of(cloud_), view, options_.render, gradients.by_row,
      [&](const train::GradientBlock& block) {
        losses[block.number] = regularise(block, gradients.seen);
        step_rows(block, gradients.seen, losses[block.number]);
        for (std::size_t i = 0; i < block.rows.size(); ++i) {
          changes_.touch(block.rows[i]);
          add_sighting(block.sightings[i], half_width_px, statistics_[block.rows[i]]);
        }
      });
  for (const double loss : losses) report.loss += loss;
  report.visible = gradients.seen;
}

void Optimiser::step_rows(const train::GradientBlock& block, std::size_t visible, double& loss) {
  if (!switches_.enabled()) {
    adam_.step(block.rows, block.values, options_.rates, cloud_);
    return;
  }
  loss += switches_.before_step(block, train::ParameterRow::stride(options_.sh_degree),
                                1.0F / static_cast<float>(visible), cloud_.opacity_logits);
  adam_.step(block.rows, block.values, options_.rates, cloud_);
  switches_.after_step(block, cloud_.opacity_logits);
}

Result<StepReport> Optimiser::step(const TrainingView& view) {
  if (!view.consistent())
    return fail(Errc::kInvalidArgument, "the training pictures do not have the view's size");
  if (device_) {
    auto report = step_on_gpu(view);
    if (report || report.error().code == Errc::kInvalidArgument) return report;
    give_up_gpu(report.error());
  }
  return step_on_cpu(view);
}

Result<StepReport> Optimiser::step_on_cpu(const TrainingView& view) {
  StepReport report;
  Stopwatch watch(*clock_);
  size_pictures(view);
  Pictures& p = pictures_;
  EDGESPLAT_TRY_STATUS(splat::render_cpu(splat::spans_of(cloud_), view.view, options_.render,
                                         {p.colour, p.depth_sum_m, p.alpha}, drawn_));
  report.times.forward = watch.lap();
  compare(view, report);
  report.times.loss = watch.lap();
  const auto gradients = train::blend_backward(drawn_.projected.splats, drawn_.tiles, view.view,
                                               {p.colour, p.depth_sum_m, p.alpha},
                                               {p.by_colour, p.by_depth_sum, p.by_alpha}, scratch_);
  report.times.backward = watch.lap();
  move_rows(view.view, gradients, report);
  report.times.update = watch.lap();
  return report;
}

}  // namespace edgesplat::mapping
