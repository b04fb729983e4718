// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/stream/epoch_file.hpp"

#include "common/io/atomic_file.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>

namespace edgesplat::stream {
namespace {

constexpr std::uint64_t kMaxFile_bytes = 64;

Result<std::uint32_t> parse(const std::string& text, const std::filesystem::path& path) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool rest_is_newline = end == text.data() + text.size() || *end == '\n';
  if (error != std::errc{} || !rest_is_newline || value == std::numeric_limits<std::uint32_t>::max()) {
    return fail(
        Errc::kCorrupt,
        path.string() + " does not hold an epoch: write a number into it that is higher than any before");
  }
  return value;
}

}  // namespace

Result<map::Epoch> next_epoch(const std::filesystem::path& path, map::Epoch known) {
  map::Epoch epoch{known.value + 1};
  const auto text = io::read_text_file(path, kMaxFile_bytes);
  if (text) {
    EDGESPLAT_TRY(const std::uint32_t last, parse(*text, path));
    epoch.value = std::max(last, known.value) + 1;
  } else if (text.error().code != Errc::kNotFound) {
    return tl::unexpected<Error>(text.error());
  }
  EDGESPLAT_TRY_STATUS(io::write_file_atomically(path, std::to_string(epoch.value) + "\n"));
  return epoch;
}

}  // namespace edgesplat::stream
