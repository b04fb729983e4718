// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <filesystem>
#include <utility>

/// Inside common/io only.
namespace edgesplat::io {

/// A compressed file's content in a temporary file, removed at the end. Single-owner.
class UnpackedFile {
 public:
  /// Piece by piece. kCorrupt for damage, truncation and what grows beyond 64 times its size; kIo (disk
  /// full).
  [[nodiscard]] static Result<UnpackedFile> from_zstd(const std::filesystem::path& packed);
  UnpackedFile(UnpackedFile&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  UnpackedFile& operator=(UnpackedFile&&) = delete;
  UnpackedFile(const UnpackedFile&) = delete;
  UnpackedFile& operator=(const UnpackedFile&) = delete;
  ~UnpackedFile();
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit UnpackedFile(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace edgesplat::io
