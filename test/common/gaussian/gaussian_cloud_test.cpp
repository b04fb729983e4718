// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/gaussian/gaussian_cloud.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <unordered_set>

namespace edgesplat::gaussian {
namespace {

/// Every value of row i is different from every other value of the cloud.
GaussianCloud numbered(std::size_t count, int sh_degree, float first) {
  GaussianCloud cloud;
  cloud.sh_degree = sh_degree;
  cloud.resize(count);
  float next = first;
  for (auto* values :
       {&cloud.means_m, &cloud.log_scales, &cloud.quats_xyzw, &cloud.opacity_logits, &cloud.sh})
    for (float& value : *values) value = next++;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.ids[i] = GaussianId(1, i);
    cloud.anchors[i] = {static_cast<std::uint32_t>(i), 2};
  }
  return cloud;
}

TEST(GaussianId, PacksOriginAndCounter) {
  const GaussianId id(0xABCD, 0x123456789ABC);
  EXPECT_EQ(id.origin(), 0xABCD);
  EXPECT_EQ(id.counter(), 0x123456789ABCU);
  EXPECT_EQ(GaussianId::from_packed(id.packed()), id);
  EXPECT_EQ(GaussianId(1, std::uint64_t{1} << 48U).origin(), 1)
      << "a counter that overflows stays out of origin";
  const std::unordered_set<GaussianId> ids{id, id, GaussianId(1, 2)};
  EXPECT_EQ(ids.size(), 2U);
}

TEST(GaussianCloud, ResizeKeepsEveryArrayInStep) {
  for (int degree = 0; degree <= 3; ++degree) {
    GaussianCloud cloud;
    cloud.sh_degree = degree;
    EXPECT_TRUE(cloud.consistent());
    cloud.resize(5);
    EXPECT_TRUE(cloud.consistent());
    EXPECT_EQ(cloud.sh.size(), 5U * 3U * static_cast<std::size_t>((degree + 1) * (degree + 1)));
    cloud.resize(2);
    EXPECT_TRUE(cloud.consistent());
  }
}

TEST(GaussianCloud, ConsistentSeesEveryWrongLength) {
  const GaussianCloud good = numbered(3, 1, 0.0F);
  GaussianCloud bad = good;
  bad.sh.pop_back();
  EXPECT_FALSE(bad.consistent());
  bad = good;
  bad.means_m.push_back(0.0F);
  EXPECT_FALSE(bad.consistent());
  bad = good;
  bad.anchors.clear();
  EXPECT_FALSE(bad.consistent());
  bad = good;
  bad.sh_degree = 2;
  EXPECT_FALSE(bad.consistent());
  bad.sh_degree = -1;
  EXPECT_FALSE(bad.consistent());
}

TEST(GaussianCloud, AppendsAndCopiesWholeRows) {
  const GaussianCloud source = numbered(3, 1, 1000.0F);
  GaussianCloud cloud = numbered(2, 1, 0.0F);
  cloud.append_row(source, 2);
  ASSERT_TRUE(cloud.consistent());
  EXPECT_EQ(cloud.ids[2], source.ids[2]);
  EXPECT_EQ(cloud.means_m[6], source.means_m[6]);
  EXPECT_EQ(cloud.quats_xyzw[11], source.quats_xyzw[11]);
  EXPECT_EQ(cloud.sh[3 * 12 - 1], source.sh[3 * 12 - 1]);
  cloud.copy_row(2, 0);
  EXPECT_EQ(cloud.log_scales[1], source.log_scales[7]);
  EXPECT_EQ(cloud.opacity_logits[0], source.opacity_logits[2]);
  EXPECT_EQ(cloud.anchors[0], source.anchors[2]);
  EXPECT_EQ(cloud.sh[0], source.sh[24]);
  EXPECT_EQ(cloud.means_m[3], numbered(2, 1, 0.0F).means_m[3]) << "the row between is untouched";
}

TEST(GaussianCloudDeathTest, MixingDegreesOrRowsIsABug) {
  GaussianCloud cloud = numbered(2, 0, 0.0F);
  EXPECT_DEATH(cloud.append_row(numbered(1, 1, 0.0F), 0), "SH degree");
  EXPECT_DEATH(cloud.copy_row(2, 0), "row in range");
}

}  // namespace
}  // namespace edgesplat::gaussian
