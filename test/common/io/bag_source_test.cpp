// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/bag_source.hpp"

#include "common/io/mcap_writer.hpp"
#include "common/io/rosbag1.hpp"
#include "common/io/rosbag2_sqlite.hpp"
#include "test/common/io/bag_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>
#include <zstd.h>

#include <algorithm>
#include <random>

namespace edgesplat::io {
namespace {

std::string text_of(const BagMessage& message) {
  return {reinterpret_cast<const char*>(message.payload.data()), message.payload.size()};
}

struct Read {
  std::vector<std::string> texts;
  std::vector<std::string> topics;
  bool in_order = true;
};
Read read_all(BagSource& bag) {
  Read read;
  HostTime last = HostTime::min();
  while (const auto message = bag.next()) {
    read.in_order = read.in_order && message->time >= last;
    last = message->time;
    read.texts.push_back(text_of(*message));
    read.topics.push_back(bag.topics().at(message->topic).name);
  }
  return read;
}

/// What the messages of numbered_messages() must come out as.
std::vector<std::string> expected_texts(std::vector<SampleMessage> messages) {
  std::stable_sort(messages.begin(), messages.end(),
                   [](const SampleMessage& a, const SampleMessage& b) { return a.time_ns < b.time_ns; });
  std::vector<std::string> texts;
  for (const SampleMessage& m : messages)
    texts.emplace_back(reinterpret_cast<const char*>(m.payload.data()), m.payload.size());
  return texts;
}

class Rosbag1File : public ::testing::TestWithParam<BagCompression> {};
INSTANTIATE_TEST_SUITE_P(AllCompressions, Rosbag1File,
                         ::testing::Values(BagCompression::kNone, BagCompression::kBz2,
                                           BagCompression::kLz4));

TEST_P(Rosbag1File, IsReadInTimeOrderClosedOrNot) {
  const auto messages = numbered_messages(105);
  for (const bool closed : {true, false}) {
    const auto bytes = rosbag1_bytes(messages, GetParam(), 10, closed);
    auto bag = rosbag1_from_bytes(bytes);
    ASSERT_TRUE(bag) << bag.error().context;
    const Read read = read_all(**bag);
    EXPECT_TRUE(read.in_order);
    EXPECT_EQ(read.texts, expected_texts(messages)) << closed;
    EXPECT_TRUE((*bag)->report().complete) << (*bag)->report().why;
    EXPECT_EQ((*bag)->report().messages_read, 105U);
    EXPECT_EQ(to_ns((*bag)->begin()), messages[1].time_ns);
    EXPECT_EQ(to_ns((*bag)->end()), messages[104].time_ns);
    ASSERT_EQ((*bag)->topics().size(), 2U);
    EXPECT_EQ((*bag)->topics()[0].type, "test/Text");
    EXPECT_EQ((*bag)->topics()[0].encoding, RosEncoding::kRos1);
  }
}

TEST_P(Rosbag1File, GivesWhatIsSelectedAndStartsOver) {
  const auto bytes = rosbag1_bytes(numbered_messages(40), GetParam());
  auto bag = rosbag1_from_bytes(bytes);
  ASSERT_TRUE(bag) << bag.error().context;
  (void)(*bag)->next();
  (*bag)->select({1});
  const Read read = read_all(**bag);
  EXPECT_EQ(read.topics, std::vector<std::string>(20, "/odd"));
  (*bag)->select({});
  EXPECT_FALSE((*bag)->next());
}

TEST_P(Rosbag1File, TruncatedGivesWhatIsWhole) {
  const auto messages = numbered_messages(100);
  const auto bytes = rosbag1_bytes(messages, GetParam());
  std::size_t before = 0;
  for (std::size_t length = 0; length < bytes.size(); length += 211) {
    auto bag = rosbag1_from_bytes(std::span(bytes).first(length));
    if (!bag) {
      EXPECT_LT(length, 13U + 4096U);
      continue;
    }
    const Read read = read_all(**bag);
    EXPECT_TRUE(read.in_order);
    EXPECT_GE(read.texts.size(), before);
    before = read.texts.size();
    EXPECT_EQ((*bag)->report().complete, (*bag)->report().why.empty());
  }
  EXPECT_EQ(before, 100U);  // only the index is cut at last
}

TEST_P(Rosbag1File, FlippedBitsNeverMakeUpAnOrderOrGoUnnoticedInStructure) {
  const auto bytes = rosbag1_bytes(numbered_messages(60), GetParam());
  std::mt19937 random(5);
  for (int round = 0; round < 2000; ++round) {
    auto broken = bytes;
    for (int flips = 0; flips < 3; ++flips) {
      std::size_t at = random() % broken.size();
      if (at >= 100 && at < 4109) at = 4109 + at % 1000;  // the padding of the header says nothing
      broken[at] ^= static_cast<std::byte>(1U << random() % 8);
    }
    auto bag = rosbag1_from_bytes(broken);
    if (!bag) continue;
    EXPECT_TRUE(read_all(**bag).in_order);
    EXPECT_EQ((*bag)->report().complete, (*bag)->report().why.empty());
  }
}

TEST(Rosbag1, AbsurdLengthsCostNothing) {
  auto bytes = rosbag1_bytes(numbered_messages(10), BagCompression::kBz2, 10, false);
  // "size=" of the only chunk: 4 GiB are stated, some hundred bytes come out.
  constexpr std::string_view kSize = "size=";
  const auto at = std::search(bytes.begin(), bytes.end(), reinterpret_cast<const std::byte*>(kSize.data()),
                              reinterpret_cast<const std::byte*>(kSize.data()) + kSize.size());
  ASSERT_NE(at, bytes.end());
  std::fill_n(at + 5, 4, std::byte{0xFF});
  auto bag = rosbag1_from_bytes(bytes);
  ASSERT_TRUE(bag) << bag.error().context;
  EXPECT_FALSE((*bag)->next());
  EXPECT_NE((*bag)->report().why.find("too large"), std::string::npos) << (*bag)->report().why;
  *(at + 8) = std::byte{0x0F};  // under the limit: bz2 must find that less comes out
  bag = rosbag1_from_bytes(bytes);
  ASSERT_TRUE(bag);
  EXPECT_FALSE((*bag)->next());
  EXPECT_FALSE((*bag)->report().complete);
}

TEST(Rosbag1, SaysWhatItCannotRead) {
  const std::string old = "#ROSBAG V1.2\n";
  const auto bag = rosbag1_from_bytes(std::as_bytes(std::span(old.data(), old.size())));
  ASSERT_FALSE(bag);
  EXPECT_NE(bag.error().context.find("rosbag fix"), std::string::npos);
  EXPECT_FALSE(rosbag1_from_bytes({}));
}

class Rosbag2Sqlite : public ::testing::Test {
 protected:
  std::vector<SampleMessage> messages_ = numbered_messages(300);
  test::TempDir folder_;
};

TEST_F(Rosbag2Sqlite, IsReadInTimeOrder) {
  write_rosbag2_sqlite(folder_ / "a.db3", messages_);
  auto bag = open_bag(folder_ / "a.db3");
  ASSERT_TRUE(bag) << bag.error().context;
  EXPECT_EQ((*bag)->topics().at(0).type, "test/Text");
  EXPECT_EQ((*bag)->topics().at(0).encoding, RosEncoding::kCdr);
  const Read read = read_all(**bag);
  EXPECT_TRUE(read.in_order);
  EXPECT_EQ(read.texts, expected_texts(messages_));
  EXPECT_EQ(to_ns((*bag)->begin()), messages_[1].time_ns);
  (*bag)->select({1});
  EXPECT_EQ(read_all(**bag).topics, std::vector<std::string>(150, "/odd"));
}

std::vector<std::byte> zstd_of(std::span<const std::byte> plain) {
  std::vector<std::byte> out(ZSTD_compressBound(plain.size()));
  out.resize(ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), 3));
  return out;
}

