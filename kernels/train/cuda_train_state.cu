// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/cuda_train_state.cuh"

#include "kernels/train/blend_backward_math.hpp"

#include <algorithm>

namespace edgesplat::train {

CudaTrainStep::State::State(core::VramPool& pool, const AdamOptions& options, bool in_order)
    : cloud(pool),
      pass(pool, in_order),
      pictures(pool, "pictures"),
      target_colour(pool, "the picture to reach"),
      target_depth_m(pool, "the depth to reach"),
      target_weight(pool, "the pixels' weights"),
      slot_sums(pool, "sums by tile and splat"),
      sums(pool, "sums by splat"),
      rows(pool, "gradients"),
      sightings(pool, "gradients"),
      parts(pool, "partial sums"),
      scalars(pool, "sums"),
      splat_of_row(pool, "gradients"),
      shown(pool, "sums"),
      first(pool, "Adam's moments"),
      second(pool, "Adam's moments"),
      moving(pool, "rows on the move"),
      steps(pool, "Adam's steps"),
      from_rows(pool, "rows on the move"),
      decay(adam_decay(options)) {}

Status CudaTrainStep::State::size_pictures(const splat::DeviceView& view, const TrainTarget& target,
                                           const TrainSettings& settings) {
  const std::size_t pixels = view.pixels();
  const bool with_depth = !target.depth_m.empty() && settings.depth_factor > 0.0F;
  EDGESPLAT_TRY_STATUS(pictures.reserve(22 * pixels));
  EDGESPLAT_TRY_STATUS(scalars.reserve(kStepScalars));
  EDGESPLAT_TRY_STATUS(shown.reserve(1));
  float* next = pictures.data();
  const auto take = [&next, pixels](std::size_t planes) {
    float* const first_plane = next;
    next += planes * pixels;
    return first_plane;
  };
  loss = {};
  loss.width_px = view.width_px;
  loss.height_px = view.height_px;
  loss.drawn = {take(3), take(1), take(1)};
  loss.by_colour = take(3);
  float* const by_depth_sum = take(1);
  float* const by_alpha = take(1);
  loss.by_depth_sum = with_depth ? by_depth_sum : nullptr;
  loss.by_alpha = with_depth || settings.gap_factor > 0.0F ? by_alpha : nullptr;
  loss.slopes = take(9);
  float* const seen = take(3);
  loss.exposed = target.exposure.has_value();
  loss.seen = loss.exposed ? seen : loss.drawn.colour;
  for (std::size_t c = 0; loss.exposed && c < 3; ++c) {
    loss.gain[c] = (*target.exposure)[c];
    loss.offset[c] = (*target.exposure)[3 + c];
  }
  loss.factors = {settings.ssim_share, settings.depth_factor, settings.depth_min_alpha, settings.gap_factor};
  loss.scalars = scalars.data();
  return {};
}

Status CudaTrainStep::State::upload_target(const core::Stream& stream, const TrainTarget& target) {
  EDGESPLAT_TRY_STATUS(core::upload(stream, target.colour, target_colour));
  loss.target = target_colour.data();
  if (!target.weight.empty()) {
    EDGESPLAT_TRY_STATUS(core::upload(stream, target.weight, target_weight));
    loss.weight = target_weight.data();
  }
  if (loss.by_depth_sum != nullptr) {
    EDGESPLAT_TRY_STATUS(core::upload(stream, target.depth_m, target_depth_m));
    loss.target_m = target_depth_m.data();
  }
  return {};
}

Status CudaTrainStep::State::size_reverse() {
  const splat::FrameRoom& room = pass.frame().room;
  reverse = {};
  reverse.frame = pass.frame();
  reverse.stride = ParameterRow::stride(cloud.sh_degree());
  const std::size_t pose_parts = 6 * pose_parts_of(room.visible);
  // Dense Adam has as many parts as the cloud has runs of 16 rows.
  const std::size_t most_parts = std::max({loss_parts(loss.width_px, loss.height_px), pose_parts,
                                           (std::max(cloud.size(), room.visible) + 15) / 16});
  if (pass.frame().keeps_slots) EDGESPLAT_TRY_STATUS(slot_sums.reserve(room.pairs * kSumStride));
  EDGESPLAT_TRY_STATUS(sums.reserve(room.visible * kSumStride));
  EDGESPLAT_TRY_STATUS(rows.reserve(room.visible * reverse.stride));
  EDGESPLAT_TRY_STATUS(sightings.reserve(room.visible));
  EDGESPLAT_TRY_STATUS(parts.reserve(most_parts));
  EDGESPLAT_TRY_STATUS(splat_of_row.reserve(cloud.size()));
  reverse.drawn = loss.drawn;
  reverse.by_picture = {loss.by_colour, loss.by_depth_sum, loss.by_alpha};
  reverse.slot_sums = slot_sums.data();
  reverse.sums = sums.data();
  reverse.rows = rows.data();
  reverse.sightings = sightings.data();
  reverse.pose_parts = parts.data();
  reverse.splat_of_row = splat_of_row.data();
  reverse.shown = shown.data();
  loss.parts = parts.data();
  return {};
}

Status CudaTrainStep::State::start_reverse(const core::Stream& stream) {
  EDGESPLAT_TRY_STATUS(blend_backward_on_device(stream, reverse));
  EDGESPLAT_TRY_STATUS(gaussian_backward_on_device(stream, reverse));
  return sum_parts(stream, reverse.pose_parts, pose_parts_of(reverse.frame.room.visible), 6,
                   scalars.data() + kByPose);
}

Status CudaTrainStep::State::move_moments(const core::Stream& stream, std::span<const std::uint32_t> from,
                                          std::size_t stride) {
  // Old rows ascend, so they lie at or behind their new place: run after run, none is overwritten before it
  // is read.
  constexpr std::size_t kRun = std::size_t{1} << 14U;
  const std::size_t old_rows = cloud.size();
  EDGESPLAT_TRY_STATUS(first.grow(stream, from.size() * stride, old_rows * stride));
  EDGESPLAT_TRY_STATUS(second.grow(stream, from.size() * stride, old_rows * stride));
  EDGESPLAT_TRY_STATUS(steps.grow(stream, from.size(), old_rows));
  EDGESPLAT_TRY_STATUS(moving.reserve(kRun * stride));
  EDGESPLAT_TRY_STATUS(core::upload(stream, from, from_rows));
  const auto move = [&](void* of, std::size_t words) -> Status {
    auto* const rows_of = static_cast<std::uint32_t*>(of);
    for (std::size_t begin = 0; begin < from.size(); begin += kRun) {
      const std::size_t count = std::min(kRun, from.size() - begin);
      EDGESPLAT_TRY_STATUS(
          gather_rows(stream, {rows_of, from_rows.data() + begin, moving.data(), count, words}));
      EDGESPLAT_CUDA_TRY(cudaMemcpyAsync(rows_of + begin * words, moving.data(),
                                         count * words * sizeof(std::uint32_t), cudaMemcpyDeviceToDevice,
                                         stream.get()));
    }
    return {};
  };
  EDGESPLAT_TRY_STATUS(move(first.data(), stride));
  EDGESPLAT_TRY_STATUS(move(second.data(), stride));
  return move(steps.data(), 1);
}

AdamOnDevice CudaTrainStep::State::adam_of(const TrainSettings& settings) {
  AdamOnDevice adam{};
  adam.reverse = reverse;
  adam.decay = decay;
  adam.rates = settings.rates;
  adam.first = first.data();
  adam.second = second.data();
  adam.steps = steps.data();
  adam.regular_parts = reverse.pose_parts;
  adam.opacity_factor = settings.opacity_factor;
  adam.scale_factor = settings.scale_factor;
  adam.dense = settings.dense;
  return adam;
}

Status CudaTrainStep::State::start(const core::Stream& stream, const splat::DeviceView& view,
                                   const TrainSettings& settings) {
  EDGESPLAT_TRY_STATUS(pass.start(stream, cloud, view, loss.drawn));
  EDGESPLAT_TRY_STATUS(size_reverse());
  EDGESPLAT_TRY_STATUS(compare_on_device(stream, loss));
  EDGESPLAT_TRY_STATUS(start_reverse(stream));
  const AdamOnDevice adam = adam_of(settings);
  EDGESPLAT_TRY_STATUS(adam_on_device(stream, adam));
  return sum_parts(stream, adam.regular_parts, regular_parts_of(adam), 1, scalars.data() + kRegular);
}

}  // namespace edgesplat::train
