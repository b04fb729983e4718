// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/temp_dir.hpp"

#include "common/base/check.hpp"

#include <cstdlib>
#include <string>

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

}  // namespace edgesplat::test
