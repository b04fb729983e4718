// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::io {

/// A file that appears under its name whole or not at all: written to a temporary neighbour, flushed to the
/// disk, renamed. Without commit() the temporary is removed. Errors are kIo with the path and the system's
/// reason (a full disk among them). Single-owner.
class AtomicFile {
 public:
  static Result<AtomicFile> create(const std::filesystem::path& path);
  AtomicFile(AtomicFile&&) noexcept = default;
  AtomicFile& operator=(AtomicFile&&) = delete;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  [[nodiscard]] Status append(std::span<const std::byte> bytes);
  /// fsync, rename, fsync of the folder.
  [[nodiscard]] Status commit();

 private:
  AtomicFile(std::filesystem::path path, std::filesystem::path temporary, UniqueFd fd);
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  UniqueFd fd_;  ///< closed = nothing left to remove
};

[[nodiscard]] Status write_file_atomically(const std::filesystem::path& path,
                                           std::span<const std::byte> bytes);
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& path, std::string_view text);

/// The whole file; kNotFound, kIo, or kInvalidArgument where it is larger than `max_bytes`.
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path,
                                                       std::uint64_t max_bytes);
/// The same as text, byte for byte.
[[nodiscard]] Result<std::string> read_text_file(const std::filesystem::path& path, std::uint64_t max_bytes);

/// write(2) until all of it is written; kIo with `path` and the system's reason.
[[nodiscard]] Status write_all(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path);

}  // namespace edgesplat::io
