// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/image_measures.hpp"

#include "common/base/check.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::train {

double psnr_db(const ColourPair& pair) {
  constexpr double kEqual_db = 100.0;
  EDGESPLAT_CHECK(pair.consistent(), "two pictures of one size");
  const double total = 3.0 * pair.total_weight();
  if (!(total > 0.0)) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < pair.drawn.size(); ++i) {
    const double d = static_cast<double>(std::clamp(pair.drawn[i], 0.0F, 1.0F) - pair.target[i]);
    sum += (pair.weight.empty() ? 1.0 : static_cast<double>(pair.weight[i / 3])) * d * d;
  }
  const double error = sum / total;
  return error > 0.0 ? std::min(kEqual_db, -10.0 * std::log10(error)) : kEqual_db;
}

}  // namespace edgesplat::train
