// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// A real IMU (EuRoC MH_01) against its ground truth: one second of propagation must err as the covariance
// says.
#include "common/geometry/so3.hpp"
#include "common/io/trajectory_file.hpp"
#include "robot/tracking/propagation.hpp"
#include "tools/desk/imu_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;
const std::filesystem::path kData =
    std::filesystem::path(EDGESPLAT_SOURCE_DIR) / "../shared/data/euroc_mh01_imu_gt";

class Euroc : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kData)) GTEST_SKIP() << kData << " is absent";
    const auto poses = io::read_tum(kData / "MH_01_easy_groundtruth_tum.txt");
    ASSERT_TRUE(poses.has_value()) << poses.error().context;
    truth_ = *poses;
    const auto samples = desk::read_imu_csv(kData / "mav0/imu0/data.csv");
    ASSERT_TRUE(samples.has_value()) << samples.error().context;
    for (const auto& sample : *samples)
      imu_.push_back({sample.arrival, sample.gyro_radps, sample.accel_mps2});
    model_.gyro_noise_radps_per_sqrt_hz = 1.7e-4;  // the data set's own figures
    model_.accel_noise_mps2_per_sqrt_hz = 2.0e-3;
    model_.gyro_bias_walk_radps2_per_sqrt_hz = 1.94e-5;
    model_.accel_bias_walk_mps3_per_sqrt_hz = 3.0e-3;
  }

  /// True pose i with the velocity from the poses 20 ms before and after it.
  FilterState state_at(std::size_t i) const {
    FilterState state;
    state.odom_from_body = truth_[i].world_from_body;
    const auto& before = truth_[i - 4];
    const auto& after = truth_[i + 4];
    state.velocity_in_odom_mps =
        (after.world_from_body.translation_m - before.world_from_body.translation_m) /
        to_seconds(after.stamp - before.stamp);
    state.gyro_bias_radps = gyro_bias_;
    state.accel_bias_mps2 = accel_bias_;
    return state;
  }
  Prediction predict_from(std::size_t i, std::size_t until) const {
    FilterBelief belief{state_at(i), ErrorMatrix::Zero()};
    const auto set = [&](int index, double sigma) {
      belief.covariance.diagonal().segment<3>(index).setConstant(sigma * sigma);
    };
    set(kRot, 2e-3);       // the truth's attitude
    set(kPos, 2e-3);       // the tracker's millimetre
    set(kVel, 1e-2);       // differences of positions 40 ms apart
    set(kGyroBias, 1e-3);  // of the two biases fitted below
    set(kAccelBias, 2e-2);
    const Interval interval{truth_[i].stamp, truth_[until].stamp};
    const auto first =
        std::lower_bound(imu_.begin(), imu_.end(), interval.begin - std::chrono::milliseconds(10),
                         [](const auto& sample, HostTime t) { return sample.stamp < t; });
    const auto last = std::lower_bound(first, imu_.end(), interval.end + std::chrono::milliseconds(10),
                                       [](const auto& sample, HostTime t) { return sample.stamp < t; });
    return predict_with_imu(belief, std::span(first, last), model_, {}, interval);
  }
  /// Mean biases of the first minute in flight, from what propagation without them gets wrong.
  void fit_biases() {
    for (int round = 0; round < 3; ++round) {
      Vector3d turn = Vector3d::Zero(), push = Vector3d::Zero();
      int count = 0;
      for (std::size_t i = 6000; i < 14000; i += kWindow, ++count) {
        const ErrorVector error = minus(predict_from(i, i + kWindow).belief.state, state_at(i + kWindow));
        const double span_s = to_seconds(truth_[i + kWindow].stamp - truth_[i].stamp);
        turn += error.segment<3>(kRot) / span_s;
        push += truth_[i].world_from_body.rotation.conjugate() * error.segment<3>(kVel) / span_s;
      }
      gyro_bias_ += turn / count;
      accel_bias_ += push / count;
    }
  }

  static constexpr std::size_t kWindow = 200;  ///< 1 s
  std::vector<io::StampedPose> truth_;
  std::vector<sync::GroupImu> imu_;
  sensor::ImuModel model_;
  Vector3d gyro_bias_ = Vector3d::Zero();
  Vector3d accel_bias_ = Vector3d::Zero();
};

class EurocSpan : public Euroc, public testing::WithParamInterface<int> {};

TEST_P(EurocSpan, PropagationErrsAsTheCovarianceSays) {
  fit_biases();
  const std::size_t span = kWindow * static_cast<std::size_t>(GetParam());
  int within = 0, count = 0;
  double square_sum = 0.0;
  std::vector<double> position_errors_m;
  for (std::size_t i = 14000; i + span + 4 < truth_.size(); i += kWindow) {
    const Prediction prediction = predict_from(i, i + span);
    const ErrorVector error = minus(prediction.belief.state, state_at(i + span));
    ASSERT_TRUE(prediction.imu_covers);
    for (const int part : {kRot, kPos, kVel}) {
      for (int k = part; k < part + 3; ++k, ++count) {
        const double sigmas = error(k) / std::sqrt(prediction.belief.covariance(k, k));
        within += std::abs(sigmas) < 3.0 ? 1 : 0;
        square_sum += sigmas * sigmas;
      }
    }
    position_errors_m.push_back(error.segment<3>(kPos).norm());
  }
  ASSERT_GT(count, 9 * 80);
  EXPECT_GT(static_cast<double>(within) / count, 0.97);
  EXPECT_GT(square_sum / count, 0.02) << "a covariance this wide says nothing";
  std::sort(position_errors_m.begin(), position_errors_m.end());
  const double median_m = position_errors_m[position_errors_m.size() / 2];
  RecordProperty("median_position_error_mm", static_cast<int>(median_m * 1e3));
  RecordProperty("within_3_sigma_percent", static_cast<int>(100.0 * within / count));
  RecordProperty("mean_square_sigmas_percent", static_cast<int>(100.0 * square_sum / count));
  EXPECT_GT(median_m, 0.001);  // the truth is not that good: less means that it was fed back
  if (GetParam() == 1) {
    EXPECT_LT(median_m, 0.03);
  }
}

INSTANTIATE_TEST_SUITE_P(Seconds, EurocSpan, testing::Values(1, 5, 10), testing::PrintToStringParamName());

}  // namespace
}  // namespace edgesplat::tracking
