// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/delta_stream.hpp"

#include "common/io/atomic_file.hpp"
#include "common/map/delta_codec.hpp"
#include "server/stream/epoch_file.hpp"
#include "server/stream/map_uuid.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace edgesplat::stream {
namespace {

TEST(DeltaStream, NumbersDeltasWithoutGapsAndSplitsLargeChanges) {
  DeltaStream stream(map::RobotId{4}, make_map_uuid(), map::Epoch{7}, 100);
  std::uint64_t seq = 0;
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{100}, std::size_t{250}}) {
    const auto cloud = test::random_gaussians(count, count);
    const auto deltas = stream.add(cloud, std::vector<map::ChunkId>(count));
    ASSERT_TRUE(deltas.has_value());
    EXPECT_EQ(deltas->size(), (count + 99) / 100);
    std::size_t rows = 0;
    for (const auto& bytes : *deltas) {
      const auto delta = map::decode_add(bytes);
      ASSERT_TRUE(delta.has_value()) << delta.error().context;
      EXPECT_EQ(delta->header.base_seq, seq);
      EXPECT_EQ(delta->header.seq, ++seq);
      EXPECT_EQ(delta->header.epoch, map::Epoch{7});
      EXPECT_EQ(delta->header.robot, map::RobotId{4});
      EXPECT_EQ(delta->gaussians.ids[0], cloud.ids[rows]);
      rows += delta->gaussians.size();
    }
    EXPECT_EQ(rows, count);
  }
  EXPECT_EQ(stream.seq(), seq);
}

TEST(DeltaStream, AFailureUsesNoNumber) {
  DeltaStream stream(map::RobotId{4}, make_map_uuid(), map::Epoch{7}, 100);
  auto cloud = test::random_gaussians(10, 1);
  cloud.quats_xyzw.assign(40, 0.0F);
  EXPECT_FALSE(stream.add(cloud, std::vector<map::ChunkId>(10)).has_value());
  EXPECT_EQ(stream.seq(), 0U);
}

TEST(EpochFile, CountsStartsOverRestarts) {
  const test::TempDir folder;
  for (std::uint32_t start = 1; start <= 3; ++start) {
    const auto epoch = next_epoch(folder.path() / "epoch");
    ASSERT_TRUE(epoch.has_value());
    EXPECT_EQ(epoch->value, start);
  }
}

TEST(EpochFile, NeverStartsOverSilently) {
  const test::TempDir folder;
  const auto path = folder.path() / "epoch";
  for (const char* text : {"", "abc", "12x", "-1", "4294967295", "99999999999"}) {
    ASSERT_TRUE(io::write_file_atomically(path, std::string_view(text)).has_value());
    const auto epoch = next_epoch(path);
    ASSERT_FALSE(epoch.has_value()) << text;
    EXPECT_EQ(epoch.error().code, Errc::kCorrupt);
  }
}

TEST(EpochFile, SaysWhyItCannotBeWritten) {
  const auto epoch = next_epoch("/nonexistent-folder/epoch");
  ASSERT_FALSE(epoch.has_value());
  EXPECT_EQ(epoch.error().code, Errc::kIo);
}

TEST(MapUuid, IsOfVersionFourAndNeverTheSame) {
  const auto a = make_map_uuid();
  EXPECT_EQ(a.bytes[6] & std::byte{0xF0}, std::byte{0x40});
  EXPECT_EQ(a.bytes[8] & std::byte{0xC0}, std::byte{0x80});
  EXPECT_NE(a, make_map_uuid());
}

}  // namespace
}  // namespace edgesplat::stream
