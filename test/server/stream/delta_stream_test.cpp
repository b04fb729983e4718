// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/delta_stream.hpp"

#include "common/map/repose.hpp"
#include "server/stream/map_uuid.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace edgesplat::stream {
namespace {

constexpr std::size_t kPlenty_bytes = std::size_t{1} << 30U;

DeltaStreamConfig config_of(std::size_t max_rows = 4096) {
  DeltaStreamConfig config;
  config.robot.value = 4;
  config.map = make_map_uuid();
  config.epoch.value = 7;
  config.max_rows = max_rows;
  return config;
}

std::vector<std::uint32_t> all_rows(const gaussian::GaussianCloud& cloud) {
  std::vector<std::uint32_t> rows(cloud.size());
  std::iota(rows.begin(), rows.end(), 0U);
  return rows;
}

/// What a robot would have after these deltas, checked on the way.
void apply_all(map::MapState& state, const std::vector<Bytes>& deltas, std::uint64_t& seq) {
  for (const auto& bytes : deltas) {
    const auto delta = map::decode_delta(bytes);
    ASSERT_TRUE(delta.has_value()) << delta.error().context;
    ASSERT_TRUE(delta->header.base_seq == 0 || delta->header.base_seq == seq);
    ASSERT_EQ(delta->header.seq, seq + 1);
    seq = delta->header.seq;
    ASSERT_TRUE(state.apply(*delta).has_value());
  }
}

float worst_mean_error_m(const map::MapState& state, const gaussian::GaussianCloud& truth) {
  const auto cloud = map::dequantise(state.rows());
  float worst = 0.0F;
  for (std::size_t row = 0; row < truth.size(); ++row) {
    const auto at = state.find(truth.ids[row]);
    if (!at) return std::numeric_limits<float>::infinity();
    for (std::size_t k = 0; k < 3; ++k)
      worst = std::max(worst, std::abs(cloud.means_m[3 * *at + k] - truth.means_m[3 * row + k]));
  }
  return worst;
}

TEST(DeltaStream, NumbersDeltasWithoutGapsAndSplitsLargeChanges) {
  const DeltaStreamConfig config = config_of(100);
  DeltaStream stream(config);
  EXPECT_TRUE(stream.publish({}, {}, {}, kPlenty_bytes).empty());
  const auto cloud = test::random_gaussians(250, 1);
  const auto deltas = stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes);
  EXPECT_EQ(deltas.size(), 3U);
  for (std::size_t i = 0; i < deltas.size(); ++i) {
    const auto delta = map::decode_delta(deltas[i]);
    ASSERT_TRUE(delta.has_value());
    EXPECT_EQ(delta->header.seq, i + 1);
    EXPECT_EQ(delta->header.base_seq, i);
    EXPECT_EQ(delta->header.epoch, config.epoch);
    EXPECT_EQ(delta->header.robot, config.robot);
    EXPECT_EQ(delta->header.map, config.map);
  }
  EXPECT_EQ(stream.position().seq, 3U);
}

TEST(DeltaStream, TheRobotEndsWithWhatTheServerThinksItHas) {
  DeltaStream stream(config_of());
  map::MapState robot;
  std::uint64_t seq = 0;
  auto cloud = test::random_gaussians(2000, 1, 1);
  apply_all(robot, stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes), seq);
  for (int step = 0; step < 10; ++step) {
    for (std::size_t i = static_cast<std::size_t>(step); i < cloud.means_m.size(); i += 3)
      cloud.means_m[i] += 0.2F;  // some leave their chunks
    const std::vector<gaussian::GaussianId> removed(cloud.ids.end() - 5, cloud.ids.end());
    cloud.resize(cloud.size() - 5);
    apply_all(robot, stream.publish(cloud, all_rows(cloud), removed, kPlenty_bytes), seq);
    EXPECT_EQ(robot.hash(), stream.position().map_hash);
    EXPECT_EQ(robot.size(), cloud.size());
    EXPECT_LT(worst_mean_error_m(robot, cloud), 0.003F);
  }
  const auto counters = stream.counters();
  EXPECT_GT(counters.updated, 1000U);
  EXPECT_EQ(counters.removed, 50U);
  EXPECT_EQ(counters.refused, 0U);
}

