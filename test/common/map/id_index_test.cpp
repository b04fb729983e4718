// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/id_index.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <unordered_map>

namespace edgesplat::map {
namespace {

using gaussian::GaussianId;

TEST(IdIndex, EmptyFindsNothing) {
  IdIndex index;
  EXPECT_FALSE(index.find(GaussianId(1, 1)).has_value());
  index.erase(GaussianId(1, 1));
  EXPECT_EQ(index.size(), 0U);
}

TEST(IdIndex, DoesWhatAMapDoesOverManyRandomSteps) {
  test::Random random(1);
  IdIndex index;
  std::unordered_map<std::uint64_t, std::uint32_t> truth;
  for (std::uint32_t step = 0; step < 200000; ++step) {
    // Dense ids and few, so that chains of slots form and are cut again.
    const GaussianId id(static_cast<std::uint16_t>(random.below(2)), random.below(3000));
    if (random.below(5) < 2) {
      index.erase(id);
      truth.erase(id.packed());
    } else {
      index.set(id, step);
      truth[id.packed()] = step;
    }
    ASSERT_EQ(index.size(), truth.size());
    const GaussianId other(static_cast<std::uint16_t>(random.below(2)), random.below(3000));
    const auto expected = truth.find(other.packed());
    const auto found = index.find(other);
    ASSERT_EQ(found.has_value(), expected != truth.end());
    ASSERT_EQ(found.value_or(0), found ? expected->second : 0U);
  }
}

}  // namespace
}  // namespace edgesplat::map
