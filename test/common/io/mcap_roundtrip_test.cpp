// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/common/io/mcap_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

#include <random>

namespace edgesplat::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class McapRoundTrip : public ::testing::TestWithParam<McapCompression> {
 protected:
  test::TempDir folder_;
};
INSTANTIATE_TEST_SUITE_P(AllCompressions, McapRoundTrip,
                         ::testing::Values(McapCompression::kNone, McapCompression::kLz4,
                                           McapCompression::kZstd));

TEST_P(McapRoundTrip, GivesBackEveryMessage) {
  (void)make_sample(folder_ / "a.mcap", 1000, {.chunk_bytes = 4096, .compression = GetParam()});
  auto reader = McapReader::open(folder_ / "a.mcap");
  ASSERT_TRUE(reader) << reader.error().context;
  EXPECT_EQ(read_sample(*reader), count_up_to(1000));
  EXPECT_TRUE(reader->report().complete);
  EXPECT_TRUE(reader->report().used_summary);
  EXPECT_EQ(reader->statistics().message_count, 1000U);
  EXPECT_GT(reader->statistics().chunk_count, 5U);
  EXPECT_EQ(reader->statistics().first_log_time, HostTime{});
  EXPECT_EQ(to_ns(reader->statistics().last_log_time), 9'990'000'000);
}

TEST_P(McapRoundTrip, LargeMessageGetsAChunkOfItsOwn) {
  auto writer = McapWriter::create(folder_ / "a.mcap", {.chunk_bytes = 100, .compression = GetParam()});
  ASSERT_TRUE(writer);
  const auto channel = writer->add_channel("/big", McapSchemaId{}).value();
  const std::vector<std::byte> zeros(5'000'000);  // compresses far beyond the plausible ratio
  ASSERT_TRUE(writer->write(channel, 1, HostTime{}, SensorTime{}, zeros));
  ASSERT_TRUE(writer->write(channel, 2, HostTime{}, SensorTime{}, {}));
  ASSERT_TRUE(writer->close());
  auto reader = McapReader::open(folder_ / "a.mcap");
  ASSERT_TRUE(reader);
  const auto first = reader->next();
  ASSERT_TRUE(first);
  EXPECT_TRUE(std::ranges::equal(first->payload, zeros));
  const auto second = reader->next();
  ASSERT_TRUE(second);
  EXPECT_TRUE(second->payload.empty());
  EXPECT_FALSE(reader->next());
}

TEST(Mcap, KeepsChannelsSchemasAndStamps) {
  const test::TempDir folder;
  (void)make_sample(folder / "a.mcap", 2);
  auto reader = McapReader::open(folder / "a.mcap");
  ASSERT_TRUE(reader);
  const auto* even = reader->find_channel("/even");
  ASSERT_NE(even, nullptr);
  EXPECT_EQ(even->message_encoding, "cdr");
  EXPECT_EQ(even->metadata.at("side"), "left");
  EXPECT_EQ(reader->schemas().at(even->schema_id).text, "string text\n");
  EXPECT_EQ(reader->schemas().size(), 1U);
  EXPECT_EQ(reader->find_channel("/none"), nullptr);
  const auto first = reader->next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->channel->topic, "/even");
  EXPECT_EQ(to_ns(first->publish_time), -5);  // negative stamps survive
  EXPECT_EQ(to_ns(reader->next()->publish_time), 9'999'995);
}

TEST(Mcap, AttachmentsAndMetadata) {
  const test::TempDir folder;
  auto writer = start_sample(folder / "a.mcap", 10, {});
  ASSERT_TRUE(writer.add_attachment("rig.toml", "application/toml", bytes_of("name = 'x'")));
  ASSERT_TRUE(writer.add_metadata("run", {{"robot", "r1"}, {"seed", "7"}}));
  ASSERT_TRUE(writer.close());
  auto reader = McapReader::open(folder / "a.mcap");
  ASSERT_TRUE(reader);
  EXPECT_THAT(reader->attachment_names(), ElementsAre("rig.toml"));
  const auto rig = reader->attachment("rig.toml");
  ASSERT_TRUE(rig);
  EXPECT_TRUE(std::ranges::equal(rig->content, bytes_of("name = 'x'")));
  EXPECT_EQ(rig->media_type, "application/toml");
  EXPECT_EQ(reader->attachment("other").error().code, Errc::kNotFound);
  const auto metadata = reader->metadata();
  ASSERT_TRUE(metadata);
  ASSERT_EQ(metadata->size(), 1U);
  EXPECT_EQ(metadata->front().entries.at("seed"), "7");
  EXPECT_EQ(read_sample(*reader), count_up_to(10));
}