std::vector<std::byte> file_bytes(const std::filesystem::path& path) {
  std::vector<std::byte> bytes(std::filesystem::file_size(path));
  FILE* file = std::fopen(path.c_str(), "rb");
  EXPECT_EQ(std::fread(bytes.data(), 1, bytes.size(), file), bytes.size());
  std::fclose(file);
  return bytes;
}

TEST_F(Rosbag2Sqlite, CompressedAsAWholeOrMessageByMessage) {
  write_rosbag2_sqlite(folder_ / "plain.db3", messages_);
  const auto packed = zstd_of(file_bytes(folder_ / "plain.db3"));
  auto whole = open_bag(folder_.write("whole.db3.zstd", packed));
  ASSERT_TRUE(whole) << whole.error().context;
  EXPECT_EQ(read_all(**whole).texts, expected_texts(messages_));
  const auto cut = open_bag(folder_.write("cut.db3.zstd", std::span(packed).first(packed.size() / 2)));
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, Errc::kCorrupt);

  auto compressed = messages_;
  for (SampleMessage& message : compressed) message.payload = zstd_of(message.payload);
  compressed[7].payload.resize(compressed[7].payload.size() - 3);
  write_rosbag2_sqlite(folder_ / "messages.db3", compressed);
  auto bag = open_bag(folder_ / "messages.db3");
  ASSERT_TRUE(bag) << bag.error().context;
  EXPECT_EQ(read_all(**bag).texts.size(), 299U);
  EXPECT_FALSE((*bag)->report().complete);
}

