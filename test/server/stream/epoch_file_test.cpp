// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/epoch_file.hpp"

#include "common/io/atomic_file.hpp"
#include "server/stream/map_uuid.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace edgesplat::stream {
namespace {

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

TEST(EpochFile, ALostFileDoesNotReuseAnEpochThatAMapKnows) {
  const test::TempDir folder;
  const auto path = folder.path() / "epoch";
  EXPECT_EQ(next_epoch(path, map::Epoch{7})->value, 8U);
  EXPECT_EQ(next_epoch(path, map::Epoch{7})->value, 9U);  // the file knows more
  EXPECT_EQ(next_epoch(path)->value, 10U);
}

}  // namespace
}  // namespace edgesplat::stream
