// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/spelling.hpp"

#include <algorithm>
#include <numeric>

namespace edgesplat::config {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_spelling(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongestWord = 128;  // beyond that it is no slip of the hand
  if (word.size() > kLongestWord) return {};
  std::string best;
  const std::size_t slips =
      word.size() < 4 ? 1 : std::max<std::size_t>(2, word.size() / 3);  // a swap counts 2
  std::size_t best_distance = slips + 1;
  for (const std::string& candidate : candidates) {
    const bool lacks_unit = !word.empty() && candidate.starts_with(std::string(word) + "_");
    const std::size_t distance = lacks_unit ? 1 : edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace edgesplat::config
