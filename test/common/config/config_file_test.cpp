// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

namespace edgesplat::config {
namespace {

using testing::HasSubstr;

enum class Shade { kDark, kLight };
struct Inner {
  double gain = 1.5;
  std::uint64_t seed = 7;
};
struct Sample {
  double voxel_size_m = 0.5;
  float blur_px = 0.6F;
  int threads = 2;
  bool enabled = true;
  std::string title = "plain";
  Shade shade = Shade::kLight;
  std::vector<double> weights = {1.0, 2.0};
  std::array<double, 3> offset_m = {0.0, 0.0, 0.0};
  Inner inner;
  std::optional<Inner> spare;
};

void describe(ConfigReader& reader, Inner& inner) {
  reader.field("gain", inner.gain, Range{0.0, 10.0}, "amplification");
  reader.field("seed", inner.seed, Range<std::uint64_t>{0, UINT64_MAX}, "of the noise");
}
void describe(ConfigReader& reader, Sample& sample) {
  reader.field("voxel_size_m", sample.voxel_size_m, Range{0.05, 5.0}, "edge of a voxel");
  reader.field("blur_px", sample.blur_px, Range{0.0, 9.0}, "");
  reader.field("threads", sample.threads, Range{1, 16}, "");
  reader.table("inner", "nested", [&] { describe(reader, sample.inner); });
  reader.optional_table("spare", sample.spare, "", [&](Inner& inner) { describe(reader, inner); });
  reader.field("enabled", sample.enabled, "");
  reader.field("title", sample.title, "");
  reader.choice("shade", sample.shade, {{"dark", Shade::kDark}, {"light", Shade::kLight}}, "");
  reader.field("weights", sample.weights, Range{0.0, 100.0}, "", {1, 3});
  reader.fixed("offset_m", sample.offset_m, Range{-1.0, 1.0}, "");
  if (sample.threads > 8 && !sample.enabled) reader.problem("threads", "needs enabled = true above 8");
}

std::string errors_of(const std::string& text) {
  const Result<ConfigFile> file = ConfigFile::parse(text, "a.toml");
  if (!file) return file.error().context;
  Sample sample;
  const Status status = file->read_into(sample);
  return status ? "" : status.error().context;
}

TEST(ConfigFile, KeepsDefaultsOfWhatTheFileLeavesOut) {
  Sample sample;
  ASSERT_TRUE(ConfigFile().read_into(sample));
  EXPECT_EQ(sample.voxel_size_m, 0.5);
  EXPECT_EQ(sample.shade, Shade::kLight);
  EXPECT_FALSE(sample.spare.has_value());
}

TEST(ConfigFile, ReadsEveryKindOfField) {
  const auto file = ConfigFile::parse(
      "voxel_size_m = 1\nthreads = 16\nenabled = false\ntitle = \"a \\\"b\\\"\"\nshade = 'dark'\n"
      "weights = [3, 0.5]\noffset_m = [1, -1, 0.25]\n[inner]\ngain = 2.0\nseed = 9\n[spare]\n",
      "a.toml");
  ASSERT_TRUE(file) << file.error().context;
  Sample sample;
  // threads = 16 with enabled = false breaks the rule between fields, so lift it first.
  ConfigFile fixed = *file;
  ASSERT_TRUE(fixed.apply_override("enabled=true"));
  const Status status = fixed.read_into(sample);
  ASSERT_TRUE(status) << status.error().context;
  EXPECT_EQ(sample.voxel_size_m, 1.0);
  EXPECT_EQ(sample.threads, 16);
  EXPECT_EQ(sample.title, "a \"b\"");
  EXPECT_EQ(sample.shade, Shade::kDark);
  EXPECT_THAT(sample.weights, testing::ElementsAre(3.0, 0.5));
  EXPECT_THAT(sample.offset_m, testing::ElementsAre(1.0, -1.0, 0.25));
  EXPECT_EQ(sample.inner.seed, 9U);
  ASSERT_TRUE(sample.spare.has_value());
  EXPECT_EQ(sample.spare->gain, 1.5);
}

TEST(ConfigFile, ReportsAllProblemsAtOnceInTheOrderOfTheFile) {
  const std::string errors = errors_of(
      "threads = 0\nvoxel_size = 0.1\n\nshade = \"grey\"\nweights = [1, \"x\"]\noffset_m = [1, 2]\n[inner]\n"
      "gain = nan\nzzzzzz = 1\n");
  EXPECT_EQ(errors,
            "a.toml:1: threads: 0 is out of range [1, 16]\n"
            "a.toml:2: voxel_size: unknown key, did you mean \"voxel_size_m\"?\n"
            "a.toml:4: shade: \"grey\" is not one of: dark, light\n"
            "a.toml:5: weights: is a text, must be a number\n"
            "a.toml:6: offset_m: 2.0 is out of range [-1.0, 1.0]\n"
            "a.toml:8: inner.gain: nan is out of range [0.0, 10.0]\n"
            "a.toml:9: inner.zzzzzz: unknown key");
}

TEST(ConfigFile, FieldsInErrorKeepTheirDefault) {
  const auto file = ConfigFile::parse("offset_m = [0.5, 9, 0.5]\nthreads = 3\n", "a.toml");
  Sample sample;
  EXPECT_FALSE(file->read_into(sample));
  EXPECT_THAT(sample.offset_m, testing::ElementsAre(0.0, 0.0, 0.0));
  EXPECT_EQ(sample.threads, 3);
}

TEST(ConfigFile, RefusesWrongTypesAndLengths) {
  EXPECT_THAT(errors_of("threads = 1.5"), HasSubstr("is a number, must be a whole number"));
  EXPECT_THAT(errors_of("threads = 1979-05-27"), HasSubstr("is a date or time"));
  EXPECT_THAT(errors_of("enabled = 1"), HasSubstr("must be true or false"));
  EXPECT_THAT(errors_of("title = 3"), HasSubstr("must be a text"));
  EXPECT_THAT(errors_of("inner = 3"), HasSubstr("must be a table"));
  EXPECT_THAT(errors_of("[threads]"), HasSubstr("is a table"));
  EXPECT_THAT(errors_of("weights = []"), HasSubstr("has 0 numbers, must have 1 to 3"));
  EXPECT_THAT(errors_of("offset_m = [1]"), HasSubstr("has 1 numbers, must have 3"));
}

TEST(ConfigFile, ReportsRulesBetweenFieldsAtTheirPlace) {
  EXPECT_EQ(errors_of("\nthreads = 9\nenabled = false"), "a.toml:2: threads: needs enabled = true above 8");
}

TEST(ConfigFile, SyntaxErrorsHaveALine) {
  const auto file = ConfigFile::parse("a = 1\nb = = 2\n", "bad.toml");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(file.error().context, testing::StartsWith("bad.toml:2: "));
}

TEST(ConfigFile, OverridesWinAndNeedNoQuotes) {
  auto file = ConfigFile::parse("title = 'file'\n[inner]\ngain = 1.0\nseed = 3\n", "a.toml");
  ASSERT_TRUE(file->apply_override("title=street view"));
  ASSERT_TRUE(file->apply_override(" inner.gain = 4.5 "));
  ASSERT_TRUE(file->apply_override("inner.gain=5.5"));
  Sample sample;
  ASSERT_TRUE(file->read_into(sample));
  EXPECT_EQ(sample.title, "street view");
  EXPECT_EQ(sample.inner.gain, 5.5);
  EXPECT_EQ(sample.inner.seed, 3U);
}

TEST(ConfigFile, ProblemsOfOverridesSayWhereTheyComeFrom) {
  ConfigFile file;
  ASSERT_TRUE(file.apply_override("threads=99"));
  ASSERT_TRUE(file.apply_override("inner.gian=1"));
  Sample sample;
  const Status status = file.read_into(sample);
  ASSERT_FALSE(status);
  EXPECT_EQ(
      status.error().context,
      "--set: threads: 99 is out of range [1, 16]\n--set: inner.gian: unknown key, did you mean \"gain\"?");
}

TEST(ConfigFile, RefusesMalformedOverrides) {
  ConfigFile file;
  for (const char* bad : {"", "=", "novalue", "a b=1", "=3", "a.=1", "a=1\nb=2", "[x]=1"})
    EXPECT_FALSE(file.apply_override(bad)) << bad;
}

TEST(ConfigFile, PrintedConfigReadsBackTheSame) {
  Sample before;
  before.voxel_size_m = 0.1;
  before.title = "tab\there \"quoted\" \\ \x01";
  before.offset_m = {0.1, -0.30000000000000004, 1.0};
  before.inner.seed = 123456789012345678;
  before.spare = Inner{2.0, 1};
  const std::string text = to_toml(before);
  EXPECT_THAT(text, HasSubstr("# edge of a voxel, [0.05, 5.0]\nvoxel_size_m = 0.1\n"));
  EXPECT_THAT(text, HasSubstr("\nblur_px = 0.6\n"));  // a float has a float's digits
  const auto file = ConfigFile::parse(text, "printed");
  ASSERT_TRUE(file) << file.error().context << text;
  Sample after;
  const Status status = file->read_into(after);
  ASSERT_TRUE(status) << status.error().context;
  EXPECT_EQ(to_toml(after), text);
  EXPECT_EQ(after.title, before.title);
  EXPECT_EQ(after.offset_m, before.offset_m);
  EXPECT_EQ(after.inner.seed, before.inner.seed);
}

struct Flock {
  std::vector<Inner> birds{Inner{}};
};
void describe(ConfigReader& reader, Flock& flock) {
  const auto fresh = [](std::size_t index) { return Inner{2.0 + static_cast<double>(index), 7}; };
  reader.tables("bird", flock.birds, 3, "each of them", fresh, [&](Inner& bird) { describe(reader, bird); });
}

std::string flock_errors(const std::string& text, const std::string& override_text = "") {
  Result<ConfigFile> file = ConfigFile::parse(text, "a.toml");
  if (!file) return file.error().context;
  if (!override_text.empty()) {
    if (const Status set = file->apply_override(override_text); !set) return set.error().context;
  }
  Flock flock;
  const Status status = file->read_into(flock);
  return status ? "" : status.error().context;
}

TEST(ConfigFile, ATableMayBeOneOrSeveral) {
  const auto read = [](const std::string& text) {
    Flock flock;
    const auto file = ConfigFile::parse(text, "a.toml");
    EXPECT_TRUE(file.has_value());
    EXPECT_TRUE(file->read_into(flock).has_value());
    return flock.birds;
  };
  ASSERT_EQ(read("").size(), 1U);
  EXPECT_EQ(read("").front().gain, 1.5);
  ASSERT_EQ(read("[bird]\ngain = 4.0").size(), 1U);
  EXPECT_EQ(read("[bird]\ngain = 4.0").front().gain, 4.0);
  const auto three = read("[[bird]]\ngain = 4.0\n[[bird]]\nseed = 9\n[[bird]]");
  ASSERT_EQ(three.size(), 3U);
  EXPECT_EQ(three[0].gain, 4.0);
  EXPECT_EQ(three[1].gain, 3.0);  // as a fresh one begins
  EXPECT_EQ(three[1].seed, 9U);
  EXPECT_EQ(three[2].gain, 4.0);
  Flock flock{three};
  const std::string printed = to_toml(flock);
  EXPECT_THAT(printed, HasSubstr("[[bird]]"));
  ASSERT_EQ(read(printed).size(), 3U);
  EXPECT_EQ(read(printed)[1].seed, 9U);
  flock.birds.resize(1);
  EXPECT_THAT(to_toml(flock), HasSubstr("\n[bird]\n"));
}

TEST(ConfigFile, ProblemsOfOneOfSeveralTablesSayOfWhich) {
  EXPECT_THAT(flock_errors("[[bird]]\n[[bird]]\ngian = 1.0"),
              HasSubstr("a.toml:3: bird[1].gian: unknown key, did you mean \"gain\"?"));
  EXPECT_THAT(flock_errors("[[bird]]\ngain = 11.0\n[[bird]]"), HasSubstr("a.toml:2: bird[0].gain: 11"));
  EXPECT_THAT(flock_errors("bird = 3"), HasSubstr("must be a table, or several: [[bird]]"));
  EXPECT_THAT(flock_errors("bird = [1, 2]"), HasSubstr("every element must be a table"));
  EXPECT_THAT(flock_errors("bird = []"), HasSubstr("bird: are 0, must be 1 to 3"));
  EXPECT_THAT(flock_errors("[[bird]]\n[[bird]]\n[[bird]]\n[[bird]]"), HasSubstr("are 4, must be 1 to 3"));
}

TEST(ConfigFile, OverridesReachOneOfSeveralTablesByItsPlace) {
  auto file = ConfigFile::parse("[[bird]]\ngain = 4.0\n[[bird]]", "a.toml");
  ASSERT_TRUE(file.has_value());
  ASSERT_TRUE(file->apply_override("bird.1.gain=5.5").has_value());
  Flock flock;
  ASSERT_TRUE(file->read_into(flock).has_value());
  EXPECT_EQ(flock.birds[0].gain, 4.0);
  EXPECT_EQ(flock.birds[1].gain, 5.5);
  EXPECT_THAT(flock_errors("[[bird]]\n[[bird]]", "bird.gain=1"), HasSubstr("say which, as bird.0.KEY"));
  EXPECT_THAT(flock_errors("[[bird]]\n[[bird]]", "bird.2.gain=1"), HasSubstr("to bird.1.KEY"));
  EXPECT_THAT(flock_errors("[[bird]]\n[[bird]]", "bird.1=1"), HasSubstr("say which"));
  EXPECT_EQ(flock_errors("[bird]", "bird.gain=1"), "");
}

TEST(ConfigFile, SurvivesHostileText) {
  std::string dots = "a";
  for (int i = 0; i < 100000; ++i) dots += ".a";
  EXPECT_FALSE(ConfigFile::parse(dots + " = 1", "deep"));
  EXPECT_FALSE(ConfigFile::parse("a = " + std::string(100000, '['), "brackets"));
  EXPECT_FALSE(ConfigFile::parse(std::string(2U << 20U, '#'), "large"));
  EXPECT_FALSE(ConfigFile::parse(std::string("a = \"\xff\xfe\""), "not UTF-8"));
  EXPECT_FALSE(ConfigFile::parse("threads = 99999999999999999999", "huge number"));
  const std::string good = to_toml(Sample{});
  for (std::size_t length = 0; length < good.size(); ++length) {
    const auto file = ConfigFile::parse(good.substr(0, length), "cut");
    Sample sample;
    if (file) (void)file->read_into(sample);
  }
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    std::string flipped = good;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    const auto file = ConfigFile::parse(flipped, "flipped");
    Sample sample;
    if (file) (void)file->read_into(sample);
  }
}

TEST(ConfigFile, LoadReportsAMissingFile) {
  const auto file = ConfigFile::load("/nowhere/at/all.toml");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace edgesplat::config
