// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/map_file.hpp"

#include "common/io/atomic_file.hpp"
#include "common/map/quantised.hpp"
#include "test/common/io/file_size_limit.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/random.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>

namespace edgesplat::store {
namespace {

StoredMap sample(std::size_t count = 2000, int sh_degree = 1) {
  StoredMap map;
  for (std::size_t i = 0; i < 16; ++i) map.map.bytes[i] = static_cast<std::byte>(i);
  map.robot.value = 3;
  map.session = 0x123456789ABCULL;
  map.epoch.value = 9;
  map.next_id_counter = 5000;
  test::Random random(2);
  for (std::uint32_t i = 0; i < 20; ++i) map.poses.push_back({i, i % 3, random.transform()});
  map.gaussians = test::random_gaussians(count, 1, sh_degree);
  return map;
}

std::vector<std::byte> bytes_of(const StoredMap& map, const MapFileOptions& options = {}) {
  std::vector<std::byte> bytes;
  EXPECT_TRUE(write_map(map, options, [&](std::span<const std::byte> part) -> Status {
                bytes.insert(bytes.end(), part.begin(), part.end());
                return {};
              }).has_value());
  return bytes;
}

std::map<std::uint64_t, std::size_t> rows_by_id(const gaussian::GaussianCloud& cloud) {
  std::map<std::uint64_t, std::size_t> rows;
  for (std::size_t row = 0; row < cloud.size(); ++row) rows[cloud.ids[row].packed()] = row;
  return rows;
}

/// Every Gaussian that came back is the one of that name, to the bit or, rounded, within a step.
void expect_same_gaussians(const gaussian::GaussianCloud& back, const gaussian::GaussianCloud& truth,
                           float tolerance_m) {
  ASSERT_TRUE(back.consistent());
  const auto rows = rows_by_id(truth);
  for (std::size_t row = 0; row < back.size(); ++row) {
    const auto found = rows.find(back.ids[row].packed());
    ASSERT_NE(found, rows.end());
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_NEAR(back.means_m[3 * row + k], truth.means_m[3 * found->second + k], tolerance_m);
    ASSERT_EQ(back.anchors[row], truth.anchors[found->second]);
  }
}

TEST(MapFile, FullPrecisionComesBackToTheBit) {
  const StoredMap map = sample();
  const auto loaded = read_map(bytes_of(map));
  ASSERT_TRUE(loaded.has_value()) << loaded.error().context;
  EXPECT_TRUE(loaded->report.whole());
  EXPECT_EQ(loaded->map.map, map.map);
  EXPECT_EQ(loaded->map.robot, map.robot);
  EXPECT_EQ(loaded->map.session, map.session);
  EXPECT_EQ(loaded->map.epoch, map.epoch);
  EXPECT_EQ(loaded->map.next_id_counter, map.next_id_counter);
  ASSERT_EQ(loaded->map.poses.size(), 20U);
  EXPECT_EQ(loaded->map.poses[7].version, 1U);
  EXPECT_EQ(loaded->map.poses[7].map_from_body.translation_m, map.poses[7].map_from_body.translation_m);
  ASSERT_EQ(loaded->map.gaussians.size(), 2000U);
  expect_same_gaussians(loaded->map.gaussians, map.gaussians, 0.0F);
}

TEST(MapFile, WithoutFloatsTheGaussiansAreAsTheRobotHasThem) {
  const StoredMap map = sample();
  const auto bytes = bytes_of(map, {false});
  EXPECT_LT(2 * bytes.size(), bytes_of(map).size());
  const auto loaded = read_map(bytes);
  ASSERT_TRUE(loaded.has_value());
  EXPECT_TRUE(loaded->report.whole());
  EXPECT_EQ(loaded->map.gaussians.size(), 2000U);
  expect_same_gaussians(loaded->map.gaussians, map.gaussians, 1e-4F);
}

TEST(MapFile, AnEmptyMapIsOne) {
  const auto loaded = read_map(bytes_of(sample(0)));
  ASSERT_TRUE(loaded.has_value());
  EXPECT_TRUE(loaded->report.whole());
  EXPECT_EQ(loaded->map.gaussians.size(), 0U);
}

TEST(MapFile, LeavesOutWhatCannotBeQuantised) {
  StoredMap map = sample(10);
  map.gaussians.means_m[3] = std::numeric_limits<float>::quiet_NaN();
  const auto loaded = read_map(bytes_of(map));
  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(loaded->map.gaussians.size(), 9U);
  EXPECT_TRUE(loaded->report.whole());
}

TEST(MapFile, EveryTruncationIsRecoveredOrRefused) {
  const StoredMap map = sample(300, 0);
  const auto bytes = bytes_of(map);
  std::size_t last = 0;
  for (std::size_t n = 0; n < bytes.size(); n += n < 400 ? 1 : 37) {
    const auto loaded = read_map(std::span(bytes).first(n));
    if (!loaded) {
      EXPECT_LT(n, 120U);  // only without a head
      EXPECT_EQ(loaded.error().code, Errc::kCorrupt);
      EXPECT_FALSE(loaded.error().context.empty());
      continue;
    }
    EXPECT_FALSE(loaded->report.whole()) << n;
    EXPECT_EQ(loaded->report.gaussians_lost + loaded->map.gaussians.size(), 300U);
    EXPECT_GE(loaded->map.gaussians.size(), last);
    last = loaded->map.gaussians.size();
    expect_same_gaussians(loaded->map.gaussians, map.gaussians, 1e-4F);
  }
  EXPECT_EQ(last, 300U);  // all but the second head
}

TEST(MapFile, AFlippedBitCostsAtMostOneChunk) {
  const StoredMap map = sample(300, 0);
  auto bytes = bytes_of(map);
  const map::QuantisedRows rows = test::quantised(map.gaussians);
  std::size_t largest = 0;
  for (const auto& chunk : rows.chunks)
    largest = std::max(largest, static_cast<std::size_t>(std::ranges::count(rows.chunks, chunk)));
  for (std::size_t bit = 8 * 6; bit < 8 * bytes.size(); bit += 211) {
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    const auto loaded = read_map(bytes);
    ASSERT_TRUE(loaded.has_value()) << bit;
    EXPECT_FALSE(loaded->report.whole());
    EXPECT_LE(loaded->report.gaussians_lost, largest);
    EXPECT_TRUE(loaded->report.gaussians_lost == 0 || loaded->report.gaussians_rounded == 0);
    expect_same_gaussians(loaded->map.gaussians, map.gaussians, 1e-4F);
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
  }
}

TEST(MapFile, RefusesWhatIsNoneOrOfAnotherVersion) {
  auto bytes = bytes_of(sample(5));
  bytes[4] = std::byte{9};
  const auto newer = read_map(bytes);
  ASSERT_FALSE(newer.has_value());
  EXPECT_NE(newer.error().context.find("version 9"), std::string::npos);
  bytes[0] = std::byte{0};
  EXPECT_FALSE(read_map(bytes).has_value());
  EXPECT_FALSE(read_map({}).has_value());
}

TEST(MapFile, SavesAndLoadsAndReplacesTheOldOne) {
  const test::TempDir folder;
  const auto path = folder.path() / "robot-3.map";
  EXPECT_EQ(load_map(path).error().code, Errc::kNotFound);
  ASSERT_TRUE(save_map(path, sample(100)).has_value());
  ASSERT_TRUE(save_map(path, sample(200)).has_value());
  const auto loaded = load_map(path);
  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(loaded->map.gaussians.size(), 200U);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(MapFile, AFullDiskKeepsTheOldFileAndSaysWhy) {
  const test::TempDir folder;
  const auto path = folder.path() / "robot-3.map";
  ASSERT_TRUE(save_map(path, sample(100)).has_value());
  const auto before = *io::read_file(path, 1U << 30U);
  for (const std::size_t bytes : std::vector<std::size_t>{0, 3, 100, 5000, 50000}) {
    Status saved;
    {
      const io::FileSizeLimit limit(bytes);
      saved = save_map(path, sample(5000));
    }
    ASSERT_FALSE(saved.has_value()) << bytes;
    EXPECT_EQ(saved.error().code, Errc::kIo);
    EXPECT_NE(saved.error().context.find(path.string()), std::string::npos);
    EXPECT_EQ(*io::read_file(path, 1U << 30U), before);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  }
}

}  // namespace
}  // namespace edgesplat::store
