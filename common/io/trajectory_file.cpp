// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/trajectory_file.hpp"

#include "common/io/atomic_file.hpp"

#include <fmt/format.h>

#include <Eigen/LU>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace edgesplat::io {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 30U;

/// The words of one line, and where it is for error messages.
struct Line {
  std::vector<std::string_view> words;
  std::string_view file_name;
  std::size_t number = 0;

  [[nodiscard]] tl::unexpected<Error> failure(std::string_view why) const {
    return fail(Errc::kCorrupt, fmt::format("{}:{}: {}", file_name, number, why));
  }
};

/// Calls `visit`(line) for each line that has words and no '#' in front; stops at the first error. More than
/// `max_words` are not split.
template <typename Visit>
Status for_each_line(std::string_view text, Line& line, std::size_t max_words, Visit visit) {
  constexpr std::string_view kBlank = " \t\r,";
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view rest = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line.number;
    line.words.clear();
    while (line.words.size() <= max_words) {
      rest.remove_prefix(std::min(rest.find_first_not_of(kBlank), rest.size()));
      if (rest.empty()) break;
      const std::size_t length = std::min(rest.find_first_of(kBlank), rest.size());
      line.words.push_back(rest.substr(0, length));
      rest.remove_prefix(length);
    }
    if (line.words.empty() || line.words.front().front() == '#') continue;
    EDGESPLAT_TRY_STATUS(visit());
  }
  return {};
}

/// Words from `first` on as finite numbers.
template <std::size_t Count>
Result<std::array<double, Count>> parse_numbers(const Line& line, std::size_t first) {
  std::array<double, Count> numbers{};
  for (std::size_t i = 0; i < Count; ++i) {
    std::string_view word = line.words[first + i];
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), numbers[i]);
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(numbers[i])) {
      return line.failure(fmt::format("'{}' is not a finite number", word.substr(0, 40)));
    }
  }
  return numbers;
}

Result<StampedPose> parse_tum_pose(const Line& line) {
  if (line.words.size() != 8) return line.failure("expected 8 words: t x y z qx qy qz qw");
  const auto stamp = parse_decimal_seconds(line.words[0]);
  if (!stamp) return line.failure("the time is not a number of seconds");
  EDGESPLAT_TRY(const auto v, parse_numbers<7>(line, 1));
  const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);  // the constructor wants w first
  if (!(std::abs(rotation.norm() - 1.0) <= 0.01)) return line.failure("the quaternion is not of unit length");
  return StampedPose{*stamp, {rotation.normalized(), {v[0], v[1], v[2]}}};
}

Result<geometry::RigidTransform> parse_kitti_pose(const Line& line) {
  if (line.words.size() != 12) return line.failure("expected 12 numbers: the rows of [R t]");
  EDGESPLAT_TRY(const auto v, parse_numbers<12>(line, 0));
  const Eigen::Matrix<double, 3, 4> matrix =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(v.data());
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const double error = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= 0.01) || rotation.determinant() < 0.0)
    return line.failure("the first three columns are no rotation");
  return geometry::RigidTransform::from_matrix(matrix);
}

/// One pose or time a line.
template <typename T, typename Parse>
Result<std::vector<T>> parse_lines(std::string_view text, std::string_view file_name, Parse parse) {
  constexpr std::size_t kMaxWords = 12;
  std::vector<T> parsed;
  Line line;
  line.file_name = file_name;
  EDGESPLAT_TRY_STATUS(for_each_line(text, line, kMaxWords, [&]() -> Status {
    EDGESPLAT_TRY(auto value, parse(line));
    parsed.push_back(value);
    return {};
  }));
  return parsed;
}

}  // namespace

Result<std::vector<StampedPose>> parse_tum(std::string_view text, std::string_view file_name) {
  return parse_lines<StampedPose>(text, file_name, parse_tum_pose);
}

Result<std::vector<geometry::RigidTransform>> parse_kitti(std::string_view text, std::string_view file_name) {
  return parse_lines<geometry::RigidTransform>(text, file_name, parse_kitti_pose);
}

Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto text, read_text_file(path, kMaxFileBytes));
  return parse_tum(text, path.string());
}

Result<std::vector<geometry::RigidTransform>> read_kitti(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto text, read_text_file(path, kMaxFileBytes));
  return parse_kitti(text, path.string());
}

Result<std::vector<HostTime>> read_times(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto text, read_text_file(path, kMaxFileBytes));
  return parse_lines<HostTime>(text, path.string(), [](const Line& line) -> Result<HostTime> {
    const auto stamp = parse_decimal_seconds(line.words[0]);
    if (line.words.size() != 1 || !stamp) return line.failure("expected one number of seconds");
    return *stamp;
  });
}

Status write_tum(const std::filesystem::path& path, std::span<const StampedPose> poses) {
  std::string text = "# t_s x_m y_m z_m qx qy qz qw\n";
  for (const auto& pose : poses) {
    const auto& t = pose.world_from_body.translation_m;
    const auto& q = pose.world_from_body.rotation;
    // {} prints the shortest text that parses to the same double.
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {}\n", format_decimal_seconds(pose.stamp),
                   t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  }
  return write_file_atomically(path, text);
}

Status write_kitti(const std::filesystem::path& path, std::span<const geometry::RigidTransform> poses) {
  std::string text;
  for (const auto& pose : poses) {
    const Eigen::Matrix<double, 3, 4> matrix = pose.matrix();
    for (int i = 0; i < 12; ++i) {
      fmt::format_to(std::back_inserter(text), "{}{}", matrix(i / 4, i % 4), i < 11 ? ' ' : '\n');
    }
  }
  return write_file_atomically(path, text);
}

}  // namespace edgesplat::io
