// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/atomic_file.hpp"
#include "common/io/image_file.hpp"
#include "run_folder_maker.hpp"
#include "tools/report/report.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace edgesplat::report {
namespace {

using testing::HasSubstr;
using testing::Not;

/// What `edgesplat score` leaves of a real run without server/seeded.ply: four pictures in two blocks.
nlohmann::json real_scores() {
  nlohmann::json scores = {
      {"kind", "real"}, {"movers_masked", true}, {"static_share", 0.38},  {"psnr_db", 24.5},
      {"ssim", 0.81},   {"lpips", nullptr},      {"psnr_nearest_db", 21}, {"psnr_seeded_db", nullptr}};
  for (int i = 0; i < 4; ++i) {
    scores["views"].push_back({{"pictures", "00" + std::to_string(i)},
                               {"block", i / 2},
                               {"static_share", 0.3 + 0.01 * i},
                               {"psnr_db", 24.0 + i},
                               {"psnr_nearest_db", 20.0 + i},
                               {"psnr_seeded_db", nullptr}});
  }
  return scores;
}

class HeldOutReport : public testing::Test {
 protected:
  void SetUp() override {
    const auto* name = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::path(testing::TempDir()) / ("edgesplat_report_" + std::string(name));
    ASSERT_TRUE(make_run_folder(folder_));
    std::filesystem::create_directories(folder_ / "heldout");
  }
  void save_pictures(const char* what) const {
    for (int i = 0; i < 4; ++i) {
      const std::string name = "00" + std::to_string(i) + "_" + what + ".png";
      ASSERT_TRUE(io::save_image(folder_ / "heldout" / name, sensor::ImageRgb8(32, 24, 90)));
    }
  }
  /// The page of a run with these scores.
  std::string page_with(const nlohmann::json& scores) {
    EXPECT_TRUE(io::write_file_atomically(folder_ / "heldout.json", scores.dump()));
    const auto report = write_report({folder_, {}, 4});
    EXPECT_TRUE(report) << report.error().context;
    report_ = *report;
    return io::read_text_file(folder_ / "report.html", 100'000'000).value_or("");
  }
  [[nodiscard]] nlohmann::json summary() const {
    return nlohmann::json::parse(io::read_text_file(folder_ / "summary.json", 1'000'000).value_or(""));
  }

  std::filesystem::path folder_;
  Report report_;
};

TEST_F(HeldOutReport, ARealRunSaysWhatWasHeldOutAndShowsWhatCounts) {
  for (const char* what : {"target", "map", "nearest", "weight"}) save_pictures(what);
  const std::string page = page_with(real_scores());
  EXPECT_TRUE(report_.missing.empty()) << report_.missing.front();
  EXPECT_THAT(page, HasSubstr("4 pictures held out of mapping in 2 blocks"));
  EXPECT_THAT(page, HasSubstr("over the 38 % static pixels: map 24.5 dB, nearest training picture 21.0 dB"));
  EXPECT_THAT(page, HasSubstr("what counts, in white: 33 %"));
  EXPECT_THAT(page, HasSubstr("the robot&#39;s map: 27.0 dB"));
  EXPECT_THAT(page, Not(HasSubstr("before optimising: ")));
  EXPECT_THAT(page, Not(HasSubstr("places between keyframes")));
  EXPECT_THAT(to_text(report_),
              HasSubstr("Map at held-out pictures (PSNR)   24.5 dB over 38 % of the pixels, "
                        "nearest keyframe 21.0"));
  EXPECT_EQ(summary()["psnr_db"], 24.5);
  EXPECT_EQ(summary()["psnr_nearest_db"], 21);
  EXPECT_EQ(summary()["static_share"], 0.38);
  EXPECT_EQ(summary()["ssim"], 0.81);
  EXPECT_TRUE(summary()["psnr_seeded_db"].is_null());
  EXPECT_TRUE(summary()["lpips"].is_null());
}

TEST_F(HeldOutReport, WithoutAMaskThePageSaysThatAllPixelsCount) {
  for (const char* what : {"target", "map", "nearest", "weight"}) save_pictures(what);
  nlohmann::json scores = real_scores();
  scores["movers_masked"] = false;
  for (auto& view : scores["views"]) view.erase("block");
  const std::string page = page_with(scores);
  EXPECT_THAT(page, HasSubstr("4 pictures held out of mapping, from the poses"));
  EXPECT_THAT(page, HasSubstr("over all pixels, movers included for want of a segmentation model"));
}

TEST_F(HeldOutReport, ASimulatedRunHasNoPicturesOfWeights) {
  for (const char* what : {"target", "map", "nearest", "seeded"}) save_pictures(what);
  nlohmann::json scores = real_scores();
  scores["kind"] = "simulated";
  for (auto& view : scores["views"]) view["psnr_seeded_db"] = 18.5;
  const std::string page = page_with(scores);
  EXPECT_TRUE(report_.missing.empty()) << report_.missing.front();
  EXPECT_THAT(page, HasSubstr("4 places between keyframes"));
  EXPECT_THAT(page, HasSubstr("before optimising: 18.5 dB"));
  EXPECT_THAT(page, Not(HasSubstr("what counts, in white")));
  EXPECT_THAT(to_text(report_), HasSubstr("Map between keyframes (PSNR)"));
}

TEST_F(HeldOutReport, ScoresFromBeforeThereWereKindsAreSimulated) {
  const std::string page = page_with({{"psnr_db", 20.0}, {"views", {{{"pictures", "000"}}}}});
  EXPECT_THAT(page, HasSubstr("1 places between keyframes"));
  EXPECT_FALSE(report_.missing.empty());  // its pictures are not there
  EXPECT_TRUE(summary()["psnr_nearest_db"].is_null());
}

}  // namespace
}  // namespace edgesplat::report
