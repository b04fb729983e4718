// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// edgesplat-bench: Google Benchmark's options, and --simd LEVEL to leave out the widest vectors.
#include "kernels/core/simd_level.hpp"

#include <benchmark/benchmark.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace {

using edgesplat::core::SimdLevel;

bool limit_to(std::string_view name) {
  for (const SimdLevel level : edgesplat::core::available_simd_levels()) {
    if (to_string(level) != name) continue;
    edgesplat::core::limit_simd_level(level);
    return true;
  }
  std::fprintf(stderr, "edgesplat-bench: --simd %.*s: this processor has", static_cast<int>(name.size()),
               name.data());
  for (const SimdLevel level : edgesplat::core::available_simd_levels()) {
    const std::string_view available = to_string(level);
    std::fprintf(stderr, " %.*s", static_cast<int>(available.size()), available.data());
  }
  std::fprintf(stderr, "\n");
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<char*> rest;
  for (int i = 0; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--simd" && i + 1 < argc) {
      if (!limit_to(argv[++i])) return 2;
    } else {
      rest.push_back(argv[i]);
    }
  }
  int count = static_cast<int>(rest.size());
  benchmark::AddCustomContext("simd", std::string(to_string(edgesplat::core::simd_level())));
  benchmark::Initialize(&count, rest.data());
  if (benchmark::ReportUnrecognizedArguments(count, rest.data())) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
