// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/ptp_monitor.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

namespace edgesplat::sync {
namespace {

/// What pmc 3.1.1 wrote of a ptp4l that is the grandmaster on the loopback interface, word for word.
constexpr const char* kGrandmaster = R"(sending: GET TIME_STATUS_NP
sending: GET CURRENT_DATA_SET
	000000.fffe.000000-0 seq 0 RESPONSE MANAGEMENT TIME_STATUS_NP 
		master_offset              0
		ingress_time               0
		cumulativeScaledRateOffset +0.000000000
		scaledLastGmPhaseChange    0
		gmTimeBaseIndicator        0
		lastGmPhaseChange          0x0000'0000000000000000.0000
		gmPresent                  false
		gmIdentity                 000000.fffe.000000
sending: GET PARENT_DATA_SET
	000000.fffe.000000-0 seq 1 RESPONSE MANAGEMENT CURRENT_DATA_SET 
		stepsRemoved     0
		offsetFromMaster 0.0
		meanPathDelay    0.0
sending: GET PORT_DATA_SET
	000000.fffe.000000-0 seq 2 RESPONSE MANAGEMENT PARENT_DATA_SET 
		parentPortIdentity                    000000.fffe.000000-0
		parentStats                           0
		observedParentOffsetScaledLogVariance 0xffff
		observedParentClockPhaseChangeRate    0x7fffffff
		grandmasterPriority1                  128
		gm.ClockClass                         248
		gm.ClockAccuracy                      0xfe
		gm.OffsetScaledLogVariance            0xffff
		grandmasterPriority2                  128
		grandmasterIdentity                   000000.fffe.000000
	000000.fffe.000000-1 seq 3 RESPONSE MANAGEMENT PORT_DATA_SET 
		portIdentity            000000.fffe.000000-1
		portState               MASTER
		logMinDelayReqInterval  0
		peerMeanPathDelay       0
		logAnnounceInterval     1
		announceReceiptTimeout  3
		logSyncInterval         0
		delayMechanism          1
		logMinPdelayReqInterval 0
		versionNumber           2
)";

/// The same of a slave, after the fields' formats in pmc.c.
std::string slave(const std::string& offset, const std::string& present = "true",
                  const std::string& state = "SLAVE") {
  return "sending: GET PORT_DATA_SET\n\t0242ac.fffe.110002-1 seq 0 RESPONSE MANAGEMENT PORT_DATA_SET \n"
         "\t\tportIdentity            0242ac.fffe.110002-1\n\t\tportState               " +
         state +
         "\n"
         "\t0242ac.fffe.110002-0 seq 1 RESPONSE MANAGEMENT CURRENT_DATA_SET \n\t\tstepsRemoved     1\n"
         "\t\toffsetFromMaster " +
         offset +
         "\n\t\tmeanPathDelay    5321.5\n"
         "\t0242ac.fffe.110002-0 seq 2 RESPONSE MANAGEMENT TIME_STATUS_NP \n\t\tgmPresent                  " +
         present + "\n\t\tgmIdentity                 001122.fffe.334455\n";
}

TEST(PtpReport, ReadsWhatPmcWrites) {
  const auto report = parse_pmc(kGrandmaster);
  ASSERT_TRUE(report.has_value());
  ASSERT_EQ(report->ports.size(), 1U);
  EXPECT_EQ(report->ports[0].identity, "000000.fffe.000000-1");
  EXPECT_TRUE(report->has_port_in("MASTER"));
  EXPECT_EQ(report->offset_from_master_ns, 0.0);
  EXPECT_EQ(report->steps_removed, 0);
  EXPECT_EQ(report->grandmaster_present, false);
  EXPECT_EQ(report->grandmaster, "000000.fffe.000000");
  const auto other = parse_pmc(slave("-123.0"));
  ASSERT_TRUE(other.has_value());
  EXPECT_EQ(other->offset_from_master_ns, -123.0);
  EXPECT_EQ(other->mean_path_delay_ns, 5321.5);
  EXPECT_EQ(other->steps_removed, 1);
}

TEST(PtpReport, NoAnswerIsSaid) {
  for (const char* text :
       {"", "sending: GET PORT_DATA_SET\n", "uds: connect failed: No such file or directory\n"}) {
    const auto report = parse_pmc(text);
    ASSERT_FALSE(report.has_value());
    EXPECT_NE(report.error().context.find("ptp4l"), std::string::npos);
  }
}

TEST(PtpReport, DamagedTextGivesNoNumbers) {
  const std::string good = slave("12.0");
  for (std::size_t length = 0; length < good.size(); ++length)
    (void)parse_pmc(std::string_view(good).substr(0, length));
  for (const char* offset : {"nan", "inf", "1e999", "12x", "--3"}) {
    const auto report = parse_pmc(slave(offset));
    ASSERT_TRUE(report.has_value());
    EXPECT_FALSE(report->offset_from_master_ns.has_value()) << offset;
  }
  std::string many;
  for (int i = 0; i < 100'000; ++i)
    many += "\t1-0 seq 0 RESPONSE MANAGEMENT PORT_DATA_SET\n\t\tportIdentity 1-1\n";
  EXPECT_LE(parse_pmc(many)->ports.size(), 256U);
}

TEST(PtpJudgement, ChangesAreToldOnceEach) {
  PtpJudgement judgement(10.0);
  EXPECT_TRUE(judgement.on_report(parse_pmc(slave("900.0")))->good);
  EXPECT_FALSE(judgement.on_report(parse_pmc(slave("-9000.0"))).has_value());
  const auto far = judgement.on_report(parse_pmc(slave("11000.0")));
  ASSERT_TRUE(far.has_value());
  EXPECT_FALSE(far->good);
  EXPECT_FALSE(judgement.on_report(parse_pmc(slave("11000.0", "false"))).has_value());
  EXPECT_TRUE(judgement.on_report(parse_pmc(slave("0.0")))->good);
  EXPECT_FALSE(judgement.on_report(parse_pmc(slave("0.0", "false")))->good);
  EXPECT_TRUE(judgement.on_report(parse_pmc(slave("0.0")))->good);
  EXPECT_FALSE(judgement.on_report(parse_pmc(slave("0.0", "true", "FAULTY")))->good);
  EXPECT_TRUE(judgement.on_report(parse_pmc(slave("0.0")))->good);
  EXPECT_FALSE(judgement.on_report(parse_pmc(""))->good);
  EXPECT_EQ(judgement.failures(), 4U);
  const auto other = judgement.on_report(parse_pmc(kGrandmaster));
  ASSERT_TRUE(other.has_value());
  EXPECT_TRUE(other->good);
}

TEST(RunForOutput, GivesWhatAProgramWrites) {
  const auto text = run_for_output({"printf", "a b"}, 5.0, {});
  ASSERT_TRUE(text.has_value()) << text.error().context;
  EXPECT_EQ(*text, "a b");
}

TEST(RunForOutput, SaysWhatFailed) {
  EXPECT_FALSE(run_for_output({"/no/such/program"}, 5.0, {}).has_value());
  EXPECT_FALSE(run_for_output({"false"}, 5.0, {}).has_value());
  EXPECT_FALSE(run_for_output({"yes"}, 5.0, {}).has_value());
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(run_for_output({"sleep", "30"}, 0.2, {}).has_value());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

}  // namespace
}  // namespace edgesplat::sync