TEST(DeltaStream, ABudgetHoldsAndWhatDoesNotFitComesLater) {
  DeltaStream stream(config_of());
  map::MapState robot;
  std::uint64_t seq = 0;
  auto cloud = test::random_gaussians(5000, 1);
  apply_all(robot, stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes), seq);
  for (float& v : cloud.means_m) v += 0.05F;
  constexpr std::size_t kBudget_bytes = 3000;
  std::vector<std::uint32_t> changed = all_rows(cloud);
  int calls = 0;
  do {
    const auto deltas = stream.publish(cloud, changed, {}, kBudget_bytes);
    std::size_t bytes = 0;
    for (const auto& delta : deltas) bytes += delta.size();
    EXPECT_LT(bytes, 2 * kBudget_bytes);
    apply_all(robot, deltas, seq);
    changed.clear();
    ASSERT_LT(++calls, 60);
  } while (stream.counters().waiting > 0);
  EXPECT_GT(calls, 5);
  EXPECT_LT(worst_mean_error_m(robot, cloud), 0.003F);
  EXPECT_EQ(robot.hash(), stream.position().map_hash);
}

TEST(DeltaStream, TheMostVisibleChangesGoFirst) {
  DeltaStream stream(config_of());
  auto cloud = test::random_gaussians(1000, 1);
  (void)stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes);
  for (std::size_t row = 0; row < 1000; ++row) {
    const bool large = row % 10 == 0;
    for (std::size_t k = 0; k < 3; ++k) cloud.sh[3 * row + k] += large ? 1.0F : 0.2F;
  }
  const auto deltas = stream.publish(cloud, all_rows(cloud), {}, 1000);
  ASSERT_EQ(deltas.size(), 1U);
  const auto update = std::get<map::UpdateBody>(map::decode_delta(deltas[0])->body);
  std::size_t large = 0;
  for (const auto& id : update.differences.ids) large += (id.counter() - 1) % 10 == 0 ? 1U : 0U;
  EXPECT_GT(large * 2, update.differences.size());
}

TEST(DeltaStream, WhatNobodySeesCostsNothing) {
  DeltaStream stream(config_of());
  auto cloud = test::random_gaussians(500, 1);
  (void)stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes);
  EXPECT_TRUE(stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes).empty());
  for (float& v : cloud.sh) v += 0.002F;
  EXPECT_TRUE(stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes).empty());
  EXPECT_EQ(stream.counters().waiting, 0U);
}

TEST(DeltaStream, RowsThatAreNotFiniteArePassedOver) {
  DeltaStream stream(config_of());
  auto cloud = test::random_gaussians(10, 1);
  cloud.means_m[4] = std::numeric_limits<float>::quiet_NaN();
  map::MapState robot;
  std::uint64_t seq = 0;
  apply_all(robot, stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes), seq);
  EXPECT_EQ(robot.size(), 9U);
  EXPECT_EQ(stream.counters().unquantisable, 1U);
}

TEST(DeltaStream, ReposeMovesBothSidesAlikeAndNeedsNoUpdates) {
  DeltaStream stream(config_of());
  map::MapState robot;
  std::uint64_t seq = 0;
  auto cloud = test::random_gaussians(2000, 1);
  apply_all(robot, stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes), seq);
  map::PoseCorrection correction{3, 1, {}, {}};
  correction.new_map_from_body.translation_m = {3.0, -0.5, 0.125};
  correction.new_map_from_body.rotation = Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ());
  const auto deltas = stream.repose(std::span(&correction, 1));
  ASSERT_EQ(deltas.size(), 1U);
  EXPECT_LT(deltas[0].size(), 150U);
  apply_all(robot, deltas, seq);
  EXPECT_EQ(robot.hash(), stream.position().map_hash);
  const map::Repose repose(std::span(&correction, 1));
  for (std::size_t row = 0; row < cloud.size(); ++row) EXPECT_TRUE(repose.move(cloud, row));
  EXPECT_LT(worst_mean_error_m(robot, cloud), 3e-4F);
  // A few lie where the floats end in another chunk than the integers, or round to a larger turn.
  (void)stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes);
  const auto counters = stream.counters();
  EXPECT_LT(counters.updated + counters.added - 2000, 80U);
}

map::MapRequest request_of(map::RequestKind kind, std::uint64_t seq, std::uint64_t until = 0) {
  map::MapRequest request;
  request.kind = kind;
  request.epoch.value = 7;
  request.seq = seq;
  request.until_seq = until;
  return request;
}

