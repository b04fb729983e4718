// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace edgesplat::io {

/// Bytes at any place of a file or of memory. Thread-safe: reading changes nothing.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  [[nodiscard]] virtual std::uint64_t size_bytes() const = 0;
  /// Fills all of `into`; kCorrupt beyond the end, kIo where the system refuses.
  [[nodiscard]] virtual Status read(std::uint64_t offset, std::span<std::byte> into) const = 0;
  /// A buffer of `length`, taken only after checking that the source has as much.
  [[nodiscard]] Result<std::vector<std::byte>> read(std::uint64_t offset, std::uint64_t length) const;

 protected:
  [[nodiscard]] Status check_range(std::uint64_t offset, std::uint64_t length) const;
};

/// Opens a regular file; kNotFound or kIo.
[[nodiscard]] Result<std::unique_ptr<ByteSource>> open_byte_source(const std::filesystem::path& path);
/// Bytes that the caller keeps alive.
[[nodiscard]] std::unique_ptr<ByteSource> make_byte_source(std::span<const std::byte> bytes);

}  // namespace edgesplat::io
