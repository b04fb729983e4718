// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_recover.hpp"

#include "common/io/mcap_chunk_reader.hpp"
#include "test/common/io/mcap_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

#include <fstream>

namespace edgesplat::io {
namespace {

using ::testing::HasSubstr;

void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// A recovered file is like one that its writer closed: every chunk has its message indexes, and each of them
/// leads to a message of its channel and time.
void expect_whole(const std::filesystem::path& path, const std::vector<int>& sequence) {
  auto reader = McapReader::open(path);
  ASSERT_TRUE(reader) << reader.error().context;
  EXPECT_TRUE(reader->report().complete) << reader->report().why;
  EXPECT_TRUE(reader->report().used_summary);
  EXPECT_EQ(reader->statistics().message_count, sequence.size());
  EXPECT_EQ(read_sample(*reader), sequence);
}

TEST(McapRecover, AnyTruncationBecomesAWholeFileWithEverythingThatWasReadable) {
  const test::TempDir folder;
  const auto whole = make_sample(folder / "a.mcap", 20, {.chunk_bytes = 600});
  constexpr std::size_t kStep = 5;  // each cut is brought to the disk, which takes its time
  for (std::size_t length = 8; length < whole.size(); length += kStep) {
    const auto cut = std::span(whole).first(length);
    auto before = McapReader::from_bytes(cut);
    ASSERT_TRUE(before) << length;
    const auto readable = read_sample(*before);
    write_file(folder / "cut.mcap", cut);
    const auto recovery = recover_mcap(folder / "cut.mcap");
    if (readable.empty()) {
      ASSERT_FALSE(recovery.has_value()) << length;
      EXPECT_EQ(recovery.error().code, Errc::kCorrupt);
      continue;
    }
    ASSERT_TRUE(recovery) << length << " " << recovery.error().context;
    EXPECT_FALSE(recovery->was_whole);
    EXPECT_FALSE(recovery->why.empty());
    EXPECT_EQ(recovery->statistics.message_count, readable.size());
    expect_whole(folder / "cut.mcap", readable);
    if (HasFatalFailure()) FAIL() << length;
  }
}

TEST(McapRecover, ARecoveredFileEqualsOneThatWasClosed) {
  const test::TempDir folder;
  // Closed after 57 messages, and cut right before its end, without the last chunk's message indexes.
  const auto closed = make_sample(folder / "closed.mcap", 57, {.chunk_bytes = 600});
  std::size_t last_chunk_end = 0;
  {
    const auto source = make_byte_source(closed);
    const auto index = mcap::index_by_scanning(*source);
    last_chunk_end = index.chunks.back().offset + index.chunks.back().length;
  }
  for (const std::size_t more : {0U, 5U, 40U}) {
    write_file(folder / "cut.mcap", std::span(closed).first(last_chunk_end + more));
    ASSERT_TRUE(recover_mcap(folder / "cut.mcap"));
    const auto recovered = read_file(folder / "cut.mcap", 1U << 30U);
    ASSERT_TRUE(recovered);
    EXPECT_TRUE(*recovered == closed) << more << " bytes of its indexes were left";
  }
}

TEST(McapRecover, AWholeFileIsLeftAlone) {
  const test::TempDir folder;
  const auto whole = make_sample(folder / "a.mcap", 60);
  const auto recovery = recover_mcap(folder / "a.mcap");
  ASSERT_TRUE(recovery);
  EXPECT_TRUE(recovery->was_whole);
  EXPECT_EQ(recovery->statistics.message_count, 60U);
  EXPECT_TRUE(*read_file(folder / "a.mcap", 1U << 30U) == whole);
}

TEST(McapRecover, KeepsAttachmentsAndSkipsADamagedChunk) {
  const test::TempDir folder;
  auto writer = start_sample(folder / "a.mcap", 60, {.chunk_bytes = 600});
  ASSERT_TRUE(writer.add_attachment("rig.toml", "application/toml", bytes_of("name = 'a'")));
  ASSERT_TRUE(writer.close());
  auto bytes = read_file(folder / "a.mcap", 1U << 30U).value();
  const auto source = make_byte_source(bytes);
  const auto index = mcap::index_by_scanning(*source);
  bytes[index.chunks[3].offset + 80] ^= std::byte{1};
  bytes.resize(bytes.size() - 30);  // no footer
  write_file(folder / "cut.mcap", bytes);
  const auto recovery = recover_mcap(folder / "cut.mcap");
  ASSERT_TRUE(recovery) << recovery.error().context;
  EXPECT_EQ(recovery->chunks_skipped, 1U);
  auto reader = McapReader::open(folder / "cut.mcap");
  ASSERT_TRUE(reader);
  EXPECT_TRUE(reader->report().used_summary);
  EXPECT_EQ(reader->statistics().chunk_count, index.chunks.size() - 1);
  EXPECT_TRUE(std::ranges::equal(reader->attachment("rig.toml")->content, bytes_of("name = 'a'")));
}

TEST(McapRecover, SaysWhatItCannotRecover) {
  const test::TempDir folder;
  EXPECT_EQ(recover_mcap(folder / "none.mcap").error().code, Errc::kNotFound);
  write_file(folder / "text.mcap", bytes_of("this is a text, not a recording"));
  EXPECT_EQ(recover_mcap(folder / "text.mcap").error().code, Errc::kCorrupt);
  const auto writer = start_sample(folder / "open.mcap", 300, {.chunk_bytes = 600});
  const auto open = recover_mcap(folder / "open.mcap");
  ASSERT_FALSE(open.has_value());
  EXPECT_EQ(open.error().code, Errc::kUnavailable);
  EXPECT_THAT(open.error().context, HasSubstr("is being written"));
}

}  // namespace
}  // namespace edgesplat::io
