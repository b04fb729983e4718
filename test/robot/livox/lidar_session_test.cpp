// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Both sessions against virtual units that share no code with them, in virtual time.
#include "robot/drivers/livox/sdk1_session.hpp"
#include "robot/drivers/livox/sdk2_session.hpp"
#include "test/robot/livox/hex.hpp"
#include "test/robot/livox/virtual_wire.hpp"
#include "tools/virtual_device/sdk1_unit.hpp"
#include "tools/virtual_device/sdk2_unit.hpp"
#include "tools/virtual_device/sdk2_wire.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace edgesplat::livox {
namespace {

using virtual_device::UnitSync;
using virtual_device::VirtualUnit;
using virtual_device::VirtualUnitConfig;
using Kind = LidarEventKind;

enum class Model { kMid360, kAvia };

VirtualUnitConfig unit_config(const std::string& serial_number = "47MTEST0000001", std::uint8_t last = 10) {
  VirtualUnitConfig config;
  config.serial_number = serial_number;
  config.ip = {127, 9, 0, last};
  return config;
}

LidarSessionConfig session_config(Model model) {
  LidarSessionConfig config;
  if (model == Model::kAvia) config.push_port = 55000;
  return config;
}

std::unique_ptr<LidarSession> make_session(Model model, const LidarSessionConfig& config) {
  if (model == Model::kMid360) return std::make_unique<Sdk2Session>(config, VirtualWire::host_towards());
  return std::make_unique<Sdk1Session>(config, VirtualWire::host_towards());
}

std::unique_ptr<VirtualUnit> make_unit(Model model, const VirtualUnitConfig& config) {
  if (model == Model::kMid360)
    return std::make_unique<virtual_device::Sdk2Unit>(config, VirtualWire::kStart_ns);
  return std::make_unique<virtual_device::Sdk1Unit>(config, VirtualWire::kStart_ns);
}

class LidarSessionTest : public testing::TestWithParam<Model> {
 protected:
  void set_up(const LidarSessionConfig& config, const VirtualUnitConfig& unit) {
    unit_ = make_unit(GetParam(), unit);
    session_ = make_session(GetParam(), config);
    wire_ = std::make_unique<VirtualWire>(*session_, std::vector{unit_.get()});
  }
  void set_up() { set_up(session_config(GetParam()), unit_config()); }
  void bring_up() {
    set_up();
    ASSERT_GE(wire_->run_until(Kind::kSampling, 3.0), 0.0);
    wire_->run(1.0);
  }

