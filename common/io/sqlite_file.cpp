// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/sqlite_file.hpp"

namespace edgesplat::io {
namespace {

constexpr int kMaxValueBytes = 256 << 20;

tl::unexpected<Error> refused(sqlite3* db, const std::string& what) {
  return fail(Errc::kCorrupt, what + ": " + (db != nullptr ? sqlite3_errmsg(db) : "no memory"));
}

Status defend(sqlite3* db) {
  sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(db, SQLITE_LIMIT_LENGTH, kMaxValueBytes);
  constexpr const char* kSettings =
      "PRAGMA cell_size_check=ON; PRAGMA mmap_size=0; PRAGMA cache_size=-8192; PRAGMA temp_store=FILE;";
  if (sqlite3_exec(db, kSettings, nullptr, nullptr, nullptr) != SQLITE_OK)
    return refused(db, "not a SQLite file");
  return {};
}

}  // namespace

Result<SqliteFile> open_sqlite(const std::filesystem::path& path) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &raw, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
  SqliteFile db(raw);
  if (code != SQLITE_OK) {
    return fail(std::filesystem::exists(path) ? Errc::kIo : Errc::kNotFound,
                std::string("cannot open: ") + (db ? sqlite3_errmsg(db.get()) : "no memory"));
  }
  EDGESPLAT_TRY_STATUS(defend(db.get()));
  return db;
}

Result<SqliteFile> open_sqlite(std::span<const std::byte> bytes) {
  sqlite3* raw = nullptr;
  const int code = sqlite3_open_v2(":memory:", &raw, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, nullptr);
  SqliteFile db(raw);
  if (code != SQLITE_OK) return refused(raw, "SQLite does not start");
  // SQLite does not write to it: the flag says so.
  auto* data = reinterpret_cast<unsigned char*>(const_cast<std::byte*>(bytes.data()));
  const auto size = static_cast<sqlite3_int64>(bytes.size());
  if (sqlite3_deserialize(raw, "main", data, size, size, SQLITE_DESERIALIZE_READONLY) != SQLITE_OK)
    return refused(raw, "not a SQLite file");
  EDGESPLAT_TRY_STATUS(defend(raw));
  return db;
}

Result<SqliteStatement> prepare_sqlite(sqlite3* db, const std::string& sql) {
  sqlite3_stmt* raw = nullptr;
  const int code = sqlite3_prepare_v2(db, sql.c_str(), static_cast<int>(sql.size()), &raw, nullptr);
  SqliteStatement statement(raw);
  if (code != SQLITE_OK || raw == nullptr) return refused(db, "not a ROS 2 bag");
  return statement;
}

}  // namespace edgesplat::io
