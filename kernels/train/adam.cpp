// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/adam.hpp"

#include "common/base/check.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd_variants.hpp"
#include "kernels/splat/splat_one.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgesplat::train {
namespace {

using gaussian::GaussianCloud;

constexpr std::size_t kBlock = 1024;
constexpr std::uint16_t kMostSteps = std::numeric_limits<std::uint16_t>::max();

struct RowStep {
  const float* gradient;
  const float* rates;  ///< [stride]
  float* first;
  float* second;
  float* values;
  std::size_t stride;
  float beta1, beta2, epsilon;
  float first_correction, second_correction;
};

EDGESPLAT_INLINE void step_row_inline(const RowStep& s) {
  for (std::size_t base = 0; base < s.stride; base += ParameterRow::kLanes) {
    for (std::size_t k = 0; k < ParameterRow::kLanes; ++k) {
      const std::size_t i = base + k;
      const float g = s.gradient[i];
      const float m = s.beta1 * s.first[i] + (1.0F - s.beta1) * g;
      const float v = s.beta2 * s.second[i] + (1.0F - s.beta2) * g * g;
      s.first[i] = m;
      s.second[i] = v;
      const float root = std::sqrt(v) * s.second_correction;
      s.values[i] -= s.rates[i] * (m * s.first_correction) / (root + s.epsilon);
    }
  }
}

EDGESPLAT_SIMD_VARIANTS(step_row, (const RowStep& s), (s))

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

void Adam::reset_row(std::size_t row) {
  std::fill_n(&first_[row * stride_], stride_, 0.0F);
  std::fill_n(&second_[row * stride_], stride_, 0.0F);
  steps_[row] = 0;
}

void Adam::step(const GaussianGradients& gradients, const LearningRates& rates, GaussianCloud& cloud) {
  EDGESPLAT_CHECK(cloud.size() == size() && cloud.sh_degree == sh_degree_ && gradients.stride == stride_,
                  "gradients and cloud of this optimiser");
  float rate_row[ParameterRow::kMaxStride];
  fill_rates(rates, sh_degree_, rate_row);
  const auto step_row = fastest_step_row();
  const int used = static_cast<int>(ParameterRow::size(sh_degree_));
  const std::size_t blocks = (gradients.rows.size() + kBlock - 1) / kBlock;
  thread::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    const std::size_t last = std::min(gradients.rows.size(), (b + 1) * kBlock);
    float values[ParameterRow::kMaxStride] = {};
    float row_rates[ParameterRow::kMaxStride];
    std::copy_n(rate_row, ParameterRow::kMaxStride, row_rates);
    for (std::size_t i = b * kBlock; i < last; ++i) {
      const std::size_t row = gradients.rows[i];
      if (steps_[row] < kMostSteps) ++steps_[row];
      const auto& at_step = by_steps_[std::min<std::size_t>(steps_[row], by_steps_.size() - 1)];
      std::fill_n(row_rates + ParameterRow::kMean, 3, rates.mean_m * at_step[2]);
      load_row(cloud, row, values);
      step_row({gradients.row(i).data(), row_rates, &first_[row * stride_], &second_[row * stride_], values,
                stride_, options_.beta1, options_.beta2, options_.epsilon, at_step[0], at_step[1]});
      if (splat::all_finite(values, used)) store_row(values, row, cloud);
    }
  });
}

std::size_t Adam::bytes() const {
  return (first_.capacity() + second_.capacity()) * sizeof(float) + steps_.capacity() * sizeof(std::uint16_t);
}

}  // namespace edgesplat::train
