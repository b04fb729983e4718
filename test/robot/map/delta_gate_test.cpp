// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/map/delta_gate.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace edgesplat::map {
namespace {

using Verdict = DeltaGate::Verdict;

HostTime at_s(double seconds) {
  return HostTime(from_seconds(seconds));
}

DeltaHeader header(std::uint64_t seq, std::uint32_t epoch = 1, std::uint8_t map = 1) {
  DeltaHeader h;
  h.map.bytes.fill(static_cast<std::byte>(map));
  h.epoch.value = epoch;
  h.seq = seq;
  h.base_seq = seq - 1;
  return h;
}

/// Places one and applies it where it is its turn, and all that were held for it.
Verdict feed(DeltaGate& gate, const DeltaHeader& h, double now_s) {
  const std::vector<std::byte> bytes(10);
  const Verdict verdict = gate.place(h, bytes, at_s(now_s));
  if (verdict != Verdict::kApply) return verdict;
  gate.applied(h, at_s(now_s));
  for (std::uint64_t seq = h.seq + 1; gate.take_next(); ++seq)
    gate.applied(header(seq, h.epoch.value), at_s(now_s));
  return verdict;
}

TEST(DeltaGate, AsksForEachGapAfterATenthOfASecond) {
  DeltaGate gate({});
  for (const std::uint64_t seq : std::vector<std::uint64_t>{1, 2, 4, 5, 9})
    (void)feed(gate, header(seq), 1.0);
  EXPECT_EQ(gate.position().seq, 2U);
  EXPECT_TRUE(gate.requests(at_s(1.09)).empty());
  const auto requests = gate.requests(at_s(1.11));
  ASSERT_EQ(requests.size(), 2U);
  EXPECT_EQ(requests[0].kind, RequestKind::kResend);
  EXPECT_EQ(requests[0].seq, 2U);
  EXPECT_EQ(requests[0].until_seq, 3U);
  EXPECT_EQ(requests[1].seq, 5U);
  EXPECT_EQ(requests[1].until_seq, 8U);
  EXPECT_TRUE(gate.requests(at_s(1.2)).empty());  // the answer may be on its way
  EXPECT_EQ(gate.requests(at_s(1.32)).size(), 2U);
}

TEST(DeltaGate, AsksForASnapshotAfterTwoSecondsWithoutProgress) {
  DeltaGate gate({});
  for (const std::uint64_t seq : std::vector<std::uint64_t>{1, 3, 5}) (void)feed(gate, header(seq), 1.0);
  (void)feed(gate, header(2), 2.0);  // progress: up to 3
  for (double s = 2.0; s < 3.99; s += 0.05) {
    for (const auto& request : gate.requests(at_s(s))) EXPECT_EQ(request.kind, RequestKind::kResend) << s;
  }
  const auto requests = gate.requests(at_s(4.01));
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(requests[0].kind, RequestKind::kSnapshot);
  EXPECT_EQ(requests[0].seq, 3U);
  EXPECT_TRUE(gate.requests(at_s(4.5)).empty());
  EXPECT_EQ(gate.requests(at_s(5.1)).size(), 1U);  // asked again, until it begins
  auto snapshot = header(20);
  snapshot.base_seq = 0;
  EXPECT_EQ(feed(gate, snapshot, 5.2), Verdict::kApply);
  EXPECT_EQ(gate.position().seq, 20U);
  EXPECT_EQ(gate.held(), 0U);  // what was held is older than the snapshot
  EXPECT_EQ(gate.held_bytes(), 0U);
  EXPECT_TRUE(gate.requests(at_s(9.0)).empty());
}

TEST(DeltaGate, KnowsFromTheServerThatTheLastOnesAreMissing) {
  DeltaGate gate({});
  (void)feed(gate, header(1), 1.0);
  gate.server_at({Epoch{1}, 4}, at_s(1.0));
  EXPECT_TRUE(gate.requests(at_s(1.2)).empty());
  const auto requests = gate.requests(at_s(1.31));
  ASSERT_EQ(requests.size(), 1U);
  EXPECT_EQ(requests[0].seq, 1U);
  EXPECT_EQ(requests[0].until_seq, 4U);
  for (const std::uint64_t seq : std::vector<std::uint64_t>{2, 3, 4}) (void)feed(gate, header(seq), 1.4);
  EXPECT_TRUE(gate.requests(at_s(9.0)).empty());
}

TEST(DeltaGate, ANewerEpochIsAskedForWhenItsBeginningDoesNotCome) {
  DeltaGate gate({});
  (void)feed(gate, header(1), 1.0);
  gate.server_at({Epoch{2}, 0}, at_s(1.0));  // nothing made yet: nothing to ask for
  EXPECT_TRUE(gate.requests(at_s(1.9)).empty());
  gate.server_at({Epoch{2}, 7}, at_s(2.0));
  EXPECT_TRUE(gate.requests(at_s(2.2)).empty());
  ASSERT_EQ(gate.requests(at_s(2.4)).size(), 1U);
  EXPECT_EQ(feed(gate, header(8, 2), 2.5), Verdict::kNeedsReset);
  EXPECT_EQ(feed(gate, header(1, 2, 2), 2.6), Verdict::kApply);
  EXPECT_EQ(gate.position().epoch.value, 2U);
  EXPECT_EQ(feed(gate, header(2, 1), 2.7), Verdict::kOld);
  gate.server_at({Epoch{1}, 9}, at_s(2.8));  // an old heartbeat changes nothing
  EXPECT_TRUE(gate.requests(at_s(9.0)).empty());
}

TEST(DeltaGate, AMapLeftBehindDoesNotComeBack) {
  DeltaGate gate({});
  (void)feed(gate, header(1, 1, 1), 1.0);
  EXPECT_EQ(feed(gate, header(1, 1, 2), 1.0), Verdict::kApply);  // the server began another map for us
  EXPECT_EQ(feed(gate, header(1, 1, 1), 1.1), Verdict::kOld);    // late samples of the former one
  EXPECT_EQ(feed(gate, header(2, 1, 1), 1.1), Verdict::kOld);
  EXPECT_EQ(gate.position().seq, 1U);
}

TEST(DeltaGate, TooManyHeldAreRefusedAndLeadToResends) {
  DeltaGateConfig config;
  config.max_held_deltas = 3;
  DeltaGate gate(config);
  (void)feed(gate, header(1), 1.0);
  for (const std::uint64_t seq : std::vector<std::uint64_t>{3, 4, 5})
    EXPECT_EQ(feed(gate, header(seq), 1.0), Verdict::kHeld);
  EXPECT_EQ(feed(gate, header(6), 1.0), Verdict::kNeedsReset);
  EXPECT_EQ(gate.held(), 3U);
  EXPECT_EQ(feed(gate, header(2), 1.1), Verdict::kApply);
  EXPECT_EQ(gate.position().seq, 5U);
  gate.server_at({Epoch{1}, 6}, at_s(1.2));
  EXPECT_EQ(gate.requests(at_s(1.6)).at(0).until_seq, 6U);
}

}  // namespace
}  // namespace edgesplat::map
