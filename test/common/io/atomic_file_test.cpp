// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/atomic_file.hpp"

#include "test/common/io/file_size_limit.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iterator>

namespace edgesplat::io {
namespace {

using ::testing::HasSubstr;

std::size_t count_entries(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator entries(folder);
  return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
}

TEST(AtomicFile, WritesAndReadsBack) {
  const test::TempDir folder;
  ASSERT_TRUE(write_file_atomically(folder / "a.txt", "first"));
  ASSERT_TRUE(write_file_atomically(folder / "a.txt", "second"));
  EXPECT_EQ(read_text_file(folder / "a.txt", 100).value(), "second");
  EXPECT_EQ(count_entries(folder.path()), 1U);
}

TEST(AtomicFile, EmptyFileIsAFile) {
  const test::TempDir folder;
  ASSERT_TRUE(write_file_atomically(folder / "empty", ""));
  EXPECT_TRUE(read_file(folder / "empty", 0).value().empty());
}

TEST(AtomicFile, WithoutCommitTheOldFileStays) {
  const test::TempDir folder;
  ASSERT_TRUE(write_file_atomically(folder / "a.txt", "old"));
  {
    auto file = AtomicFile::create(folder / "a.txt");
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->append(std::as_bytes(std::span("half", 4))));
  }
  EXPECT_EQ(read_text_file(folder / "a.txt", 100).value(), "old");
  EXPECT_EQ(count_entries(folder.path()), 1U);
}

TEST(AtomicFile, FullDiskNamesPathAndReasonAndLeavesNothing) {
  const test::TempDir folder;
  const std::string text(10'000, 'x');
  Status status;
  {
    const FileSizeLimit limit(4096);
    status = write_file_atomically(folder / "big", text);
  }
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Errc::kIo);
  EXPECT_THAT(status.error().context, HasSubstr("big"));
  EXPECT_THAT(status.error().context, HasSubstr("File too large"));
  EXPECT_EQ(count_entries(folder.path()), 0U);
}

TEST(AtomicFile, MissingFolderIsAnError) {
  const test::TempDir folder;
  const auto status = write_file_atomically(folder / "no/such/file", "x");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Errc::kIo);
  EXPECT_THAT(status.error().context, HasSubstr("No such file or directory"));
}

TEST(ReadFile, RefusesWhatIsMissingTooLargeOrAFolder) {
  const test::TempDir folder;
  EXPECT_EQ(read_file(folder / "none", 10).error().code, Errc::kNotFound);
  EXPECT_EQ(read_file(folder.path(), 10).error().code, Errc::kIo);
  ASSERT_TRUE(write_file_atomically(folder / "eleven", "12345678901"));
  EXPECT_EQ(read_file(folder / "eleven", 10).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(read_file(folder / "eleven", 11).value().size(), 11U);
}

TEST(ReadFile, ReadsFilesThatStateNoSize) {
  const auto status = read_text_file("/proc/self/status", 1'000'000);
  ASSERT_TRUE(status);
  EXPECT_THAT(*status, HasSubstr("Name:"));
}

}  // namespace
}  // namespace edgesplat::io
