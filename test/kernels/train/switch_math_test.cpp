// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/switch_math.hpp"

#include <gtest/gtest.h>

namespace edgesplat::train {
namespace {

constexpr double kFactor = 0.3;
constexpr double kStep = 1e-5;

/// Some loss of what is drawn, and its derivative by the drawn opacity's logit.
double render_loss(double drawn_logit) {
  const double o = sigmoid(drawn_logit);
  return std::sin(3.0 * o) + o * o;
}
double by_drawn_logit(double drawn_logit) {
  const double o = sigmoid(drawn_logit);
  return (3.0 * std::cos(3.0 * o) + 2.0 * o) * o * (1.0 - o);
}
double loss(double base, double switched) {
  return render_loss(switched_logit(base, switched)) + kFactor * sigmoid(switched);
}

TEST(SwitchMath, GradientsAreThoseOfDifferences) {
  for (const double base : {-4.0, -0.5, 0.0, 1.7, 6.0}) {
    for (const double switched : {-5.0, -1.0, 0.0, 2.2, 5.0}) {
      const auto by = switch_backward(base, switched, by_drawn_logit(switched_logit(base, switched)));
      const double of_base = (loss(base + kStep, switched) - loss(base - kStep, switched)) / (2.0 * kStep);
      const double of_switch = (loss(base, switched + kStep) - loss(base, switched - kStep)) / (2.0 * kStep);
      EXPECT_NEAR(by.base, of_base, 1e-8) << base << " " << switched;
      EXPECT_NEAR(by.switched + switch_cost_backward(switched, kFactor), of_switch, 1e-8)
          << base << " " << switched;
    }
  }
}

TEST(SwitchMath, TheBaseIsFoundAgain) {
  for (const double base : {-6.0, -1.0, 0.0, 3.0}) {
    for (const double switched : {-3.0, 0.0, 4.0})
      EXPECT_NEAR(base_logit(switched_logit(base, switched), switched), base, 1e-9);
  }
  EXPECT_GT(base_logit(3.0, 1.0), 10.0) << "more is drawn than the switch lets through: as solid as it gets";
}

TEST(SwitchMath, TheCostAlwaysPullsDown) {
  // An L1 term on the logit would push a switch below one half up again.
  for (const double switched : {-8.0, -2.0, 0.0, 3.0})
    EXPECT_GT(switch_cost_backward(switched, kFactor), 0.0);
}

}  // namespace
}  // namespace edgesplat::train
