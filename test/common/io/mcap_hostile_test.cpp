// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"
#include "common/io/mcap_records.hpp"
#include "test/common/io/mcap_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>

namespace edgesplat::io {
namespace {

void read_everything(McapReader& reader) {
  while (reader.next()) {
  }
  for (const auto& name : reader.attachment_names()) (void)reader.attachment(name);
  (void)reader.metadata();
}

std::vector<std::byte> make_rich_sample(const test::TempDir& folder) {
  auto writer = start_sample(folder / "a.mcap", 40, {.chunk_bytes = 700});
  EXPECT_TRUE(writer.add_attachment("rig.toml", "application/toml", bytes_of("name = 'x'")));
  EXPECT_TRUE(writer.add_metadata("run", {{"robot", "r1"}}));
  EXPECT_TRUE(writer.close());
  return read_file(folder / "a.mcap", 1U << 20U).value();
}

TEST(McapHostile, NotMcapIsAnError) {
  EXPECT_EQ(McapReader::from_bytes({}).error().code, Errc::kCorrupt);
  EXPECT_EQ(McapReader::from_bytes(bytes_of("#ROSBAG V2.0\n")).error().code, Errc::kCorrupt);
  EXPECT_EQ(McapReader::open("/nonexistent.mcap").error().code, Errc::kNotFound);
  EXPECT_EQ(McapReader::open("/").error().code, Errc::kIo);
}

TEST(McapHostile, AnySingleDamagedByteIsSurvived) {
  const test::TempDir folder;
  const auto whole = make_rich_sample(folder);
  for (std::size_t i = 8; i < whole.size(); ++i) {
    for (const auto flip : {std::byte{0x01}, std::byte{0x80}, std::byte{0xFF}}) {
      auto damaged = whole;
      damaged[i] ^= flip;
      auto reader = McapReader::from_bytes(damaged);
      ASSERT_TRUE(reader);
      read_everything(*reader);
      ASSERT_LE(reader->report().messages_read, 40U);
    }
  }
}

TEST(McapHostile, RandomDamageIsSurvived) {
  const test::TempDir folder;
  const auto whole = make_rich_sample(folder);
  std::mt19937 random(11);
  std::uniform_int_distribution<std::size_t> place(8, whole.size() - 1);
  std::uniform_int_distribution<int> value(0, 255);
  for (int round = 0; round < 3000; ++round) {
    auto damaged = whole;
    for (int i = 0; i < 8; ++i) damaged[place(random)] = static_cast<std::byte>(value(random));
    if (round % 3 == 0) damaged.resize(place(random));
    auto reader = McapReader::from_bytes(damaged);
    ASSERT_TRUE(reader);
    read_everything(*reader);
  }
}

/// A file of one chunk that states `uncompressed_bytes` and holds `compressed`.
std::vector<std::byte> chunk_file(std::string_view compression, std::uint64_t uncompressed_bytes,
                                  std::span<const std::byte> compressed) {
  ByteWriter file;
  file.write_bytes(mcap::kMagic);
  {
    const mcap::RecordScope record(file, mcap::Opcode::kChunk);
    file.write(std::uint64_t{0});
    file.write(std::uint64_t{0});
    file.write(uncompressed_bytes);
    file.write(std::uint32_t{0});
    mcap::write_string(file, compression);
    file.write(static_cast<std::uint64_t>(compressed.size()));
    file.write_bytes(compressed);
  }
  return file.take();
}

TEST(McapHostile, AbsurdLengthsTakeNoMemory) {
  const std::vector<std::byte> junk(64, std::byte{0x28});
  for (const std::string_view compression : {"", "lz4", "zstd", "brotli"}) {
    for (const std::uint64_t length : {kMaxMcapRecordBytes, kMaxMcapRecordBytes + 1, std::uint64_t{1} << 62U,
                                       std::numeric_limits<std::uint64_t>::max()}) {
      const auto file = chunk_file(compression, length, junk);
      auto reader = McapReader::from_bytes(file);
      ASSERT_TRUE(reader);
      read_everything(*reader);
      EXPECT_EQ(reader->report().chunks_skipped, 1U) << compression << " " << length;
      EXPECT_EQ(reader->report().messages_read, 0U);
    }
  }
}

TEST(McapHostile, RecordLongerThanTheFileIsATruncation) {
  ByteWriter file;
  file.write_bytes(mcap::kMagic);
  file.write(static_cast<std::uint8_t>(mcap::Opcode::kAttachment));
  file.write(std::numeric_limits<std::uint64_t>::max());
  auto reader = McapReader::from_bytes(file.bytes());
  ASSERT_TRUE(reader);
  EXPECT_THAT(reader->report().why, ::testing::HasSubstr("truncated at byte 8"));
}

TEST(McapHostile, MessagesWithoutAChannelAreCounted) {
  ByteWriter records;
  {
    const mcap::RecordScope record(records, mcap::Opcode::kMessage);
    for (int i = 0; i < 22; ++i) records.write(std::uint8_t{3});
  }
  const auto file = chunk_file("", records.size(), records.bytes());
  auto reader = McapReader::from_bytes(file);
  ASSERT_TRUE(reader);
  EXPECT_FALSE(reader->next());
  EXPECT_THAT(reader->report().why, ::testing::HasSubstr("1 messages belong to no known channel"));
}

TEST(McapHostile, RecordsOutsideChunksAreRead) {
  // Writers may leave chunks out altogether.
  ByteWriter file;
  file.write_bytes(mcap::kMagic);
  mcap::write_record(file, McapChannel{McapChannelId{5}, McapSchemaId{}, "/bare", "cdr", {}});
  for (std::uint32_t i = 0; i < 3; ++i) {
    const mcap::RecordScope record(file, mcap::Opcode::kMessage);
    file.write(std::uint16_t{5});
    file.write(2 - i);
    file.write(std::uint64_t{2 - i});  // backwards in time
    file.write(std::uint64_t{0});
    file.write_text(sample_payload(static_cast<int>(2 - i)));
  }
  auto reader = McapReader::from_bytes(file.bytes());
  ASSERT_TRUE(reader);
  EXPECT_EQ(read_sample(*reader), count_up_to(3));
}

}  // namespace
}  // namespace edgesplat::io
