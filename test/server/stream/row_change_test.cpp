// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/row_change.hpp"

#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

namespace edgesplat::stream {
namespace {

using map::Field;

struct Pair {
  gaussian::GaussianCloud truth = test::random_gaussians(1, 1, 1);
  map::QuantisedRows held;
  Pair() {
    truth.log_scales = {-3.0F, -2.5F, -4.0F};
    truth.opacity_logits = {2.0F};
    held = test::quantised(truth);
    truth = map::dequantise(held);
  }
  [[nodiscard]] RowChange change(float tolerance = 1.0F) {
    now = {};
    now.sh_degree = 1;
    const RowChange change = measure_change({truth, 0}, {held, 0}, tolerance);
    told = append_settled({truth, 0}, {held, 0}, change.fields, now);
    return change;
  }
  map::QuantisedRows now;
  bool told = false;
};

map::FieldMask mask(Field field) {
  return static_cast<map::FieldMask>(field);
}

TEST(RowChange, NothingChangedIsNothingToTell) {
  Pair pair;
  const RowChange change = pair.change();
  EXPECT_EQ(change.fields, 0);
  EXPECT_FALSE(pair.told);
  EXPECT_EQ(pair.now.size(), 0U);
}

TEST(RowChange, NamesTheFieldThatChanged) {
  const auto fields = [](auto nudge) {
    Pair pair;
    nudge(pair.truth);
    return pair.change().fields;
  };
  EXPECT_EQ(fields([](auto& c) { c.means_m[1] += 0.01F; }), mask(Field::kPosition));
  EXPECT_EQ(fields([](auto& c) { c.log_scales[2] += 0.2F; }), mask(Field::kLogScale));
  EXPECT_EQ(fields([](auto& c) { c.quats_xyzw[0] += 0.2F; }), mask(Field::kRotation));
  EXPECT_EQ(fields([](auto& c) { c.opacity_logits[0] -= 0.5F; }), mask(Field::kOpacity));
  EXPECT_EQ(fields([](auto& c) { c.sh[2] += 0.2F; }), mask(Field::kColour));
  EXPECT_EQ(fields([](auto& c) { c.sh[7] += 0.1F; }), mask(Field::kSh));
  EXPECT_EQ(fields([](auto& c) { c.anchors[0].keyframe += 1; }), mask(Field::kAnchor));
}

TEST(RowChange, FieldsNobodySeesChangeAreSetBack) {
  Pair pair;
  pair.truth.means_m[0] += 0.0005F;  // a step and more, but a fortieth of the smallest axis
  pair.truth.sh[0] += 0.3F;
  EXPECT_EQ(pair.change().fields, mask(Field::kColour));
  EXPECT_EQ(pair.now.channels[0][0], pair.held.channels[0][0]);
  EXPECT_NE(pair.now.channels[0][map::kColourAt], pair.held.channels[0][map::kColourAt]);
  EXPECT_EQ(pair.change(0.1F).fields, mask(Field::kColour) | mask(Field::kPosition));
}

TEST(RowChange, LargeOpaqueAndMuchChangedGoesFirst) {
  const auto priority = [](float log_scale, float logit, float by) {
    Pair pair;
    pair.truth.log_scales.assign(3, log_scale);
    pair.truth.opacity_logits[0] = logit;
    pair.held = test::quantised(pair.truth);
    pair.truth.sh[0] += by;
    return pair.change().priority;
  };
  EXPECT_GT(priority(-2.0F, 2.0F, 0.3F), priority(-3.0F, 2.0F, 0.3F));
  EXPECT_GT(priority(-3.0F, 2.0F, 0.3F), priority(-3.0F, -2.0F, 0.3F));
  EXPECT_GT(priority(-3.0F, 2.0F, 0.6F), priority(-3.0F, 2.0F, 0.3F));
}

}  // namespace
}  // namespace edgesplat::stream
