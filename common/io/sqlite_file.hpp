// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <sqlite3.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

/// SQLite, for reading files that came from outside. Inside common/io only.
namespace edgesplat::io {

struct CloseSqlite {
  void operator()(sqlite3* db) const { sqlite3_close_v2(db); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using SqliteFile = std::unique_ptr<sqlite3, CloseSqlite>;
using SqliteStatement = std::unique_ptr<sqlite3_stmt, CloseSqlite>;

/// Read-only, with SQLite's defences against hostile files on and its cache and values bounded.
[[nodiscard]] Result<SqliteFile> open_sqlite(const std::filesystem::path& path);
/// From memory that the caller keeps alive.
[[nodiscard]] Result<SqliteFile> open_sqlite(std::span<const std::byte> bytes);
/// kCorrupt where the file does not fit the statement.
[[nodiscard]] Result<SqliteStatement> prepare_sqlite(sqlite3* db, const std::string& sql);

}  // namespace edgesplat::io
