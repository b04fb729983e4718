// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_reader.hpp"

#include <array>
#include <charconv>

namespace edgesplat::config {

double ConfigReader::widened(float value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  auto wide = static_cast<double>(value);
  std::from_chars(digits.data(), end, wide);
  return wide;
}

}  // namespace edgesplat::config