TEST(DeltaStream, ResendsWhatItKeepsByteForByte) {
  DeltaStream stream(config_of(100));
  const auto cloud = test::random_gaussians(1000, 1);
  const auto deltas = stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes);
  const auto again = stream.answer(request_of(map::RequestKind::kResend, 3, 6), HostTime{});
  ASSERT_EQ(again.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(again[i], deltas[3 + i]);
  EXPECT_TRUE(stream.answer(request_of(map::RequestKind::kResend, 10, 20), HostTime{}).empty());
  auto other_epoch = request_of(map::RequestKind::kResend, 3, 6);
  other_epoch.epoch.value = 6;
  EXPECT_TRUE(stream.answer(other_epoch, HostTime{}).empty());
}

TEST(DeltaStream, SendsNoMoreThanSoManyDeltasAtOnceAndGoesOn) {
  DeltaStreamConfig config = config_of(10);
  config.max_deltas = 7;
  DeltaStream stream(config);
  const auto cloud = test::random_gaussians(200, 1);
  EXPECT_EQ(stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes).size(), 7U);
  EXPECT_EQ(stream.counters().waiting, 130U);
  EXPECT_EQ(stream.publish(cloud, {}, {}, kPlenty_bytes).size(), 7U);
  EXPECT_EQ(stream.publish(cloud, {}, {}, kPlenty_bytes).size(), 6U);
  EXPECT_EQ(stream.counters().waiting, 0U);
}

TEST(DeltaStream, ARingThatHasForgottenLeadsToASnapshot) {
  DeltaStreamConfig config = config_of(10);
  config.ring_deltas = 5;
  config.max_deltas = 1000;
  DeltaStream stream(config);
  const auto cloud = test::random_gaussians(1000, 1);
  (void)stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes);
  EXPECT_TRUE(stream.answer(request_of(map::RequestKind::kResend, 3, 6), HostTime{}).empty());
  const auto deltas = stream.publish(cloud, {}, {}, kPlenty_bytes);
  ASSERT_FALSE(deltas.empty());
  EXPECT_EQ(map::decode_delta_header(deltas[0])->base_seq, 0U);
  map::MapState robot;
  std::uint64_t seq = 100;
  apply_all(robot, deltas, seq);
  EXPECT_EQ(robot.size(), 1000U);
  EXPECT_EQ(robot.hash(), stream.position().map_hash);
}

TEST(DeltaStream, ASnapshotComesNearestFirstAndNoFasterThanItIsTaken) {
  DeltaStreamConfig config = config_of();
  config.window_bytes = 2000;
  DeltaStream stream(config);
  auto cloud = test::random_gaussians(4000, 1);
  (void)stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes);
  auto ask = request_of(map::RequestKind::kSnapshot, 0);
  ask.robot_in_map_m = {24.0F, 24.0F, 24.0F};
  EXPECT_TRUE(stream.answer(ask, HostTime{}).empty());
  map::MapState robot;
  std::uint64_t seq = stream.position().seq;
  int rounds = 0;
  float last_m = 0.0F;
  while (robot.size() < cloud.size()) {
    for (float& v : cloud.sh) v += 0.02F;  // goes on changing meanwhile
    const auto deltas = stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes);
    std::size_t chunk_bytes = 0;
    for (const auto& bytes : deltas) {
      const auto delta = *map::decode_delta(bytes);
      const auto* part = std::get_if<map::ChunkReplaceBody>(&delta.body);
      if (part == nullptr) continue;
      chunk_bytes += bytes.size();
      const Eigen::Vector3f centre_m(10.0F * static_cast<float>(part->chunk.x) + 5.0F,
                                     10.0F * static_cast<float>(part->chunk.y) + 5.0F,
                                     10.0F * static_cast<float>(part->chunk.z) + 5.0F);
      const float distance_m = (centre_m - ask.robot_in_map_m).norm();
      EXPECT_GE(distance_m, last_m);
      last_m = distance_m;
    }
    EXPECT_LT(chunk_bytes, 2000U + 1500U);  // the window, and the part that crosses it
    apply_all(robot, deltas, seq);
    EXPECT_EQ(robot.hash(), stream.position().map_hash);
    (void)stream.answer(request_of(map::RequestKind::kMore, seq), HostTime{});
    ASSERT_LT(++rounds, 300);
  }
  EXPECT_GT(rounds, 10);
}

