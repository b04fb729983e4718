// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// What kernels/core gives to kernels, here on the CPU; and that the runner finds what a GPU would not
// forgive.
#include "kernels/core/device_buffer.cuh"
#include "kernels/core/device_sort.cuh"
#include "kernels/core/warp_sums.cuh"
#include "test/support/cuda_on_cpu/block_runner.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace edgesplat::core {
namespace {

constexpr std::size_t kBudget_bytes = std::size_t{1} << 20U;

class Device : public testing::Test {
 protected:
  template <typename T>
  std::vector<T> back(const DeviceBuffer<T>& buffer, std::size_t count) {
    std::vector<T> values(count);
    EXPECT_TRUE(download(stream_, buffer, std::span<T>(values)));
    EXPECT_TRUE(stream_.synchronise());
    return values;
  }
  Stream stream_ = *Stream::create();
  VramPool pool_{kBudget_bytes};
};

__global__ void sums_kernel(const float* in, float* by_lane, double* by_block) {
  float values[16];
  for (unsigned k = 0; k < 16; ++k) values[k] = in[16 * threadIdx.x + k];
  const float mine = values[3];
  by_lane[threadIdx.x] = warp_sums16(values, threadIdx.x % kWarp);
  const double sum = block_sum<128>(static_cast<double>(mine));
  if (threadIdx.x == 0) *by_block = sum;
}

TEST_F(Device, SumsOverWarpsAndBlocks) {
  test::Random random(1);
  std::vector<float> in(std::size_t{16} * 128);
  for (float& value : in) value = static_cast<float>(random.below(1000));
  DeviceBuffer<float> values(pool_, "a test"), by_lane(pool_, "a test");
  DeviceBuffer<double> by_block(pool_, "a test");
  ASSERT_TRUE(upload(stream_, std::span<const float>(in), values));
  ASSERT_TRUE(by_lane.reserve(128) && by_block.reserve(1));
  ASSERT_TRUE(launch(stream_, {1, 128}, sums_kernel, static_cast<const float*>(values.data()), by_lane.data(),
                     by_block.data()));
  const auto lanes = back(by_lane, 128);
  for (std::size_t t = 0; t < 128; ++t) {
    float expected = 0.0F;
    for (std::size_t lane = t / 32 * 32; lane < t / 32 * 32 + 32; ++lane) expected += in[16 * lane + t % 16];
    EXPECT_EQ(lanes[t], expected) << t;
  }
  double expected = 0.0;
  for (std::size_t t = 0; t < 128; ++t) expected += static_cast<double>(in[16 * t + 3]);
  EXPECT_EQ(back(by_block, 1).front(), expected);
}

TEST_F(Device, SortsByTheLowestBitsAndKeepsTheOrderOfEqualKeys) {
  const std::vector<std::uint32_t> in{5, 0x100 + 2, 2, 5, 1};
  const std::vector<std::uint32_t> numbers{0, 1, 2, 3, 4};
  DeviceBuffer<std::uint32_t> keys(pool_, "a test"), values(pool_, "a test"), keys_out(pool_, "a test"),
      values_out(pool_, "a test");
  ASSERT_TRUE(upload(stream_, std::span(in), keys) && upload(stream_, std::span(numbers), values));
  ASSERT_TRUE(keys_out.reserve(5) && values_out.reserve(5));
  DeviceSort sort(pool_);
  ASSERT_TRUE(sort.sort(stream_, {keys.data(), values.data(), keys_out.data(), values_out.data(), 5}, 8));
  EXPECT_EQ(back(values_out, 5), (std::vector<std::uint32_t>{4, 1, 2, 0, 3}));
  EXPECT_EQ(back(keys_out, 5), (std::vector<std::uint32_t>{1, 0x102, 2, 5, 5}));
  ASSERT_TRUE(sort.exclusive_sum(stream_, keys.data(), keys_out.data(), 5));
  EXPECT_EQ(back(keys_out, 5), (std::vector<std::uint32_t>{0, 5, 0x107, 0x109, 0x10E}));
}

TEST_F(Device, ThePoolKeepsToItsBudget) {
  DeviceBuffer<float> first(pool_, "the first"), second(pool_, "the second");
  ASSERT_TRUE(first.reserve(kBudget_bytes / 8));
  EXPECT_EQ(pool_.used_bytes(), kBudget_bytes / 2);
  const Status refused = second.reserve(kBudget_bytes / 4);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kOutOfVram);
  EXPECT_NE(refused.error().context.find("the second"), std::string::npos) << refused.error().context;
  EXPECT_EQ(second.capacity(), 0U);
  EXPECT_TRUE(second.reserve(100));
  ASSERT_TRUE(first.reserve(100)) << "there is room already";
  EXPECT_EQ(pool_.used_bytes(), kBudget_bytes / 2 + 400);
  EXPECT_EQ(pool_.peak_bytes(), pool_.used_bytes());
}

__global__ void read_other_warp_kernel(unsigned* out, bool with_barrier) {
  __shared__ unsigned written[256];
  written[threadIdx.x] = blockIdx.x + 1;
  if (with_barrier) __syncthreads();
  if (threadIdx.x == 0) out[blockIdx.x] = written[255] == blockIdx.x + 1 ? 1U : 0U;
  __syncthreads();
}

TEST_F(Device, AMissingBarrierShows) {
  DeviceBuffer<unsigned> out(pool_, "a test");
  ASSERT_TRUE(out.reserve(200));
  const auto in_time = [&](bool with_barrier) {
    EXPECT_TRUE(launch(stream_, {200, 256}, read_other_warp_kernel, out.data(), with_barrier));
    const auto seen = back(out, 200);
    return std::count(seen.begin(), seen.end(), 1U);
  };
  EXPECT_EQ(in_time(true), 200);
  const auto by_chance = in_time(false);
  EXPECT_GT(by_chance, 50);
  EXPECT_LT(by_chance, 150);
}

__global__ void half_barrier_kernel() {
  if (threadIdx.x < 32) __syncthreads();
}
__global__ void half_exchange_kernel() {
  if (threadIdx.x < 16) __ballot_sync(kAllLanes, 1);
}

TEST_F(Device, AHangIsSaid) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(static_cast<void>(launch(stream_, {1, 64}, half_barrier_kernel)),
               "barrier that not all threads reach");
  EXPECT_DEATH(static_cast<void>(launch(stream_, {1, 64}, half_exchange_kernel)),
               "do not come to the exchange");
}

TEST_F(Device, NoBlocksAreNoLaunchAndTooManyThreadsAnError) {
  EXPECT_TRUE(launch(stream_, {0, 64}, half_barrier_kernel));
  EXPECT_FALSE(launch(stream_, {1, 2048}, half_barrier_kernel));
}

}  // namespace
}  // namespace edgesplat::core