TEST(Mcap, SelectsTopicsAndTimes) {
  const test::TempDir folder;
  (void)make_sample(folder / "a.mcap", 200, {.chunk_bytes = 1000});
  auto reader = McapReader::open(folder / "a.mcap");
  ASSERT_TRUE(reader);
  reader->select(
      {.topics = {"/odd"}, .from = host_time_from_ns(500'000'000), .until = host_time_from_ns(550'000'000)});
  EXPECT_THAT(read_sample(*reader), ElementsAre(51, 53));
  reader->select({.topics = {"/none"}});
  EXPECT_TRUE(read_sample(*reader).empty());
  reader->select({});
  EXPECT_EQ(read_sample(*reader), count_up_to(200));
}

TEST(Mcap, EmptyRecordingIsComplete) {
  const test::TempDir folder;
  (void)make_sample(folder / "a.mcap", 0);
  auto reader = McapReader::open(folder / "a.mcap");
  ASSERT_TRUE(reader);
  EXPECT_FALSE(reader->next());
  EXPECT_TRUE(reader->report().complete);
  EXPECT_EQ(reader->channels().size(), 2U);
}

TEST(Mcap, SortsMessagesAcrossOverlappingChunks) {
  const test::TempDir folder;
  auto writer = McapWriter::create(folder / "a.mcap", {.chunk_bytes = 3000});
  ASSERT_TRUE(writer);
  const auto channel = writer->add_channel("/t", McapSchemaId{}).value();
  std::mt19937 random(7);
  std::uniform_int_distribution<int> jitter(0, 900);
  std::vector<std::pair<std::int64_t, int>> expected;
  for (int i = 0; i < 3000; ++i) {
    const std::int64_t time_ns = (i + jitter(random)) * std::int64_t{1'000'000};
    expected.emplace_back(time_ns, i);
    ASSERT_TRUE(writer->write(channel, static_cast<std::uint32_t>(i), host_time_from_ns(time_ns),
                              SensorTime{}, bytes_of(sample_payload(i))));
  }
  ASSERT_TRUE(writer->close());
  std::ranges::sort(expected);  // equal times in the order of the file
  auto reader = McapReader::open(folder / "a.mcap");
  ASSERT_TRUE(reader);
  const auto sequence = read_sample(*reader);
  ASSERT_EQ(sequence.size(), expected.size());
  for (std::size_t i = 0; i < sequence.size(); ++i) ASSERT_EQ(sequence[i], expected[i].second) << i;
}

TEST(Mcap, MoreOverlappingChunksThanMayBeOpenComeInOrder) {
  // 30 chunks of 4 MiB that all cover the same time: more than the reader may hold open.
  const test::TempDir folder;
  auto writer = McapWriter::create(folder / "a.mcap", {.chunk_bytes = 1U << 22U});
  ASSERT_TRUE(writer);
  const auto channel = writer->add_channel("/t", McapSchemaId{}).value();
  const std::vector<std::byte> megabyte(1U << 20U);
  for (std::uint32_t i = 0; i < 120; ++i) {
    const std::int64_t time_ns = (i % 4) * 1000 + i / 4;
    ASSERT_TRUE(writer->write(channel, i, host_time_from_ns(time_ns), SensorTime{}, megabyte));
  }
  ASSERT_TRUE(writer->close());
  auto reader = McapReader::open(folder / "a.mcap");
  ASSERT_TRUE(reader);
  HostTime last{};
  int count = 0;
  while (const auto message = reader->next()) {
    ASSERT_GE(message->log_time, last);
    ASSERT_EQ(message->payload.size(), megabyte.size());
    last = message->log_time;
    ++count;
  }
  EXPECT_EQ(count, 120);
}

TEST(McapWriter, RefusesWhatMcapCannotHold) {
  const test::TempDir folder;
  auto writer = McapWriter::create(folder / "a.mcap");
  ASSERT_TRUE(writer);
  EXPECT_FALSE(writer->add_channel("/t", McapSchemaId{3}));
  const auto channel = writer->add_channel("/t", McapSchemaId{}).value();
  EXPECT_EQ(writer->write(McapChannelId{9}, 0, HostTime{}, SensorTime{}, {}).error().code,
            Errc::kInvalidArgument);
  EXPECT_EQ(writer->write(channel, 0, host_time_from_ns(-1), SensorTime{}, {}).error().code,
            Errc::kInvalidArgument);
  ASSERT_TRUE(writer->close());
  ASSERT_TRUE(writer->close());
  EXPECT_FALSE(writer->write(channel, 0, HostTime{}, SensorTime{}, {}));
  EXPECT_FALSE(McapWriter::create(folder / "b.mcap", {.chunk_bytes = 0}));
  EXPECT_THAT(McapWriter::create(folder / "no/b.mcap").error().context, HasSubstr("No such file"));
}

}  // namespace
}  // namespace edgesplat::io
