// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/adam.hpp"

#include "common/base/check.hpp"
#include "kernels/core/simd.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/train/adam.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#ifndef EDGESPLAT_KERNELS_TRAIN_ADAM_ONCE
#define EDGESPLAT_KERNELS_TRAIN_ADAM_ONCE
namespace edgesplat::train {

/// One Gaussian; rows of `stride` floats.
struct RowStep {
  const float* gradient;
  const float* rates;
  float* first;
  float* second;
  float* values;
  std::size_t stride;
  float beta1, beta2, epsilon;
  float first_correction, second_correction;
};

}  // namespace edgesplat::train
#endif

HWY_BEFORE_NAMESPACE();
namespace edgesplat::train::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// True where every new value is finite.
bool step_row(const RowStep& s) {
  const hn::CappedTag<float, ParameterRow::kLanes> d;
  using V = hn::Vec<decltype(d)>;
  const V beta1 = hn::Set(d, s.beta1), rest1 = hn::Set(d, 1.0F - s.beta1);
  const V beta2 = hn::Set(d, s.beta2), rest2 = hn::Set(d, 1.0F - s.beta2);
  const V correct1 = hn::Set(d, s.first_correction), correct2 = hn::Set(d, s.second_correction);
  const V epsilon = hn::Set(d, s.epsilon);
  V apart = hn::Zero(d);  // x - x is 0 for every finite x and for nothing else
  for (std::size_t i = 0; i < s.stride; i += hn::Lanes(d)) {
    const V g = hn::LoadU(d, s.gradient + i);
    const V m = hn::MulAdd(rest1, g, hn::Mul(beta1, hn::LoadU(d, s.first + i)));
    const V v = hn::MulAdd(hn::Mul(rest2, g), g, hn::Mul(beta2, hn::LoadU(d, s.second + i)));
    hn::StoreU(m, d, s.first + i);
    hn::StoreU(v, d, s.second + i);
    const V root = hn::MulAdd(hn::Sqrt(v), correct2, epsilon);
    const V by = hn::Div(hn::Mul(hn::LoadU(d, s.rates + i), hn::Mul(m, correct1)), root);
    const V value = hn::Sub(hn::LoadU(d, s.values + i), by);
    apart = hn::Add(apart, hn::Sub(value, value));
    hn::StoreU(value, d, s.values + i);
  }
  return hn::AllTrue(d, hn::Eq(apart, hn::Zero(d)));
}

}  // namespace edgesplat::train::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgesplat::train {
namespace {

HWY_EXPORT(step_row);

using gaussian::GaussianCloud;

constexpr std::uint16_t kMostSteps = std::numeric_limits<std::uint16_t>::max();

void load_row(const GaussianCloud& cloud, std::size_t row, float* out) {
  std::copy_n(&cloud.means_m[3 * row], 3, out + ParameterRow::kMean);
  std::copy_n(&cloud.log_scales[3 * row], 3, out + ParameterRow::kLogScale);
  std::copy_n(&cloud.quats_xyzw[4 * row], 4, out + ParameterRow::kQuat);
  out[ParameterRow::kOpacity] = cloud.opacity_logits[row];
  const std::size_t floats = cloud.sh_floats_each();
  std::copy_n(&cloud.sh[floats * row], floats, out + ParameterRow::kSh);
}

void store_row(const float* values, std::size_t row, GaussianCloud& cloud) {
  std::copy_n(values + ParameterRow::kMean, 3, &cloud.means_m[3 * row]);
  std::copy_n(values + ParameterRow::kLogScale, 3, &cloud.log_scales[3 * row]);
  const float* q = values + ParameterRow::kQuat;
  const float norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (std::size_t k = 0; k < 4; ++k) cloud.quats_xyzw[4 * row + k] = q[k] / norm;
  cloud.opacity_logits[row] = values[ParameterRow::kOpacity];
  const std::size_t floats = cloud.sh_floats_each();
  std::copy_n(values + ParameterRow::kSh, floats, &cloud.sh[floats * row]);
}

void fill_rates(const LearningRates& rates, int sh_degree, float* out) {
  std::fill_n(out, ParameterRow::kMaxStride, 0.0F);
  std::fill_n(out + ParameterRow::kMean, 3, rates.mean_m);
  std::fill_n(out + ParameterRow::kLogScale, 3, rates.log_scale);
  std::fill_n(out + ParameterRow::kQuat, 4, rates.quat);
  out[ParameterRow::kOpacity] = rates.opacity_logit;
  std::fill_n(out + ParameterRow::kSh, ParameterRow::sh_floats(sh_degree), rates.sh_rest);
  std::fill_n(out + ParameterRow::kSh, 3, rates.sh_base);
}

/// Entry t is right for the t-th step, entry 0 unused. All settle and stay.
std::vector<std::array<float, 3>> steps_table(const AdamOptions& options) {
  std::vector<std::array<float, 3>> table{{1.0F, 1.0F, 1.0F}};
  const auto final_share = static_cast<double>(options.mean_final_share);
  double power1 = 1.0, power2 = 1.0, decay = 1.0;
  while (table.size() < kMostSteps) {
    power1 *= static_cast<double>(options.beta1);
    power2 *= static_cast<double>(options.beta2);
    table.push_back({static_cast<float>(1.0 / (1.0 - power1)),
                     static_cast<float>(1.0 / std::sqrt(1.0 - power2)),
                     static_cast<float>(final_share + (1.0 - final_share) * decay)});
    decay *= std::exp(-1.0 / static_cast<double>(options.mean_decay_steps));
    if (power1 < 1e-8 && power2 < 1e-8 && decay < 1e-8) break;
  }
  return table;
}

}  // namespace

