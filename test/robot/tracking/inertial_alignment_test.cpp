// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Against a motion that is known in closed form: what the IMU feels and where the body is, with noise and
// biases put in.
#include "robot/tracking/inertial_alignment.hpp"

#include "common/geometry/so3.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

const Vector3d kNone = Vector3d::Zero();
const Vector3d kGravity(0.0, 0.0, -9.81);
const Vector3d kGyroBias(0.012, -0.021, 0.008);
const Vector3d kAccelBias(0.06, -0.04, 0.05);

/// Angles yaw, pitch, roll and a position, each a constant speed and a swing.
struct Motion {
  Vector3d angle_rate_radps = Vector3d::Zero();
  Vector3d angle_swing_rad = Vector3d::Zero();
  Vector3d speed_mps = Vector3d::Zero();
  Vector3d swing_m = Vector3d::Zero();
  double swing_radps = 2.0 * std::numbers::pi;  // one a second

  [[nodiscard]] Eigen::Quaterniond rotation(double t) const {
    const Vector3d a = angle_rate_radps * t + angle_swing_rad * std::sin(swing_radps * t);
    return Eigen::AngleAxisd(a.x(), Vector3d::UnitZ()) * Eigen::AngleAxisd(a.y(), Vector3d::UnitY()) *
           Eigen::AngleAxisd(a.z(), Vector3d::UnitX());
  }
  [[nodiscard]] Vector3d position(double t) const {
    return speed_mps * t + swing_m * (1.0 - std::cos(swing_radps * t));
  }
  [[nodiscard]] Vector3d velocity(double t) const {
    return speed_mps + swing_radps * swing_m * std::sin(swing_radps * t);
  }
  [[nodiscard]] Vector3d acceleration(double t) const {
    return swing_radps * swing_radps * swing_m * std::cos(swing_radps * t);
  }
  [[nodiscard]] Vector3d rate(double t) const {
    constexpr double kStep_s = 1e-5;
    return geometry::so3_log(rotation(t - kStep_s).conjugate() * rotation(t + kStep_s)) / (2.0 * kStep_s);
  }
};

/// A robot that turns, pitches and rolls on its way at 1 m/s.
const Motion kLively{{0.6, 0.0, 0.0}, {0.3, 0.15, 0.2}, {1.0, 0.2, 0.0}, {0.15, 0.1, 0.05}};
/// One that is turned by hand, through two radians in four seconds.
const Motion kTumbling{{0.3, 0.5, 0.6}, {0.2, 0.1, 0.1}, {0.5, 0.2, 0.0}, {0.15, 0.1, 0.05}};
/// An ICM-40609, as in a Mid-360: its data sheet's noise, twice. The rig's default stands for anything.
const sensor::ImuModel kMid360Imu{1.6e-4, 1.4e-3, 2e-5, 2e-4, 200.0};
/// What the poses' frame is: any attitude.
const geometry::RigidTransform kLocalFromWorld{geometry::so3_exp({0.7, -1.1, 0.4}), {3.0, -2.0, 1.0}};

struct Recording {
  std::vector<ScanPose> poses;
  std::vector<sync::GroupImu> imu;
};

HostTime at(double t) {
  return HostTime(from_seconds(100.0 + t));
}

/// `span_s` of poses at 10 Hz and samples at 200 Hz with the rig's noise; poses err by 2 mm and 0.7
/// mrad.
Recording record(const Motion& motion, double span_s, std::uint64_t seed = 1,
                 const sensor::ImuModel& model = {}) {
  test::Random random(seed);
  const double gyro_sigma = model.gyro_noise_radps_per_sqrt_hz * std::sqrt(model.rate_hz);
  const double accel_sigma = model.accel_noise_mps2_per_sqrt_hz * std::sqrt(model.rate_hz);
  const auto noise = [&](double sigma) -> Vector3d { return random.vector(std::sqrt(3.0) * sigma); };
  Recording made;
  const double sigma_m = 0.002;
  const double sigma_rad = sigma_m / 3.0;
  for (double t = 0.0; t < span_s + 1e-9; t += 0.1) {
    const geometry::RigidTransform pose =
        kLocalFromWorld * geometry::RigidTransform{motion.rotation(t), motion.position(t)};
    ScanPose scan{at(t), pose, Eigen::Matrix<double, 6, 6>::Zero()};
    scan.local_from_body.rotation = pose.rotation * geometry::so3_exp(noise(sigma_rad));
    scan.local_from_body.translation_m += noise(sigma_m);
    scan.covariance.diagonal().head<3>().setConstant(sigma_rad * sigma_rad);
    scan.covariance.diagonal().tail<3>().setConstant(sigma_m * sigma_m);
    made.poses.push_back(scan);
  }
  for (double t = -0.0023; t < span_s + 0.005; t += 0.005) {
    const Vector3d force = motion.rotation(t).conjugate() * (motion.acceleration(t) - kGravity);
    made.imu.push_back(
        {at(t), motion.rate(t) + kGyroBias + noise(gyro_sigma), force + kAccelBias + noise(accel_sigma)});
  }
  return made;
}

