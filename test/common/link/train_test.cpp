// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/train.hpp"

#include "common/base/crc32c.hpp"
#include "common/link/transport.hpp"
#include "test/support/message_bytes.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

namespace edgesplat::link {
namespace {

using test::message_bytes;
using Outcome = TrainAssembler::Outcome;

struct Chunk {
  ChunkHeader header;
  std::vector<std::byte> payload;
};

std::vector<Chunk> cut(const std::vector<std::byte>& message, std::uint32_t train) {
  std::vector<Chunk> chunks;
  for (std::uint32_t i = 0; i < chunk_count(message.size()); ++i) {
    const auto part = chunk_at(message, i);
    chunks.push_back({{map::RobotId{1}, 7, train, i, chunk_count(message.size()),
                       static_cast<std::uint32_t>(message.size()), crc32c(message)},
                      {part.begin(), part.end()}});
  }
  return chunks;
}

HostTime at_s(double seconds) {
  return HostTime(from_seconds(seconds));
}

TEST(Train, CutsIntoPiecesThatCoverTheMessageOnce) {
  for (const std::size_t size :
       {std::size_t{1}, kChunk_bytes - 1, kChunk_bytes, kChunk_bytes + 1, 5 * kChunk_bytes}) {
    std::size_t covered = 0;
    for (const Chunk& chunk : cut(message_bytes(size), 1)) {
      EXPECT_LE(chunk.payload.size(), 64U * 1024U);
      EXPECT_TRUE(plausible(chunk.header, chunk.payload.size()));
      covered += chunk.payload.size();
    }
    EXPECT_EQ(covered, size);
  }
}

TEST(TrainAssembler, RebuildsShuffledInterleavedAndRepeatedTrains) {
  const auto first = message_bytes(5 * kChunk_bytes + 17, 1);
  const auto second = message_bytes(3 * kChunk_bytes, 2);
  auto chunks = cut(first, 1);
  for (auto& chunk : cut(second, 2)) chunks.push_back(chunk);
  std::mt19937 random(3);
  std::shuffle(chunks.begin(), chunks.end(), random);
  TrainAssembler assembler(AssemblerLimits{});
  std::vector<std::vector<std::byte>> complete;
  int duplicates = 0;
  for (const Chunk& chunk : chunks) {
    auto added = assembler.add(chunk.header, chunk.payload, HostTime{});
    if (added.outcome == Outcome::kComplete) {
      complete.push_back(std::move(added.message));
    } else {
      EXPECT_EQ(added.outcome, Outcome::kPart);
      duplicates +=
          assembler.add(chunk.header, chunk.payload, HostTime{}).outcome == Outcome::kDuplicate ? 1 : 0;
    }
  }
  EXPECT_THAT(complete, ::testing::UnorderedElementsAre(first, second));
  EXPECT_EQ(duplicates, static_cast<int>(chunks.size()) - 2);
  EXPECT_EQ(assembler.trains(), 0U);
  EXPECT_EQ(assembler.held_bytes(), 0U);
}

TEST(TrainAssembler, GivesUpATrainThatMissesAPieceAfterTheTimeout) {
  TrainAssembler assembler(AssemblerLimits{8, 1U << 20U, std::chrono::seconds(5)});
  const auto chunks = cut(message_bytes(3 * kChunk_bytes), 9);
  (void)assembler.add(chunks[0].header, chunks[0].payload, at_s(0));
  (void)assembler.add(chunks[2].header, chunks[2].payload, at_s(1));
  EXPECT_THAT(assembler.expire(at_s(5.9)), ::testing::IsEmpty());
  EXPECT_THAT(assembler.expire(at_s(6.0)), ::testing::ElementsAre(9U));
  EXPECT_EQ(assembler.held_bytes(), 0U);
}

TEST(TrainAssembler, HoldsNoMoreThanItsLimits) {
  TrainAssembler assembler(AssemblerLimits{4, 3 * kChunk_bytes, std::chrono::seconds(5)});
  std::vector<std::uint32_t> lost;
  for (std::uint32_t train = 1; train <= 100; ++train) {
    const auto chunks = cut(message_bytes(2 * kChunk_bytes, train), train);
    const auto added = assembler.add(chunks[0].header, chunks[0].payload, at_s(train));
    lost.insert(lost.end(), added.lost_trains.begin(), added.lost_trains.end());
    EXPECT_LE(assembler.held_bytes(), 3 * kChunk_bytes);
    EXPECT_LE(assembler.trains(), 4U);
  }
  EXPECT_EQ(lost.size() + assembler.trains(), 100U);
}

TEST(TrainAssembler, RefusesHeadersThatContradictThemselves) {
  const auto good = cut(message_bytes(2 * kChunk_bytes + 5), 1);
  const auto refused = [&](auto change) {
    ChunkHeader header = good[0].header;
    change(header);
    TrainAssembler assembler(AssemblerLimits{});
    const auto outcome = assembler.add(header, good[0].payload, HostTime{}).outcome;
    return outcome == Outcome::kCorrupt && assembler.held_bytes() == 0;
  };
  EXPECT_TRUE(refused([](ChunkHeader& h) { h.train = 0; }));
  EXPECT_TRUE(refused([](ChunkHeader& h) { h.index = 3; }));
  EXPECT_TRUE(refused([](ChunkHeader& h) { h.index = 2; }));  // the last piece is shorter
  EXPECT_TRUE(refused([](ChunkHeader& h) { h.count = 2; }));
  EXPECT_TRUE(refused([](ChunkHeader& h) { h.count = 0xFFFFFFFFU; }));
  EXPECT_TRUE(refused([](ChunkHeader& h) { h.total_bytes = 0; }));
  EXPECT_TRUE(refused([](ChunkHeader& h) { h.total_bytes = 0xFFFFFFFFU; }));
  EXPECT_TRUE(refused([](ChunkHeader& h) { h.total_bytes = kMaxMessage_bytes + 1; }));
}

TEST(TrainAssembler, RefusesAMessageWhoseBytesChanged) {
  auto chunks = cut(message_bytes(2 * kChunk_bytes), 1);
  chunks[1].payload[100] ^= std::byte{1};
  TrainAssembler assembler(AssemblerLimits{});
  (void)assembler.add(chunks[0].header, chunks[0].payload, HostTime{});
  EXPECT_EQ(assembler.add(chunks[1].header, chunks[1].payload, HostTime{}).outcome, Outcome::kCorrupt);
  EXPECT_EQ(assembler.trains(), 0U);
}

TEST(TrainAssembler, GivesUpATrainWhoseHeadersDisagree) {
  auto chunks = cut(message_bytes(2 * kChunk_bytes), 1);
  TrainAssembler assembler(AssemblerLimits{});
  (void)assembler.add(chunks[0].header, chunks[0].payload, HostTime{});
  chunks[1].header.message_crc32c ^= 1U;
  EXPECT_EQ(assembler.add(chunks[1].header, chunks[1].payload, HostTime{}).outcome, Outcome::kCorrupt);
  EXPECT_EQ(assembler.held_bytes(), 0U);
}

}  // namespace
}  // namespace edgesplat::link
