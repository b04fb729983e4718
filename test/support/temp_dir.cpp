// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/temp_dir.hpp"

#include "common/base/check.hpp"

#include <cstdlib>
#include <fstream>

namespace edgesplat::test {

TempDir::TempDir() {
  std::string pattern = (std::filesystem::temp_directory_path() / "edgesplat-test-XXXXXX").string();
  EDGESPLAT_CHECK(::mkdtemp(pattern.data()) != nullptr, "the temporary folder is writable");
  path_ = pattern;
}

TempDir::~TempDir() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TempDir::write(const std::string& name, std::span<const std::byte> content) const {
  std::filesystem::path file = path_ / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
  return file;
}

std::filesystem::path TempDir::write(const std::string& name, std::string_view text) const {
  return write(name, std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace edgesplat::test
