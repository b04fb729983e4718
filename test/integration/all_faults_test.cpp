// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Everything that a bad network does, at once: a map that changes comes down while keyframes go up, in
// virtual time, over the same link code as over DDS.
#include "common/map/keyframe_codec.hpp"
#include "server/stream/byte_allowance.hpp"
#include "server/stream/delta_stream.hpp"
#include "server/stream/map_uuid.hpp"
#include "test/common/link/simulated_link.hpp"
#include "test/integration/changing_map.hpp"
#include "test/integration/virtual_robot.hpp"

#include <map>
#include <string>

namespace edgesplat {
namespace {

using link::Lane;
using link::LaneCounters;
using link::SimulatedLink;

using Bytes = std::vector<std::byte>;

constexpr double kBytes_per_s = 125e3;  // 1 Mbit/s each way

link::LinkEndOptions bad_end(std::uint64_t seed) {
  link::LinkEndOptions options;
  options.send.messages = 64;
  options.send.bytes = 400'000;
  options.send.flight.trains = 16;
  options.send.flight.bytes = 200'000;
  options.impair.shape_at_s = {0.0};
  options.impair.shape_bytes_per_s = {kBytes_per_s};
  options.impair.delay_ms = 10;
  options.impair.loss = 0.05;
  options.impair.duplicate = 0.03;
  options.impair.reorder = 0.1;
  options.impair.flip_bits = 0.01;
  options.impair.seed = seed;
  return options;
}

/// The server's half: a map that changes by itself, told to one robot.
class ChangingServer {
 public:
  ChangingServer(link::LinkEnd& end, const Clock& clock, std::uint64_t seed)
      : end_(end), clock_(clock), map_(seed), allowance_(100e3, 1.0, clock.now()), stream_(config()) {}

  void step(bool changing) {
    while (const auto message = end_.receive(nanoseconds(0))) take(*message);
    const HostTime now = clock_.now();
    if (now >= next_publish_) {
      next_publish_ = now + std::chrono::milliseconds(100);
      publish(changing);
    }
    if (now >= next_heartbeat_) {
      next_heartbeat_ = now + std::chrono::milliseconds(200);
      send_heartbeat();
    }
  }
  [[nodiscard]] const stream::DeltaStream& stream() const { return stream_; }
  [[nodiscard]] const gaussian::GaussianCloud& cloud() const { return map_.cloud(); }
  [[nodiscard]] const std::map<std::uint64_t, std::uint64_t>& hash_at() const { return hash_at_; }
  [[nodiscard]] const std::map<std::uint32_t, Bytes>& keyframes() const { return keyframes_; }
  [[nodiscard]] std::size_t keyframes_twice() const { return keyframes_twice_; }

 private:
  static stream::DeltaStreamConfig config() {
    stream::DeltaStreamConfig config;
    config.robot = test::VirtualRobot::kRobot;
    config.map = stream::make_map_uuid();
    config.epoch.value = 1;
    return config;
  }
  void take(const link::Message& message) {
    if (message.lane == Lane::kRequest) {
      const auto request = map::decode_map_request(message.bytes);
      ASSERT_TRUE(request);
      if (request->kind != map::RequestKind::kResend || room() > 0)
        send(stream_.answer(*request, clock_.now()));
    } else if (message.lane == Lane::kKeyframe) {
      const auto keyframe = map::decode_keyframe(message.bytes);
      ASSERT_TRUE(keyframe) << keyframe.error().context;
      keyframes_twice_ += keyframes_.insert_or_assign(keyframe->id.value, message.bytes).second ? 0U : 1U;
    } else {
      const auto heartbeat = link::decode_heartbeat(message.bytes);
      ASSERT_TRUE(heartbeat);
      stream_.confirmed(heartbeat->epoch, heartbeat->seq);
    }
  }
  /// As of the server's program: nothing new while this much waits for the network.
  [[nodiscard]] std::size_t room() const {
    constexpr std::size_t kMost_bytes = 65536;
    return kMost_bytes - std::min(kMost_bytes, end_.waiting_bytes(Lane::kDelta, test::VirtualRobot::kRobot));
  }
  void publish(bool changing) {
    if (changing) {
      map_.change();
      if (const auto correction = map_.correction()) send(stream_.repose(std::span(&*correction, 1)));
    }
    const auto changed = changing ? map_.all_rows() : std::vector<std::uint32_t>{};
    auto deltas = stream_.publish(map_.cloud(), changed, map_.take_removed(),
                                  std::min(room(), allowance_.available(clock_.now())));
    for (const auto& delta : deltas) allowance_.spend(delta.size());
    send(std::move(deltas));
    hash_at_[stream_.position().seq] = stream_.position().map_hash;
  }
  void send(std::vector<stream::Bytes> deltas) {
    for (auto& delta : deltas) (void)end_.send(Lane::kDelta, test::VirtualRobot::kRobot, std::move(delta));
  }
  void send_heartbeat() {
    const auto down = end_.counters()[link::index_of(Lane::kDelta)];
    link::Heartbeat heartbeat;
    heartbeat.epoch.value = 1;
    heartbeat.seq = stream_.position().seq;
    heartbeat.map_hash = stream_.position().map_hash;
    heartbeat.queued_messages = static_cast<std::uint32_t>(down.queued_messages + down.flying_messages);
    (void)end_.send(Lane::kHeartbeat, test::VirtualRobot::kRobot, link::encode_heartbeat(heartbeat));
  }

