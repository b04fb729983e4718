// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"
#include "test/common/io/mcap_samples.hpp"
#include "test/common/io/peer.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

namespace edgesplat::io {
namespace {

using ::testing::ElementsAre;

class McapPeer : public ::testing::TestWithParam<std::pair<McapCompression, const char*>> {
 protected:
  test::TempDir folder_;
};
INSTANTIATE_TEST_SUITE_P(AllCompressions, McapPeer,
                         ::testing::Values(std::pair{McapCompression::kNone, "NONE"},
                                           std::pair{McapCompression::kLz4, "LZ4"},
                                           std::pair{McapCompression::kZstd, "ZSTD"}));

TEST_P(McapPeer, ItsReadersReadOurMessages) {
  (void)make_sample(folder_ / "ours.mcap", 300, {.chunk_bytes = 2000, .compression = GetParam().first});
  for (const char* reader : {"SeekingReader", "NonSeekingReader"}) {
    EDGESPLAT_PEER(lines, "mcap_read", folder_ / "ours.mcap", reader);
    ASSERT_EQ(lines.size(), 300U) << reader;
    for (int i = 1; i < 300; ++i) {  // message 0 has a negative stamp, which others see as a huge one
      const auto time_ns = std::int64_t{i} * 10'000'000;
      ASSERT_EQ(lines[static_cast<std::size_t>(i)],
                std::string(i % 2 == 0 ? "/even" : "/odd") + " test/msg/Text cdr " + std::to_string(i) + " " +
                    std::to_string(time_ns) + " " + std::to_string(time_ns - 5) + " " + sample_payload(i));
    }
  }
}

TEST_P(McapPeer, WeReadWhatItsWriterWrote) {
  EDGESPLAT_PEER(lines, "mcap_write", folder_ / "theirs.mcap", GetParam().second);
  auto reader = McapReader::open(folder_ / "theirs.mcap");
  ASSERT_TRUE(reader) << reader.error().context;
  EXPECT_EQ(read_sample(*reader), count_up_to(500));
  EXPECT_TRUE(reader->report().complete) << reader->report().why;
  EXPECT_TRUE(reader->report().used_summary);
  EXPECT_EQ(reader->find_channel("/odd")->metadata.at("side"), "left");
  const auto rig = reader->attachment("rig.toml");
  ASSERT_TRUE(rig) << rig.error().context;
  EXPECT_TRUE(std::ranges::equal(rig->content, bytes_of("name = 'peer'")));
  EXPECT_EQ(to_ns(rig->log_time), 6);
  EXPECT_EQ(reader->metadata().value().front().entries.at("robot"), "r2");
}

TEST_P(McapPeer, WeRecoverItsTruncatedFile) {
  EDGESPLAT_PEER(lines, "mcap_write", folder_ / "theirs.mcap", GetParam().second);
  auto bytes = read_file(folder_ / "theirs.mcap", 1U << 20U).value();
  bytes.resize(bytes.size() / 3);
  auto reader = McapReader::from_bytes(bytes);
  ASSERT_TRUE(reader);
  const auto sequence = read_sample(*reader);
  EXPECT_GT(sequence.size(), 50U);
  EXPECT_EQ(sequence, count_up_to(static_cast<int>(sequence.size())));
}

TEST(McapPeerAbout, ItSeesSummaryAttachmentsAndMetadata) {
  const test::TempDir folder;
  auto writer = start_sample(folder / "ours.mcap", 300, {.chunk_bytes = 2000});
  ASSERT_TRUE(
      writer.add_attachment("rig.toml", "application/toml", bytes_of("name = 'x'"), host_time_from_ns(7)));
  ASSERT_TRUE(writer.add_metadata("run", {{"robot", "r1"}, {"seed", "7"}}));
  ASSERT_TRUE(writer.close());
  EDGESPLAT_PEER(lines, "mcap_about", folder / "ours.mcap");
  EXPECT_THAT(lines, ElementsAre("ros2 300 1 2 True 0 2990000000", "rig.toml application/toml 7 name = 'x'",
                                 "run [('robot', 'r1'), ('seed', '7')]"));
}

TEST(McapPeerAbout, ItReadsTheRecoveredPartOfAKilledRecording) {
  const test::TempDir folder;
  const auto writer = start_sample(folder / "ours.mcap", 300, {});  // not closed
  auto reader = McapReader::open(folder / "ours.mcap");
  ASSERT_TRUE(reader);
  auto copy = McapWriter::create(folder / "copy.mcap");
  ASSERT_TRUE(copy);
  const auto channel = copy->add_channel("/all", copy->add_schema("a", "ros2msg", "").value()).value();
  std::size_t count = 0;
  for (; const auto message = reader->next(); ++count) {
    ASSERT_TRUE(copy->write(channel, message->sequence, message->log_time, SensorTime{}, message->payload));
  }
  ASSERT_TRUE(copy->close());
  EDGESPLAT_PEER(lines, "mcap_read", folder / "copy.mcap", "NonSeekingReader");
  EXPECT_EQ(lines.size(), count);
  EXPECT_GE(count, 200U);
}

template <typename Message>
void add_message(McapWriter& writer, std::string_view topic, const RosSchema& schema,
                 const Message& message) {
  const auto id = writer.add_schema(schema.name, kRosSchemaEncoding, schema.text).value();
  const auto channel = writer.add_channel(topic, id).value();
  ASSERT_TRUE(writer.write(channel, 0, HostTime{}, SensorTime{}, encode(message)));
}

TEST(McapPeerRos, ItDecodesOurMessagesByTheirSchemas) {
  const test::TempDir folder;
  auto writer = McapWriter::create(folder / "ours.mcap");
  ASSERT_TRUE(writer);
  const auto stamp = sensor_time_from_ns(3'000'000'007);
  const auto bytes = bytes_of("abc");
  add_message(*writer, kLidarPointsTopic, kRawDatagramSchema, RawDatagram{bytes});
  add_message(*writer, kCameraMetaTopic, kFrameMetaSchema,
              FrameMeta{stamp, 42, 0.25F, 1.5F, sensor::StampSource::kGps});
  add_message(*writer, kCameraImageTopic, kCompressedImageSchema,
              CompressedImage{stamp, "camera", "jpeg", bytes});
  PoseStamped pose{host_time_from_ns(5'000'000'009), "world", {}};
  pose.frame_from_body.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  pose.frame_from_body.translation_m = {1.0, -2.0, 3.25};
  add_message(*writer, kTruthBodyPoseTopic, kPoseStampedSchema, pose);
  ASSERT_TRUE(writer->close());
  EDGESPLAT_PEER(lines, "ros2_read", folder / "ours.mcap");
  EXPECT_THAT(lines, ElementsAre("edgesplat_msgs/msg/RawDatagram 616263",
                                 "edgesplat_msgs/msg/FrameMeta 3 7 42 0.25 1.5 2",
                                 "sensor_msgs/msg/CompressedImage 3 7 camera jpeg 616263",
                                 "geometry_msgs/msg/PoseStamped 5 9 world 1.0 -2.0 3.25 -0.5 0.5 -0.5 0.5"));
}

}  // namespace
}  // namespace edgesplat::io
