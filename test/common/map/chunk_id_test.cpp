// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/chunk_id.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace edgesplat::map {
namespace {

TEST(ChunkId, CubesAreHalfOpenAlsoBelowZero) {
  EXPECT_EQ(chunk_of({0.0F, 9.999F, 10.0F}), (ChunkId{0, 0, 1}));
  EXPECT_EQ(chunk_of({-0.001F, -10.0F, -10.001F}), (ChunkId{-1, -1, -2}));
}

TEST(ChunkId, AGaussianKeepsItsBirthChunkUpToOneMetreOutside) {
  const ChunkId born{0, 0, 0};
  EXPECT_EQ(chunk_after_move(born, {10.99F, 5.0F, 5.0F}), born);
  EXPECT_EQ(chunk_after_move(born, {5.0F, -1.0F, 5.0F}), born);
  EXPECT_EQ(chunk_after_move(born, {11.0F, 5.0F, 5.0F}), (ChunkId{1, 0, 0}));
  EXPECT_EQ(chunk_after_move(born, {5.0F, -1.01F, 5.0F}), (ChunkId{0, -1, 0}));
  EXPECT_EQ(chunk_after_move(ChunkId{1, 0, 0}, {9.5F, 5.0F, 5.0F}),
            (ChunkId{1, 0, 0}));  // and back not at once
}

TEST(ChunkId, TheMapsLimitFits) {
  EXPECT_EQ(chunk_of({kMapLimit_m, -kMapLimit_m, 0.0F}), (ChunkId{100000, -100000, 0}));
}

}  // namespace
}  // namespace edgesplat::map