InertialAlignment align(const Recording& recording, const sensor::ImuModel& model = {}) {
  return align_inertial(recording.poses, recording.imu, model, {});
}

double degrees_between(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

/// Squared errors of what was found in units of what it says of itself, mean over the states, at time `t`.
double mean_square_sigmas(const FilterBelief& found, const Motion& motion, double t) {
  FilterState truth = found.state;
  truth.odom_from_body = kLocalFromWorld * geometry::RigidTransform{motion.rotation(t), motion.position(t)};
  truth.velocity_in_odom_mps = kLocalFromWorld.rotation * motion.velocity(t);
  truth.gyro_bias_radps = kGyroBias;
  truth.accel_bias_mps2 = kAccelBias;
  truth.gravity_in_odom_mps2 = kLocalFromWorld.rotation * kGravity;
  const ErrorVector error = minus(truth, found.state);
  double sum = 0.0;
  for (int k = 0; k < kErrorSize; ++k)
    if (k != kGain) sum += error(k) * error(k) / found.covariance(k, k);
  return sum / (kErrorSize - 1);
}

TEST(AlignInertial, FindsGravityVelocityAndBiasesOfALivelyMotion) {
  double square_sum = 0.0;
  constexpr int kRounds = 10;
  for (std::uint64_t seed = 1; seed <= kRounds; ++seed) {
    InertialAlignment found = align(record(kTumbling, 4.0, seed, kMid360Imu), kMid360Imu);
    ASSERT_EQ(found.verdict, AlignmentVerdict::kAligned) << seed;
    EXPECT_NEAR(found.gravity_mps2, 9.81, 0.05);
    EXPECT_LT(found.chi_squared_per_dof, 2.0);
    square_sum += mean_square_sigmas(found.belief, kTumbling, 4.0) / kRounds;
    hold_gravity_norm(found.belief);
    const FilterState& state = found.belief.state;
    EXPECT_LT(degrees_between(state.gravity_in_odom_mps2, kLocalFromWorld.rotation * kGravity), 0.2) << seed;
    EXPECT_LT((state.velocity_in_odom_mps - kLocalFromWorld.rotation * kTumbling.velocity(4.0)).norm(), 0.03);
    EXPECT_LT((state.gyro_bias_radps - kGyroBias).norm(), 0.004);
    EXPECT_LT((state.accel_bias_mps2 - kAccelBias).norm(), 0.05);
  }
  EXPECT_GT(square_sum, 0.3);
  EXPECT_LT(square_sum, 2.0);
}

TEST(AlignInertial, SmallerTurnsLeaveAPartOfTheAccelerometersBiasInTheLevel) {
  double square_sum = 0.0;
  constexpr int kRounds = 10;
  for (std::uint64_t seed = 1; seed <= kRounds; ++seed) {
    const InertialAlignment found = align(record(kLively, 2.0, seed));
    ASSERT_EQ(found.verdict, AlignmentVerdict::kAligned) << seed;
    const FilterState& state = found.belief.state;
    EXPECT_LT(degrees_between(state.gravity_in_odom_mps2, kLocalFromWorld.rotation * kGravity), 0.7) << seed;
    EXPECT_LT((state.velocity_in_odom_mps - kLocalFromWorld.rotation * kLively.velocity(2.0)).norm(), 0.03);
    square_sum += mean_square_sigmas(found.belief, kLively, 2.0) / kRounds;
  }
  EXPECT_GT(square_sum, 0.3);
  EXPECT_LT(square_sum, 2.0);
}

TEST(AlignInertial, OneSecondAtAConstantSpeedGivesTheLevelAsFarAsTheBiasAllows) {
  const Motion straight{kNone, kNone, {1.0, 0.0, 0.0}, kNone};
  const InertialAlignment found = align(record(straight, 1.0));
  ASSERT_EQ(found.verdict, AlignmentVerdict::kAligned);
  const Vector3d gravity = kLocalFromWorld.rotation * kGravity;
  // 0.07 m/s^2 of bias look like 0.4 degrees.
  EXPECT_LT(degrees_between(found.belief.state.gravity_in_odom_mps2, gravity), 1.0);
  EXPECT_GT(found.tilt_sigma_rad, 0.01);
  EXPECT_LT((found.belief.state.velocity_in_odom_mps - kLocalFromWorld.rotation * Vector3d(1, 0, 0)).norm(),
            0.02);
  EXPECT_LT((found.belief.state.gyro_bias_radps - kGyroBias).norm(), 0.006);
}

TEST(AlignInertial, RefusesAForceThatIsNotTheEarths) {
  // Poses at rest, an accelerometer that feels nothing: free fall, or a sensor that is off.
  Recording falling = record(Motion{}, 1.5);
  for (auto& sample : falling.imu) sample.accel_mps2 -= Vector3d(0, 0, 9.81);
  EXPECT_EQ(align(falling).verdict, AlignmentVerdict::kGravityNorm);
  Recording wrong_unit = record(kLively, 1.5);
  for (auto& sample : wrong_unit.imu) sample.accel_mps2 /= 9.81;
  EXPECT_NE(align(wrong_unit).verdict, AlignmentVerdict::kAligned);
}

TEST(AlignInertial, FallsWithTheBodyWhereThePosesFallToo) {
  // In free fall poses and samples agree: the poses speed up by what the samples do not feel.
  const Motion motion{{0.3, 0.0, 0.0}, {0.1, 0.1, 0.1}, {0.5, 0.0, 0.0}, kNone};
  Recording falling = record(motion, 1.0);
  for (auto& pose : falling.poses) {
    const double t = to_seconds(pose.stamp - at(0.0));
    pose.local_from_body.translation_m += kLocalFromWorld.rotation * (0.5 * t * t * kGravity);
  }
  for (auto& sample : falling.imu)
    sample.accel_mps2 += motion.rotation(to_seconds(sample.stamp - at(0.0))).conjugate() * kGravity;
  const InertialAlignment found = align(falling);
  ASSERT_EQ(found.verdict, AlignmentVerdict::kAligned);
  EXPECT_LT(degrees_between(found.belief.state.gravity_in_odom_mps2, kLocalFromWorld.rotation * kGravity),
            0.7);
}

TEST(AlignInertial, RefusesWhatContradictsItself) {
  // Poses of another motion than the samples'.
  Recording mixed = record(kLively, 1.5);
  const Recording other = record(Motion{{-0.6, 0.0, 0.0}, {0.0, 0.2, 0.0}, {0.0, 1.0, 0.0}, kNone}, 1.5);
  mixed.poses = other.poses;
  EXPECT_EQ(align(mixed).verdict, AlignmentVerdict::kResidual);
  // One pose that jumped by 0.3 m.
  Recording jump = record(kLively, 1.5);
  jump.poses[8].local_from_body.translation_m.x() += 0.3;
  EXPECT_EQ(align(jump).verdict, AlignmentVerdict::kResidual);
}

TEST(AlignInertial, RefusesGapsAndTooFewPoses) {
  Recording gap = record(kLively, 1.5);
  std::erase_if(gap.imu, [](const sync::GroupImu& s) { return s.stamp > at(0.63) && s.stamp < at(0.71); });
  EXPECT_EQ(align(gap).verdict, AlignmentVerdict::kImuGap);
  Recording late = record(kLively, 1.5);
  std::erase_if(late.imu, [](const sync::GroupImu& s) { return s.stamp > at(1.4); });
  EXPECT_EQ(align(late).verdict, AlignmentVerdict::kImuGap);
  Recording none = record(kLively, 1.5);
  none.imu.clear();
  EXPECT_EQ(align(none).verdict, AlignmentVerdict::kImuGap);
  Recording few = record(kLively, 1.5);
  few.poses.resize(3);
  EXPECT_EQ(align(few).verdict, AlignmentVerdict::kTooFewPoses);
  EXPECT_EQ(align({}).verdict, AlignmentVerdict::kTooFewPoses);
}

TEST(AlignInertial, RefusesADirectionThatTheScansDoNotSee) {
  // A tunnel along x: positions along it are a guess.
  Recording tunnel = record(kLively, 1.0);
  const Eigen::Matrix3d turn = kLocalFromWorld.rotation.toRotationMatrix();
  for (auto& pose : tunnel.poses)
    pose.covariance.bottomRightCorner<3, 3>() += turn.col(0) * turn.col(0).transpose();
  const InertialAlignment found = align(tunnel);
  EXPECT_EQ(found.verdict, AlignmentVerdict::kUnobservable);
  EXPECT_GT(found.tilt_sigma_rad, 0.03);
}

TEST(AlignInertial, LevelsTheBelief) {
  InertialAlignment found = align(record(kLively, 2.0));
  hold_gravity_norm(found.belief);
  EXPECT_NEAR(found.belief.state.gravity_in_odom_mps2.norm(), 9.81, 0.01);
  geometry::RigidTransform odom_from_local;
  const FilterBelief level = levelled(found.belief, odom_from_local);
  EXPECT_LT(degrees_between(level.state.gravity_in_odom_mps2, kGravity), 1e-6);
  EXPECT_TRUE(level.state.odom_from_body.translation_m.isZero());
  const geometry::RigidTransform moved = odom_from_local * found.belief.state.odom_from_body;
  EXPECT_TRUE(moved.matrix().isApprox(level.state.odom_from_body.matrix(), 1e-9));
  // Heading 0: the body's x axis lies over odom's.
  const Vector3d ahead = level.state.odom_from_body.rotation * Vector3d::UnitX();
  EXPECT_NEAR(ahead.y(), 0.0, 0.05);
  EXPECT_GT(ahead.x(), 0.9);
  EXPECT_NEAR(level.covariance.trace(), found.belief.covariance.trace(), 1e-9);
}

}  // namespace
}  // namespace edgesplat::tracking
