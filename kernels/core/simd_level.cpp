// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/simd_level.hpp"

#include <hwy/targets.h>

namespace edgesplat::core {
namespace {

/// Before anybody limits them.
std::int64_t machine_targets() {
  static const std::int64_t targets = hwy::SupportedTargets();
  return targets;
}

SimdLevel level_of(std::int64_t targets) {
#if defined(__x86_64__)
  if ((targets & HWY_AVX3) != 0) return SimdLevel::kAvx512;
  if ((targets & HWY_AVX2) != 0) return SimdLevel::kAvx2;
#endif
  (void)targets;
  return SimdLevel::kBaseline;
}

}  // namespace

std::string_view to_string(SimdLevel level) {
  switch (level) {
    case SimdLevel::kAvx512:
      return "avx512";
    case SimdLevel::kAvx2:
      return "avx2";
    case SimdLevel::kBaseline:
      break;
  }
  return "baseline";
}

std::vector<SimdLevel> available_simd_levels() {
  const SimdLevel most = level_of(machine_targets());
  std::vector<SimdLevel> levels;
  for (const SimdLevel level : {SimdLevel::kBaseline, SimdLevel::kAvx2, SimdLevel::kAvx512}) {
    if (level <= most) levels.push_back(level);
  }
  return levels;
}

SimdLevel simd_level() {
  return level_of(hwy::SupportedTargets());
}

void limit_simd_level(SimdLevel most) {
  std::int64_t targets = machine_targets();
#if defined(__x86_64__)
  if (most < SimdLevel::kAvx512) targets &= ~std::int64_t{HWY_AVX3 | HWY_AVX3_DL};
  if (most < SimdLevel::kAvx2) targets &= ~std::int64_t{HWY_AVX2};
#endif
  (void)most;
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace edgesplat::core