TEST_F(Rosbag2Sqlite, DamageIsToldAndNeverFatal) {
  write_rosbag2_sqlite(folder_ / "a.db3", messages_);
  const auto bytes = file_bytes(folder_ / "a.db3");
  std::mt19937 random(6);
  for (int round = 0; round < 300; ++round) {
    auto broken = bytes;
    if (round % 3 == 0) broken.resize(random() % broken.size());
    for (int flips = 0; flips < 20 && !broken.empty(); ++flips)
      broken[random() % broken.size()] ^= static_cast<std::byte>(1U << random() % 8);
    auto bag = rosbag2_sqlite_from_bytes(broken);
    if (!bag) continue;
    std::size_t count = 0;
    while (count < 10'000 && (*bag)->next()) ++count;
    EXPECT_LT(count, 10'000U);
    EXPECT_EQ((*bag)->report().complete, (*bag)->report().why.empty());
  }
}

TEST_F(Rosbag2Sqlite, AViewInPlaceOfATableIsRefused) {
  sqlite3* db = nullptr;
  sqlite3_open((folder_ / "view.db3").c_str(), &db);
  sqlite3_exec(
      db,
      "CREATE TABLE topics(id,name,type,serialization_format);CREATE VIEW messages AS WITH RECURSIVE n(id) "
      "AS "
      "(SELECT 1 UNION ALL SELECT id+1 FROM n) SELECT id,1 AS topic_id,id AS timestamp,'' AS data FROM n",
      nullptr, nullptr, nullptr);
  sqlite3_close(db);
  const auto bag = open_bag(folder_ / "view.db3");
  ASSERT_FALSE(bag);
  EXPECT_EQ(bag.error().code, Errc::kCorrupt);
}

TEST(BagSource, AFolderOfFilesIsOneRecording) {
  const test::TempDir folder;
  const auto messages = numbered_messages(90);
  const std::vector<SampleMessage> first(messages.begin(), messages.begin() + 50);
  const std::vector<SampleMessage> second(messages.begin() + 50, messages.end());
  // Named against their order in time; /odd goes back 15 ms, so that they overlap.
  folder.write("bag/z.bag", rosbag1_bytes(first, BagCompression::kLz4));
  folder.write("bag/a.bag", rosbag1_bytes(second, BagCompression::kNone));
  folder.write("bag/metadata.yaml", std::string_view("rosbag2_bagfile_information:"));
  auto bag = open_bag(folder / "bag");
  ASSERT_TRUE(bag) << bag.error().context;
  EXPECT_EQ((*bag)->topics().size(), 2U);
  const Read read = read_all(**bag);
  EXPECT_TRUE(read.in_order);
  EXPECT_EQ(read.texts.size(), 90U);
  EXPECT_EQ((*bag)->report().messages_read, 90U);
  (*bag)->select({0});
  EXPECT_EQ(read_all(**bag).texts.size(), 45U);
}

TEST(BagSource, ReadsTheRosTopicsOfAnMcap) {
  const test::TempDir folder;
  auto writer = McapWriter::create(folder / "a.mcap");
  ASSERT_TRUE(writer) << writer.error().context;
  const auto schema = writer->add_schema("sensor_msgs/msg/Imu", "ros2msg", "").value();
  const auto cdr = writer->add_channel("/imu", schema, "cdr", {}).value();
  const auto json = writer->add_channel("/json", schema, "json", {}).value();
  const std::vector<std::byte> payload(5, std::byte{1});
  for (int i = 0; i < 6; ++i)
    ASSERT_TRUE(
        writer->write(i % 2 == 0 ? cdr : json, 0, host_time_from_ns(i + 1), sensor_time_from_ns(i), payload));
  ASSERT_TRUE(writer->close());
  auto bag = open_bag(folder / "a.mcap");
  ASSERT_TRUE(bag) << bag.error().context;
  ASSERT_EQ((*bag)->topics().size(), 1U);
  EXPECT_EQ((*bag)->topics()[0].type, "sensor_msgs/Imu");
  EXPECT_EQ(read_all(**bag).texts.size(), 3U);
}

TEST(BagSource, SaysWhatItExpects) {
  const test::TempDir folder;
  EXPECT_EQ(open_bag(folder / "none.bag").error().code, Errc::kNotFound);
  EXPECT_EQ(open_bag(folder.write("a.txt", std::string_view("x"))).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(open_bag(folder.write("a.db3", std::string_view("no database"))).error().code, Errc::kCorrupt);
  EXPECT_EQ(open_bag(folder.write("a.bag", std::string_view("no bag at all"))).error().code, Errc::kCorrupt);
  EXPECT_FALSE(is_bag(folder / "a.txt"));
  EXPECT_TRUE(is_bag(folder.path()));
}

}  // namespace
}  // namespace edgesplat::io