Adam::Adam(int sh_degree, const AdamOptions& options)
    : sh_degree_(sh_degree),
      options_(options),
      stride_(ParameterRow::stride(sh_degree)),
      by_steps_(steps_table(options)) {}

void Adam::resize(std::size_t rows) {
  first_.resize(rows * stride_, 0.0F);
  second_.resize(rows * stride_, 0.0F);
  steps_.resize(rows, 0);
}

void Adam::keep_rows(std::span<const std::uint32_t> rows) {
  for (std::size_t to = 0; to < rows.size(); ++to) {
    const std::size_t from = rows[to];
    if (from == to) continue;
    std::copy_n(&first_[from * stride_], stride_, &first_[to * stride_]);
    std::copy_n(&second_[from * stride_], stride_, &second_[to * stride_]);
    steps_[to] = steps_[from];
  }
  resize(rows.size());
}

void Adam::raise_sh_degree(int sh_degree) {
  EDGESPLAT_CHECK(sh_degree >= sh_degree_, "a higher degree");
  const std::size_t before = stride_, kept = ParameterRow::size(sh_degree_);
  sh_degree_ = sh_degree;
  stride_ = ParameterRow::stride(sh_degree);
  for (std::vector<float>* moments : {&first_, &second_}) {
    std::vector<float> wider(size() * stride_, 0.0F);
    for (std::size_t row = 0; row < size(); ++row)
      std::copy_n(&(*moments)[row * before], kept, &wider[row * stride_]);
    *moments = std::move(wider);
  }
}

void Adam::reset_row(std::size_t row) {
  std::fill_n(&first_[row * stride_], stride_, 0.0F);
  std::fill_n(&second_[row * stride_], stride_, 0.0F);
  steps_[row] = 0;
}

void Adam::step(std::span<const std::uint32_t> rows, std::span<const float> values,
                const LearningRates& rates, GaussianCloud& cloud) {
  EDGESPLAT_CHECK(
      cloud.size() == size() && cloud.sh_degree == sh_degree_ && values.size() == rows.size() * stride_,
      "gradients and cloud of this optimiser");
  constexpr std::size_t kAhead = 4;  // rows are seldom neighbours
  float row_rates[ParameterRow::kMaxStride];
  fill_rates(rates, sh_degree_, row_rates);
  float row_values[ParameterRow::kMaxStride] = {};
  const auto step_row = HWY_DYNAMIC_DISPATCH(step_row);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t row = rows[i];
    const std::size_t ahead = rows[std::min(i + kAhead, rows.size() - 1)];
    for (std::size_t k = 0; k < stride_; k += ParameterRow::kLanes) {
      __builtin_prefetch(&first_[ahead * stride_ + k], 1);
      __builtin_prefetch(&second_[ahead * stride_ + k], 1);
    }
    if (steps_[row] < kMostSteps) ++steps_[row];
    const auto& at_step = by_steps_[std::min<std::size_t>(steps_[row], by_steps_.size() - 1)];
    std::fill_n(row_rates + ParameterRow::kMean, 3, rates.mean_m * at_step[2]);
    load_row(cloud, row, row_values);
    if (step_row({&values[i * stride_], row_rates, &first_[row * stride_], &second_[row * stride_],
                  row_values, stride_, options_.beta1, options_.beta2, options_.epsilon, at_step[0],
                  at_step[1]})) {
      store_row(row_values, row, cloud);
    }
  }
}

std::size_t Adam::bytes() const {
  return (first_.capacity() + second_.capacity()) * sizeof(float) + steps_.capacity() * sizeof(std::uint16_t);
}

}  // namespace edgesplat::train
#endif
