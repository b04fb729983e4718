// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/backend.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace edgesplat::core {
namespace {

TEST(Backend, TheCpuIsAlwaysThereAndComesFirst) {
  const auto backends = available_backends();
  ASSERT_FALSE(backends.empty());
  EXPECT_EQ(backends.front(), Backend::kCpu);
  EXPECT_EQ(choose_backend("cpu").value(), Backend::kCpu);
  EXPECT_EQ(choose_backend("auto").value(), backends.back());
}

TEST(Backend, CudaIsChosenOrTheReasonIsSaid) {
  const auto backends = available_backends();
  const auto chosen = choose_backend("cuda");
  const bool there = std::find(backends.begin(), backends.end(), Backend::kCuda) != backends.end();
  EXPECT_EQ(chosen.has_value(), there);
  if (chosen) return;
  EXPECT_EQ(chosen.error().code, Errc::kUnavailable);
  EXPECT_FALSE(chosen.error().context.empty());
}

TEST(Backend, UnknownNamesAreConfigurationErrors) {
  ASSERT_FALSE(choose_backend("opencl"));
  EXPECT_EQ(choose_backend("opencl").error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace edgesplat::core