  std::unique_ptr<VirtualUnit> unit_;
  std::unique_ptr<LidarSession> session_;
  std::unique_ptr<VirtualWire> wire_;
};

TEST_P(LidarSessionTest, FindsStartsAndKeepsAUnit) {
  set_up();
  const double took_s = wire_->run_until(Kind::kSampling, 5.0);
  ASSERT_GE(took_s, 0.0);
  EXPECT_LT(took_s, 1.5);
  wire_->run(20.0);
  EXPECT_EQ(wire_->count(Kind::kFound), 1U);
  EXPECT_EQ(wire_->count(Kind::kSampling), 1U);
  EXPECT_EQ(wire_->events.size(), 2U) << wire_->detail(Kind::kSilent);
  EXPECT_NEAR(static_cast<double>(wire_->points), 20'000.0, 600.0);
  EXPECT_NEAR(static_cast<double>(wire_->imu_samples), 4'000.0, 120.0);
  EXPECT_EQ(unit_->counters().bad_frames, 0U);
  EXPECT_EQ(unit_->counters().refused, 0U);
  EXPECT_EQ(session_->counters().bad_frames, 0U);
  EXPECT_EQ(session_->counters().retries, 0U);
  EXPECT_EQ(session_->health().sync, "ptp");
}

TEST_P(LidarSessionTest, SilenceIsOneEventWithinASecondAndOverWhenDataComeBack) {
  bring_up();
  wire_->pull();
  const double detected_s = wire_->run_until(Kind::kSilent, 5.0);
  ASSERT_GE(detected_s, 0.0);
  EXPECT_LT(detected_s, 1.0);
  EXPECT_EQ(wire_->detail(Kind::kSilent), "points and IMU");
  wire_->run(7.0);
  wire_->plug();
  const double recovered_s = wire_->run_until(Kind::kRecovered, 10.0);
  ASSERT_GE(recovered_s, 0.0);
  EXPECT_LT(recovered_s, 3.0);
  wire_->run(5.0);
  EXPECT_EQ(wire_->count(Kind::kSilent), 1U);
  EXPECT_EQ(wire_->count(Kind::kRecovered), 1U);
  EXPECT_LE(wire_->count(Kind::kUnreachable), 1U);
}

TEST_P(LidarSessionTest, AShortBreakOfTheCableNeedsNothing) {
  bring_up();
  wire_->pull();
  wire_->run(0.3);
  wire_->plug();
  wire_->run(5.0);
  EXPECT_EQ(wire_->count(Kind::kSilent), 0U);
  EXPECT_EQ(wire_->count(Kind::kSampling), 1U);
}

TEST_P(LidarSessionTest, ARestartedUnitIsBroughtUpAgain) {
  bring_up();
  for (const double off_s : {0.4, 1.7, 5.0, 20.0}) {
    unit_->power_cycle(wire_->now_ns(), static_cast<std::int64_t>(off_s * 1e9));
    const double detected_s = wire_->run_until(Kind::kSilent, 3.0);
    ASSERT_GE(detected_s, 0.0);
    EXPECT_LT(detected_s, 1.0);
    const double recovered_s = detected_s + wire_->run_until(Kind::kRecovered, off_s + 10.0);
    EXPECT_LT(recovered_s, off_s + 3.0);
    wire_->run(3.0);
  }
  EXPECT_EQ(wire_->count(Kind::kSilent), 4U);
  EXPECT_EQ(wire_->count(Kind::kRecovered), 4U);
  EXPECT_EQ(wire_->count(Kind::kFound), 1U);
}

TEST_P(LidarSessionTest, AUnitThatComesBackElsewhereIsFollowed) {
  bring_up();
  unit_->move_to({127, 9, 0, 77});
  unit_->power_cycle(wire_->now_ns(), 1'000'000'000);
  ASSERT_GE(wire_->run_until(Kind::kMoved, 5.0), 0.0);
  EXPECT_NE(wire_->detail(Kind::kMoved).find("127.9.0.77"), std::string::npos);
  ASSERT_GE(wire_->run_until(Kind::kRecovered, 3.0), 0.0);
  EXPECT_TRUE(session_->is_from_unit({127, 9, 0, 77}));
  EXPECT_FALSE(session_->is_from_unit({127, 9, 0, 10}));
  wire_->run(5.0);
  EXPECT_EQ(wire_->count(Kind::kMoved), 1U);
}

TEST_P(LidarSessionTest, AnAddressThatChangesWithoutARestartIsFollowed) {
  bring_up();
  unit_->move_to({127, 9, 0, 78});
  ASSERT_GE(wire_->run_until(Kind::kRecovered, 8.0), 0.0);
  EXPECT_EQ(wire_->count(Kind::kMoved), 1U);
}

TEST_P(LidarSessionTest, BringsUpOverAWireThatLosesFivePercent) {
  for (int round = 0; round < 20; ++round) {
    set_up();
    wire_->lose(0.05);
    wire_->run(static_cast<double>(round) * 0.037);
    if (wire_->count(Kind::kSampling) == 0) {
      ASSERT_GE(wire_->run_until(Kind::kSampling, 4.0), 0.0) << round;
    }
    wire_->run(20.0);
    EXPECT_EQ(wire_->count(Kind::kSilent), 0U);
    EXPECT_EQ(wire_->count(Kind::kUnreachable), 0U);
  }
}

TEST_P(LidarSessionTest, OnlyTheUnitWithTheSerialNumberIsUsed) {
  const auto other = make_unit(GetParam(), unit_config("47MOTHER000001", 20));
  const auto mine = make_unit(GetParam(), unit_config("47MMINE0000001", 21));
  LidarSessionConfig config = session_config(GetParam());
  config.serial_number = "47MMINE0000001";
  session_ = make_session(GetParam(), config);
  VirtualWire wire(*session_, {other.get(), mine.get()});
  ASSERT_GE(wire.run_until(Kind::kSampling, 3.0), 0.0);
  wire.run(5.0);
  EXPECT_TRUE(session_->is_from_unit({127, 9, 0, 21}));
  EXPECT_EQ(other->counters().sessions, 0U);
  EXPECT_EQ(mine->counters().sessions, 1U);
  EXPECT_EQ(wire.count(Kind::kForeign), 1U);
  EXPECT_NE(wire.detail(Kind::kForeign).find("47MOTHER000001"), std::string::npos);
}

TEST_P(LidarSessionTest, ANeighbourIsLeftAloneWithoutAWord) {
  const auto neighbour = make_unit(GetParam(), unit_config("47MOTHER000001", 20));
  const auto by_address = make_unit(GetParam(), unit_config("47MOTHER000002", 22));
  const auto stranger = make_unit(GetParam(), unit_config("47MOTHER000003", 23));
  const auto mine = make_unit(GetParam(), unit_config("47MMINE0000001", 21));
  LidarSessionConfig config = session_config(GetParam());
  config.serial_number = "47MMINE0000001";
  config.neighbours = {"47MOTHER000001", "127.9.0.22"};
  session_ = make_session(GetParam(), config);
  VirtualWire wire(*session_, {neighbour.get(), by_address.get(), stranger.get(), mine.get()});
  ASSERT_GE(wire.run_until(Kind::kSampling, 3.0), 0.0);
  wire.run(5.0);
  EXPECT_TRUE(session_->is_from_unit({127, 9, 0, 21}));
  EXPECT_EQ(wire.count(Kind::kForeign), 1U);
  EXPECT_NE(wire.detail(Kind::kForeign).find("47MOTHER000003"), std::string::npos);
  for (const auto* other : {neighbour.get(), by_address.get(), stranger.get()})
    EXPECT_EQ(other->counters().sessions, 0U);
}

TEST_P(LidarSessionTest, AnAddressWithoutASerialNumberIsThatUnitOnly) {
  const auto other = make_unit(GetParam(), unit_config("47MOTHER000001", 20));
  const auto mine = make_unit(GetParam(), unit_config("47MMINE0000001", 21));
  LidarSessionConfig config = session_config(GetParam());
  config.address = Ipv4{127, 9, 0, 21};
  session_ = make_session(GetParam(), config);
  VirtualWire wire(*session_, {other.get(), mine.get()});
  ASSERT_GE(wire.run_until(Kind::kSampling, 3.0), 0.0);
  wire.run(5.0);
  EXPECT_TRUE(session_->is_from_unit({127, 9, 0, 21}));
  EXPECT_EQ(other->counters().sessions, 0U);
}

TEST_P(LidarSessionTest, WithoutASerialNumberTheFirstUnitIsKept) {
  const auto first = make_unit(GetParam(), unit_config("47MFIRST000001", 20));
  const auto second = make_unit(GetParam(), unit_config("47MSECOND00001", 21));
  session_ = make_session(GetParam(), session_config(GetParam()));
  VirtualWire wire(*session_, {first.get(), second.get()});
  ASSERT_GE(wire.run_until(Kind::kSampling, 3.0), 0.0);
  first->power_cycle(wire.now_ns(), 4'000'000'000);
  wire.run(10.0);
  EXPECT_TRUE(session_->is_from_unit({127, 9, 0, 20}));
  EXPECT_EQ(second->counters().sessions, 0U);
  EXPECT_EQ(wire.count(Kind::kForeign), 1U);
  EXPECT_EQ(wire.count(Kind::kRecovered), 1U);
}

TEST_P(LidarSessionTest, AKnownAddressNeedsNoSearch) {
  LidarSessionConfig config = session_config(GetParam());
  config.address = Ipv4{127, 9, 0, 10};
  config.serial_number = "47MTEST0000001";
  set_up(config, unit_config());
  ASSERT_GE(wire_->run_until(Kind::kSampling, 3.0), 0.0);
  wire_->pull();
  wire_->run(10.0);
  wire_->plug();
  const double recovered_s = wire_->run_until(Kind::kRecovered, 10.0);
  ASSERT_GE(recovered_s, 0.0);
  EXPECT_LT(recovered_s, 3.0);
}

TEST_P(LidarSessionTest, NobodyThereIsSaidOnce) {
  LidarSessionConfig config = session_config(GetParam());
  config.serial_number = "47MNOWHERE0001";
  set_up(config, unit_config("47MSOMEBODY001"));
  wire_->run(30.0);
  EXPECT_EQ(wire_->count(Kind::kUnreachable), 1U);
  EXPECT_EQ(wire_->count(Kind::kForeign), 1U);
  EXPECT_EQ(wire_->events.size(), 2U);
}

TEST_P(LidarSessionTest, ToldSecondsReachAUnitOnAPulseLineInItsWindow) {
  LidarSessionConfig config = session_config(GetParam());
  config.feeds_utc = true;
  VirtualUnitConfig unit = unit_config();
  unit.clock.sync = UnitSync::kPulse;
  set_up(config, unit);
  std::uint64_t missed_at_start = 0;  // the second in which it began to measure
  for (int ms = 0; ms < 10'000; ++ms) {
    // The wall clock of a host that is right to 20 ms.
    session_->utc_feed().follow_wall_clock(
        host_time_from_ns(wire_->now_ns() - VirtualWire::kStart_ns + 1'000'000'000),
        wire_->now_ns() + 20'000'000);
    wire_->run(0.001);
    if (ms == 3'000) missed_at_start = session_->utc_feed().missed();
  }
  EXPECT_GE(unit_->counters().seconds_told, 7U);
  EXPECT_LE(unit_->counters().seconds_told, 10U);
  EXPECT_EQ(unit_->counters().seconds_late, 0U);
  EXPECT_EQ(session_->utc_feed().missed(), missed_at_start);
  EXPECT_EQ(session_->health().sync, "gps");
  // Right to the noise of the servo: the second is the right one.
  EXPECT_LT(std::abs(unit_->clock().stamp_ns(wire_->now_ns()) - wire_->now_ns()), 20'000);
}

TEST_P(LidarSessionTest, EdgesThatWereSeenAreToldWhereverInASecondTheyAre) {
  LidarSessionConfig config = session_config(GetParam());
  config.feeds_utc = true;
  VirtualUnitConfig unit = unit_config();
  unit.clock.sync = UnitSync::kPulse;
  set_up(config, unit);
  constexpr std::int64_t kPhase_ns = 370'000'000;
  unit_->clock().set_epoch(-kPhase_ns);  // its line's pulses come that long after each full second
  for (int ms = 0; ms < 10'000; ++ms) {
    const HostTime now = host_time_from_ns(wire_->now_ns() - VirtualWire::kStart_ns + 1'000'000'000);
    if (wire_->now_ns() % 1'000'000'000 == kPhase_ns) session_->utc_feed().on_pulse(now, wire_->now_ns());
    wire_->run(0.001);
  }
  EXPECT_GE(unit_->counters().seconds_told, 7U);
  EXPECT_EQ(unit_->counters().seconds_late, 0U);
  EXPECT_EQ(session_->health().sync, "gps");
  EXPECT_LT(std::abs(unit_->clock().stamp_ns(wire_->now_ns()) - wire_->now_ns()), 20'000);
}

TEST_P(LidarSessionTest, DamagedFramesAreCountedAndChangeNothing) {
  bring_up();
  test::Random random(3);
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> noise(static_cast<std::size_t>(random.uniform(0.0, 100.0)));
    for (std::byte& byte : noise) byte = static_cast<std::byte>(random.uniform(0.0, 255.9));
    if (noise.size() > 2) noise[0] = std::byte{0xAA};
    session_->on_control(Channel::kControl, {{127, 9, 0, 10}, 56100}, noise, HostTime{});
  }
  EXPECT_EQ(session_->counters().bad_frames, 2000U);
  wire_->run(5.0);
  EXPECT_EQ(wire_->count(Kind::kSilent), 0U);
}

TEST_P(LidarSessionTest, APartOfASerialNumberIsNotThatUnit) {
  LidarSessionConfig config = session_config(GetParam());
  config.serial_number = "47MTEST00000";
  set_up(config, unit_config());
  wire_->run(5.0);
  EXPECT_EQ(wire_->count(Kind::kFound), 0U);
  EXPECT_EQ(wire_->count(Kind::kForeign), 1U);
}

INSTANTIATE_TEST_SUITE_P(Models, LidarSessionTest, testing::Values(Model::kMid360, Model::kAvia),
                         [](const testing::TestParamInfo<Model>& model) {
                           return model.param == Model::kMid360 ? "Mid360" : "Avia";
                         });

/// An answer of a unit to this request.
std::vector<std::byte> answer_to(const std::vector<std::byte>& request, std::string_view content_hex) {
  const auto asked = virtual_device::parse_sdk2_request(request);
  EXPECT_TRUE(asked.has_value());
  return virtual_device::make_sdk2_frame(asked->sequence, asked->command, virtual_device::Sdk2Kind::kAck,
                                         from_hex(content_hex));
}

TEST(Sdk2Session, AUnitThatRunsItsLoaderIsSaidOnceAndNotStarted) {
  LidarSessionConfig config;
  config.address = Ipv4{127, 9, 0, 10};
  Sdk2Session session(config, VirtualWire::host_towards());
  std::vector<LidarEvent> events;
  for (int second = 0; second < 20; ++second) {
    const HostTime now = host_time_from_ns(second * 1'000'000'000LL);
    (void)session.step(now);
    for (const auto& one : session.take_outgoing()) {
      const auto asked = virtual_device::parse_sdk2_request(one.bytes);
      EXPECT_EQ(asked->command, 0x0101) << "nothing is written to it";
      // return code 0, two keys: serial number "47MLOADER0001", firmware type 0
      session.on_control(Channel::kControl, one.to,
                         answer_to(one.bytes,
                                   "00"
                                   "0200"
                                   "00801000"
                                   "34374d4c4f4144455230303031000000"
                                   "10800100"
                                   "00"),
                         now);
    }
    for (LidarEvent& event : session.take_events()) events.push_back(std::move(event));
  }
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, Kind::kFound);
  EXPECT_EQ(events[1].kind, Kind::kNoFirmware);
  EXPECT_NE(events[1].detail.find("47MLOADER0001"), std::string::npos) << events[1].detail;
}

TEST(Sdk2Session, ASettingThatNeedsARestartGetsOne) {
  LidarSessionConfig config;
  config.address = Ipv4{127, 9, 0, 10};
  Sdk2Session session(config, VirtualWire::host_towards());
  std::vector<std::uint16_t> commands;
  for (int tenth = 0; tenth < 40; ++tenth) {
    const HostTime now = host_time_from_ns(tenth * 100'000'000LL);
    (void)session.step(now);
    for (const auto& one : session.take_outgoing()) {
      const auto asked = virtual_device::parse_sdk2_request(one.bytes);
      commands.push_back(asked->command);
      const char* answer = asked->command == 0x0101 ? "000000" : (asked->command == 0x0100 ? "210000" : "00");
      session.on_control(Channel::kControl, one.to, answer_to(one.bytes, answer), now);
    }
  }
  EXPECT_EQ(std::count(commands.begin(), commands.end(), 0x0200), 1) << "restarted once, not again and again";
}

TEST(Sdk2Session, WritesOnlyWhatDiffers) {
  virtual_device::Sdk2Unit unit(unit_config(), VirtualWire::kStart_ns);
  Sdk2Session session(LidarSessionConfig{}, VirtualWire::host_towards());
  VirtualWire wire(session, {&unit});
  ASSERT_GE(wire.run_until(Kind::kSampling, 3.0), 0.0);
  const auto written = unit.counters().written;
  EXPECT_EQ(written, 4U) << "three hosts and the work mode";
  // The next program finds everything as it wants it.
  Sdk2Session again(LidarSessionConfig{}, VirtualWire::host_towards());
  VirtualWire second(again, {&unit});
  ASSERT_GE(second.run_until(Kind::kSampling, 3.0), 0.0);
  EXPECT_EQ(unit.counters().written, written);
}

TEST(Sdk2Session, StartsAUnitThatDoesNotStartByItself) {
  VirtualUnitConfig config = unit_config();
  config.starts_by_itself = false;
  virtual_device::Sdk2Unit unit(config, VirtualWire::kStart_ns);
  Sdk2Session session(LidarSessionConfig{}, VirtualWire::host_towards());
  VirtualWire wire(session, {&unit});
  ASSERT_GE(wire.run_until(Kind::kSampling, 3.0), 0.0);
  wire.run(1.0);
  unit.power_cycle(wire.now_ns(), 500'000'000);
  ASSERT_GE(wire.run_until(Kind::kRecovered, 3.7), 0.0);
  EXPECT_EQ(unit.counters().sessions, 2U);
}

TEST(Sdk2Session, DataTakenByAnotherHostAreTakenBack) {
  virtual_device::Sdk2Unit unit(unit_config(), VirtualWire::kStart_ns);
  Sdk2Session session(LidarSessionConfig{}, VirtualWire::host_towards());
  VirtualWire wire(session, {&unit});
  ASSERT_GE(wire.run_until(Kind::kSampling, 3.0), 0.0);
  wire.run(1.0);
  // Another program tells the LiDAR to send elsewhere.
  const auto elsewhere =
      encode_set_hosts(9, {{127, 9, 0, 200}, 1, 1}, {{127, 9, 0, 200}, 2, 2}, {{127, 9, 0, 200}, 3, 3});
  unit.on_command(56100, {{127, 9, 0, 200}, 7}, elsewhere, wire.now_ns());
  const double recovered_s = wire.run_until(Kind::kRecovered, 5.0);
  ASSERT_GE(recovered_s, 0.0);
  EXPECT_LT(recovered_s, 1.5);
}

TEST(Sdk1Session, StopFreesTheUnitForTheNextHost) {
  virtual_device::Sdk1Unit unit(unit_config(), VirtualWire::kStart_ns);
  LidarSessionConfig config;
  config.push_port = 55000;
  Sdk1Session session(config, VirtualWire::host_towards());
  VirtualWire wire(session, {&unit});
  ASSERT_GE(wire.run_until(Kind::kSampling, 3.0), 0.0);
  session.stop({});
  const auto last = session.take_outgoing();
  ASSERT_EQ(last.size(), 1U);
  unit.on_command(65000, {VirtualWire::kHost, 56101}, last.front().bytes, wire.now_ns());
  EXPECT_FALSE(unit.is_measuring(wire.now_ns()));
  Sdk1Session next(config, VirtualWire::host_towards());
  VirtualWire second(next, {&unit});
  EXPECT_LT(second.run_until(Kind::kSampling, 3.0), 1.5);
}

TEST(UtcFeed, TellsEachSecondOnceInTheWindow) {
  UtcFeed feed;
  EXPECT_EQ(feed.next_due(), HostTime::max());
  const auto at = [](std::int64_t ms) { return host_time_from_ns(ms * 1'000'000); };
  feed.on_pulse(at(5'000), 42'000'000'000);
  EXPECT_EQ(feed.next_due(), at(5'200));
  EXPECT_FALSE(feed.due(at(5'199)).has_value());
  EXPECT_EQ(feed.due(at(5'210)), 42'000'000'000);
  EXPECT_FALSE(feed.due(at(5'220)).has_value());
  feed.on_pulse(at(5'000), 42'000'000'000);
  EXPECT_FALSE(feed.due(at(5'250)).has_value()) << "once for each edge";
  feed.on_pulse(at(6'000), 43'000'000'000);
  EXPECT_FALSE(feed.due(at(6'301)).has_value()) << "too late is not told";
  EXPECT_EQ(feed.missed(), 1U);
}

}  // namespace
}  // namespace edgesplat::livox
