// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/common/io/file_size_limit.hpp"
#include "test/common/io/mcap_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

#include <fstream>

namespace edgesplat::io {
namespace {

using ::testing::HasSubstr;

/// Numbers 0..count-1 without a gap: what a recording cut short may still hold.
void expect_prefix(const std::vector<int>& sequence) {
  EXPECT_EQ(sequence, count_up_to(static_cast<int>(sequence.size())));
}

TEST(McapRecovery, KilledWriterLosesAtMostTheLastSecond) {
  const test::TempDir folder;
  const auto writer =
      start_sample(folder / "a.mcap", 1000, {});  // 10 s in one chunk's worth of bytes, not closed
  auto reader = McapReader::open(folder / "a.mcap");
  ASSERT_TRUE(reader);
  const auto sequence = read_sample(*reader);
  EXPECT_GE(sequence.size(), 900U);
  expect_prefix(sequence);
  EXPECT_FALSE(reader->report().complete);
  EXPECT_FALSE(reader->report().used_summary);
  EXPECT_THAT(reader->report().why, HasSubstr("was not closed"));
  EXPECT_THAT(reader->report().why, HasSubstr("kept " + std::to_string(sequence.size()) + " messages"));
}

TEST(McapRecovery, FlushBringsEverythingToTheFile) {
  const test::TempDir folder;
  auto writer = start_sample(folder / "a.mcap", 57, {});
  ASSERT_TRUE(writer.flush());
  auto reader = McapReader::open(folder / "a.mcap");
  ASSERT_TRUE(reader);
  EXPECT_EQ(read_sample(*reader), count_up_to(57));
}

TEST(McapRecovery, AnyTruncationKeepsAPrefix) {
  const test::TempDir folder;
  const auto whole = make_sample(folder / "a.mcap", 60, {.chunk_bytes = 600});
  std::size_t longest = 0;
  for (std::size_t length = 8; length < whole.size(); ++length) {
    auto reader = McapReader::from_bytes(std::span(whole).first(length));
    ASSERT_TRUE(reader) << length;
    const auto sequence = read_sample(*reader);
    expect_prefix(sequence);
    ASSERT_GE(sequence.size(), longest) << "a longer file gave less";
    longest = sequence.size();
    ASSERT_FALSE(reader->report().complete) << length;
    ASSERT_FALSE(reader->report().why.empty());
  }
  EXPECT_EQ(longest, 60U);  // cut within the summary, all messages are there
}

TEST(McapRecovery, SaysWhereARecordingIsCut) {
  const test::TempDir folder;
  auto whole = make_sample(folder / "a.mcap", 60, {.chunk_bytes = 600});
  whole.resize(whole.size() / 2);
  auto reader = McapReader::from_bytes(whole);
  ASSERT_TRUE(reader);
  const auto kept = read_sample(*reader).size();
  EXPECT_THAT(reader->report().why, HasSubstr("recording truncated at byte "));
  EXPECT_THAT(reader->report().why, HasSubstr("kept " + std::to_string(kept) + " messages"));
  EXPECT_GT(reader->report().bytes_skipped, 0U);
}

TEST(McapRecovery, DamagedChunkIsSkippedAndCounted) {
  const test::TempDir folder;
  for (const auto compression : {McapCompression::kNone, McapCompression::kLz4, McapCompression::kZstd}) {
    auto bytes = make_sample(folder / "a.mcap", 200, {.chunk_bytes = 2000, .compression = compression});
    bytes[300] ^= std::byte{0x10};  // within the first chunk's records
    for (const bool with_summary : {true, false}) {
      auto part = std::span<const std::byte>(bytes);
      auto reader = McapReader::from_bytes(with_summary ? part : part.first(part.size() - 8));
      ASSERT_TRUE(reader);
      const auto sequence = read_sample(*reader);
      EXPECT_EQ(reader->report().used_summary, with_summary);
      EXPECT_EQ(reader->report().chunks_skipped, 1U);
      EXPECT_FALSE(reader->report().complete);
      EXPECT_GT(sequence.size(), 100U);
      EXPECT_GT(sequence.front(), 0);
      EXPECT_EQ(sequence.back(), 199);  // later chunks define the channels they use
    }
  }
}

TEST(McapRecovery, DamagedLengthIsSteppedOver) {
  const test::TempDir folder;
  const auto whole = make_sample(folder / "a.mcap", 200, {.chunk_bytes = 2000});
  const std::size_t first_chunk = 8 + 9 + 4 + 4 + 4 + 9;  // magic; header record with "ros2", "edgesplat"
  ASSERT_EQ(whole[first_chunk], std::byte{6});
  for (std::size_t byte = first_chunk; byte < first_chunk + 9; ++byte) {
    auto damaged = whole;
    damaged[byte] ^= std::byte{0x41};
    damaged.resize(damaged.size() - 8);  // no summary to help
    auto reader = McapReader::from_bytes(damaged);
    ASSERT_TRUE(reader);
    const auto sequence = read_sample(*reader);
    ASSERT_GT(sequence.size(), 100U) << byte;
    EXPECT_EQ(sequence.back(), 199);
    EXPECT_GT(reader->report().bytes_skipped, 100U);
  }
}

TEST(McapRecovery, DamagedSummaryIsReplacedByAScan) {
  const test::TempDir folder;
  auto bytes = make_sample(folder / "a.mcap", 200, {.chunk_bytes = 2000});
  bytes[bytes.size() - 200] ^= std::byte{1};
  auto reader = McapReader::from_bytes(bytes);
  ASSERT_TRUE(reader);
  EXPECT_EQ(read_sample(*reader), count_up_to(200));
  EXPECT_FALSE(reader->report().used_summary);
  EXPECT_THAT(reader->report().why, HasSubstr("summary fails its checksum: kept 200 messages"));
  EXPECT_EQ(reader->statistics().message_count, 200U);
}

TEST(McapRecovery, FullDiskIsReportedOnceAndLeavesAReadableFile) {
  const test::TempDir folder;
  int failures = 0;
  {
    auto writer =
        McapWriter::create(folder / "a.mcap", {.chunk_bytes = 2000, .compression = McapCompression::kNone});
    ASSERT_TRUE(writer);
    const auto channel = writer->add_channel("/t", McapSchemaId{}).value();
    Status closed;
    {
      const FileSizeLimit limit(20'000);
      for (int i = 0; i < 1000; ++i) {
        const auto written = writer->write(channel, static_cast<std::uint32_t>(i),
                                           host_time_from_ns(i * std::int64_t{1'000'000}), SensorTime{},
                                           bytes_of(sample_payload(i)));
        if (written) continue;
        ++failures;
        EXPECT_EQ(written.error().code, Errc::kIo);
        EXPECT_THAT(written.error().context, HasSubstr("a.mcap: File too large"));
      }
      closed = writer->close();
    }
    EXPECT_FALSE(closed);
    EXPECT_EQ(writer->messages_dropped() + writer->statistics().message_count, 1000U);
  }
  EXPECT_EQ(failures, 1);
  auto reader = McapReader::open(folder / "a.mcap");
  ASSERT_TRUE(reader);
  const auto sequence = read_sample(*reader);
  EXPECT_GT(sequence.size(), 200U);
  expect_prefix(sequence);
}

TEST(McapRecovery, CloseAfterAFullDiskWritesTheSummaryWhereItFits) {
  const test::TempDir folder;
  {
    auto writer = start_sample(folder / "a.mcap", 300, {.chunk_bytes = 2000});
    const FileSizeLimit limit(writer.bytes_written() + 1);
    EXPECT_FALSE(writer.flush());
  }  // the limit is gone before the writer is: its destructor closes the file
  auto reader = McapReader::open(folder / "a.mcap");
  ASSERT_TRUE(reader);
  expect_prefix(read_sample(*reader));
}

}  // namespace
}  // namespace edgesplat::io
