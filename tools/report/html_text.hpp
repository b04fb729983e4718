// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace edgesplat::report {

/// Text made safe to stand in HTML, attributes included.
[[nodiscard]] std::string escape_html(std::string_view text);
/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);
/// "data:image/jpeg;base64,...", to stand in src="".
[[nodiscard]] std::string data_uri(std::string_view media_type, std::span<const std::byte> bytes);

}  // namespace edgesplat::report