  link::LinkEnd& end_;
  const Clock& clock_;
  test::ChangingMap map_;
  stream::ByteAllowance allowance_;
  stream::DeltaStream stream_;
  std::map<std::uint64_t, std::uint64_t> hash_at_;
  std::map<std::uint32_t, Bytes> keyframes_;  ///< as they came
  std::size_t keyframes_twice_ = 0;
  HostTime next_publish_{};
  HostTime next_heartbeat_{};
};

class AllFaults : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  void step(bool changing) {
    robot_.step();
    server_.step(changing);
    note_queues(link_.robot());
    note_queues(link_.server());
  }
  /// The network's narrow place is bounded by its own settings; the ends' queues by theirs.
  static void note_queues(link::LinkEnd& end) {
    for (const LaneCounters& lane : end.counters()) {
      ASSERT_LE(lane.queued_messages, 64U);
      ASSERT_LE(lane.flying_messages, 16U);
    }
  }
  static void expect_bounded(const link::LinkCounters& counters) {
    for (const LaneCounters& lane : counters) {
      EXPECT_LE(lane.most_queued_messages, 64U);
      EXPECT_LE(lane.most_queued_bytes, 400'000U);
      EXPECT_LE(lane.most_flying_messages, 16U);
      EXPECT_LE(lane.most_flying_bytes, 200'000U);
    }
  }
  [[nodiscard]] bool agreed() const {
    const auto at = server_.stream().position();
    return robot_.map().position().seq == at.seq && robot_.map().map_hash() == at.map_hash &&
           server_.stream().counters().waiting == 0;
  }

  SimulatedLink link_{bad_end(GetParam()), bad_end(GetParam() + 100)};
  ChangingServer server_{link_.server(), link_.clock, GetParam()};
  std::size_t checked_ = 0;
  test::VirtualRobot robot_{link_.robot(), link_.clock,
                            [this](const map::MapPosition& at, std::uint64_t hash) {
                              const auto noted = server_.hash_at().find(at.seq);
                              if (noted == server_.hash_at().end()) return;
                              ASSERT_EQ(hash, noted->second) << "at delta " << at.seq;
                              ++checked_;
                            }};
};

TEST_P(AllFaults, AtOnceEndWithEqualHashesAndNothingCorruptApplied) {
  constexpr double kChanging_s = 20.0;
  std::map<std::uint32_t, Bytes> sent;
  link_.run(kChanging_s, [&](double t_s) {
    if (t_s >= 0.4 * static_cast<double>(sent.size())) {
      const auto id = static_cast<std::uint32_t>(sent.size());
      sent[id] = *map::encode_keyframe(test::random_keyframe(id, 2500, id));
      robot_.send(sent[id]);
    }
    step(true);
  });
  double settled_s = 0.0;
  for (; settled_s < 20.0 && !(agreed() && server_.keyframes().size() == sent.size()); settled_s += 0.1)
    link_.run(0.1, [&](double) { step(false); });
  ASSERT_TRUE(agreed());
  EXPECT_EQ(robot_.map().counters().gaussians, server_.cloud().size());
  EXPECT_EQ(robot_.map().counters().hash_disagreed, 0U);
  EXPECT_EQ(robot_.map().counters().corrupt, 0U) << "the link hands on nothing that is corrupt";
  EXPECT_GT(checked_, 50U);
  EXPECT_EQ(server_.keyframes_twice(), 0U);
  EXPECT_EQ(server_.keyframes(), sent);

  for (const link::LinkEnd* end : {&link_.robot(), &link_.server()}) {
    expect_bounded(end->counters());
    const auto done = end->impairments();
    ASSERT_TRUE(done);
    EXPECT_GT(done->lost, 0U);
    EXPECT_GT(done->duplicated, 0U);
    EXPECT_GT(done->reordered, 0U);
    EXPECT_GT(done->flipped, 0U);
  }
  std::uint64_t corrupt = 0;
  for (const link::LinkEnd* end : {&link_.robot(), &link_.server()}) {
    for (const LaneCounters& lane : end->counters()) {
      corrupt += lane.chunks_corrupt;
      EXPECT_EQ(lane.messages_corrupt, 0U);
    }
  }
  EXPECT_GT(corrupt, 0U);
  RecordProperty("settled_s", std::to_string(settled_s));
  RecordProperty("chunks_corrupt", std::to_string(corrupt));
  RecordProperty("deltas", std::to_string(server_.stream().position().seq));
  const auto down = link_.server().counters()[link::index_of(Lane::kDelta)];
  RecordProperty("deltas_shed", std::to_string(down.messages_dropped));
  RecordProperty("resends_asked", std::to_string(robot_.map().counters().resends_asked));
  RecordProperty("snapshots_asked", std::to_string(robot_.map().counters().snapshots_asked));
  RecordProperty("resent", std::to_string(server_.stream().counters().resent));
  RecordProperty("duplicates", std::to_string(robot_.map().counters().duplicates));
  RecordProperty("checked", std::to_string(checked_));
  RecordProperty("most_queued_bytes", std::to_string(down.most_queued_bytes));
}

INSTANTIATE_TEST_SUITE_P(Seeds, AllFaults, ::testing::Range(std::uint64_t{1}, std::uint64_t{4}));

}  // namespace
}  // namespace edgesplat