TEST(DeltaStream, ASecondAskingDoesNotBeginASecondSnapshot) {
  DeltaStream stream(config_of());
  const auto cloud = test::random_gaussians(500, 1);
  (void)stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes);
  (void)stream.answer(request_of(map::RequestKind::kSnapshot, 1), HostTime{});
  const auto deltas = stream.publish(cloud, {}, {}, kPlenty_bytes);
  const auto again =
      stream.answer(request_of(map::RequestKind::kSnapshot, 1), HostTime(std::chrono::seconds(1)));
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0], deltas[0]);
  EXPECT_EQ(stream.counters().snapshots, 1U);
}

TEST(DeltaStream, AChunkGivenUpIsLeftAloneUntilItIsWantedAgain) {
  DeltaStream stream(config_of());
  auto cloud = test::random_gaussians(2000, 1);
  map::MapState robot;
  std::uint64_t seq = 0;
  apply_all(robot, stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes), seq);
  const map::ChunkId chunk = robot.rows().chunks[0];
  auto release = request_of(map::RequestKind::kRelease, seq);
  release.chunks = {chunk};
  (void)stream.answer(release, HostTime{});
  (void)stream.answer(release, HostTime{});
  for (float& v : cloud.sh) v += 0.5F;
  apply_all(robot, stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes), seq);
  EXPECT_EQ(robot.chunks().chunk_value(chunk), 0U);
  EXPECT_EQ(robot.hash(), stream.position().map_hash);
  auto fetch = request_of(map::RequestKind::kFetch, seq);
  fetch.chunks = {chunk};
  (void)stream.answer(fetch, HostTime{});
  apply_all(robot, stream.publish(cloud, {}, {}, kPlenty_bytes), seq);
  EXPECT_EQ(robot.size(), cloud.size());
  EXPECT_EQ(robot.hash(), stream.position().map_hash);
}

/// The keyframes of each kMapped delta.
std::vector<std::vector<std::uint32_t>> mapped_in(const std::vector<Bytes>& deltas) {
  std::vector<std::vector<std::uint32_t>> told;
  for (const auto& bytes : deltas) {
    const auto delta = map::decode_delta(bytes);
    EXPECT_TRUE(delta.has_value());
    if (const auto* body = std::get_if<map::MappedBody>(&delta->body)) told.push_back(body->keyframes);
  }
  return told;
}
using Told = std::vector<std::vector<std::uint32_t>>;

TEST(DeltaStream, AKeyframeIsToldMappedWhenAllThatCameOfItIsSent) {
  DeltaStream stream(config_of(50));
  const auto cloud = test::random_gaussians(200, 1);
  const std::uint32_t keyframes[] = {9, 3};
  stream.mapped(keyframes);
  auto deltas = stream.publish(cloud, all_rows(cloud), {}, 100);  // room for one delta
  EXPECT_TRUE(mapped_in(deltas).empty());
  for (int i = 0; i < 20 && stream.position().gaussians < cloud.size(); ++i) {
    EXPECT_TRUE(mapped_in(deltas).empty());
    deltas = stream.publish(cloud, {}, {}, 100);
  }
  EXPECT_EQ(mapped_in(deltas), (Told{{3, 9}}));
  EXPECT_TRUE(mapped_in(stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes)).empty());
}

TEST(DeltaStream, AfterASnapshotEveryKeyframeIsToldAgainBehindItsLastChunk) {
  DeltaStreamConfig config = config_of();
  config.window_bytes = 1;  // a chunk at a time
  DeltaStream stream(config);
  const auto cloud = test::random_gaussians(300, 1);  // several chunks
  const std::uint32_t first[] = {1};
  const std::uint32_t second[] = {2};
  stream.mapped(first);
  EXPECT_EQ(mapped_in(stream.publish(cloud, all_rows(cloud), {}, kPlenty_bytes)), (Told{{1}}));
  (void)stream.answer({}, HostTime(std::chrono::seconds(100)));
  stream.mapped(second);
  Told told;
  for (int i = 0; i < 400 && told.empty(); ++i) {
    const auto deltas = stream.publish(cloud, {}, {}, kPlenty_bytes);
    told = mapped_in(deltas);
    EXPECT_EQ(told.empty(), stream.counters().waiting_chunks > 0);
    stream.confirmed(config.epoch, stream.position().seq);
  }
  EXPECT_EQ(told, (Told{{1, 2}}));
  EXPECT_EQ(stream.position().gaussians, cloud.size());
}

}  // namespace
}  // namespace edgesplat::stream
