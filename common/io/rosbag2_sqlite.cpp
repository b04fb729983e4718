// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/rosbag2_sqlite.hpp"

#include "common/io/mcap_compression.hpp"
#include "common/io/sqlite_file.hpp"
#include "common/io/unpacked_file.hpp"

#include <zstd.h>

#include <algorithm>
#include <map>
#include <utility>

namespace edgesplat::io {
namespace {

std::string text_column(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text == nullptr ? std::string()
                         : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
}

/// Views and generated tables under these names could compute without end: only plain tables are read.
Status check_tables(sqlite3* db) {
  EDGESPLAT_TRY(const auto rows,
                prepare_sqlite(db,
                               "SELECT COUNT(*) FROM sqlite_schema WHERE type='table' AND "
                               "name IN ('topics','messages') AND sql NOT LIKE '%VIRTUAL%'"));
  if (sqlite3_step(rows.get()) != SQLITE_ROW) return fail(Errc::kCorrupt, sqlite3_errmsg(db));
  if (sqlite3_column_int(rows.get(), 0) != 2)
    return fail(Errc::kCorrupt, "not a ROS 2 bag: no tables 'topics' and 'messages'");
  return {};
}

/// rosbag2 compresses messages one by one with zstd; nothing that is CDR begins with its magic.
bool is_zstd(std::span<const std::byte> bytes) {
  constexpr std::byte kMagic[] = {std::byte{0x28}, std::byte{0xB5}, std::byte{0x2F}, std::byte{0xFD}};
  return bytes.size() >= std::size(kMagic) && std::equal(std::begin(kMagic), std::end(kMagic), bytes.begin());
}

class Rosbag2Sqlite final : public BagSource {
 public:
  static Result<std::unique_ptr<BagSource>> open(SqliteFile db, std::optional<UnpackedFile> unpacked);

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }
  [[nodiscard]] HostTime begin() const override { return begin_; }
  [[nodiscard]] HostTime end() const override { return end_; }
  void select(std::vector<std::size_t> topics) override {
    std::string ids;
    for (const auto& [id, index] : topic_of_)
      if (std::find(topics.begin(), topics.end(), index) != topics.end())
        ids += (ids.empty() ? "" : ",") + std::to_string(id);
    start("WHERE topic_id IN (" + ids + ") ");
  }
  [[nodiscard]] std::optional<BagMessage> next() override;
  [[nodiscard]] BagReport report() const override { return report_; }

 private:
  Rosbag2Sqlite(SqliteFile db, std::optional<UnpackedFile> unpacked)
      : unpacked_(std::move(unpacked)), db_(std::move(db)) {}
  [[nodiscard]] Status read_topics();
  [[nodiscard]] Status read_times();
  void start(const std::string& where);
  [[nodiscard]] Result<std::span<const std::byte>> unpacked(std::span<const std::byte> payload);
  void add_problem(const std::string& sentence) {
    constexpr std::size_t kLongest = 1000;
    report_.complete = false;
    if (report_.why.size() < kLongest) report_.why += (report_.why.empty() ? "" : "; ") + sentence;
  }

  std::optional<UnpackedFile> unpacked_;  ///< before db_, which is closed first
  SqliteFile db_;
  std::vector<BagTopic> topics_;
  std::map<std::int64_t, std::size_t> topic_of_;
  HostTime begin_{};
  HostTime end_{};
  SqliteStatement rows_;  ///< null at the end
  std::vector<std::byte> plain_;
  BagReport report_;
};

Status Rosbag2Sqlite::read_topics() {
  EDGESPLAT_TRY(
      const auto rows,
      prepare_sqlite(db_.get(), "SELECT id,name,type,serialization_format FROM topics ORDER BY id"));
  int code = sqlite3_step(rows.get());
  for (; code == SQLITE_ROW; code = sqlite3_step(rows.get())) {
    if (text_column(rows.get(), 3) != "cdr") continue;
    if (!topic_of_.emplace(sqlite3_column_int64(rows.get(), 0), topics_.size()).second) continue;
    topics_.push_back(
        {text_column(rows.get(), 1), ros_type_name(text_column(rows.get(), 2)), RosEncoding::kCdr});
  }
  if (code != SQLITE_DONE)
    return fail(Errc::kCorrupt, std::string("its topics: ") + sqlite3_errmsg(db_.get()));
  return {};
}

Status Rosbag2Sqlite::read_times() {
  EDGESPLAT_TRY(const auto rows, prepare_sqlite(db_.get(),
                                                "SELECT (SELECT MIN(timestamp) FROM messages),(SELECT "
                                                "MAX(timestamp) FROM messages)"));
  if (sqlite3_step(rows.get()) != SQLITE_ROW) {
    add_problem(std::string("its times: ") + sqlite3_errmsg(db_.get()));
    return {};
  }
  begin_ = host_time_from_ns(sqlite3_column_int64(rows.get(), 0));
  end_ = host_time_from_ns(sqlite3_column_int64(rows.get(), 1));
  return {};
}

void Rosbag2Sqlite::start(const std::string& where) {
  const bool complete = report_.complete;
  report_ = {complete, 0, 0, complete ? "" : report_.why};
  auto rows = prepare_sqlite(
      db_.get(), "SELECT topic_id,timestamp,data FROM messages " + where + "ORDER BY timestamp,id");
  if (rows) {
    rows_ = std::move(*rows);
  } else {
    rows_.reset();
    add_problem(rows.error().context);
  }
}

Result<std::span<const std::byte>> Rosbag2Sqlite::unpacked(std::span<const std::byte> payload) {
  if (!is_zstd(payload)) return payload;
  const auto size = ZSTD_getFrameContentSize(payload.data(), payload.size());
  EDGESPLAT_TRY(plain_, mcap::decompress(McapCompression::kZstd, payload, size));
  return plain_;
}

std::optional<BagMessage> Rosbag2Sqlite::next() {
  while (rows_) {
    const int code = sqlite3_step(rows_.get());
    if (code != SQLITE_ROW) {
      if (code != SQLITE_DONE) {
        add_problem(std::string("read until message ") + std::to_string(report_.messages_read) + ": " +
                    sqlite3_errmsg(db_.get()));
      }
      rows_.reset();
      break;
    }
    const auto topic = topic_of_.find(sqlite3_column_int64(rows_.get(), 0));
    if (topic == topic_of_.end()) continue;
    const auto* data = static_cast<const std::byte*>(sqlite3_column_blob(rows_.get(), 2));
    const auto bytes = static_cast<std::size_t>(sqlite3_column_bytes(rows_.get(), 2));
    const auto payload = unpacked(data == nullptr ? std::span<const std::byte>() : std::span(data, bytes));
    if (!payload) {
      report_.bytes_skipped += bytes;
      add_problem(payload.error().context);
      continue;
    }
    ++report_.messages_read;
    return BagMessage{topic->second, host_time_from_ns(sqlite3_column_int64(rows_.get(), 1)), *payload};
  }
  return std::nullopt;
}

Result<std::unique_ptr<BagSource>> Rosbag2Sqlite::open(SqliteFile db, std::optional<UnpackedFile> unpacked) {
  EDGESPLAT_TRY_STATUS(check_tables(db.get()));
  std::unique_ptr<Rosbag2Sqlite> bag(new Rosbag2Sqlite(std::move(db), std::move(unpacked)));
  EDGESPLAT_TRY_STATUS(bag->read_topics());
  EDGESPLAT_TRY_STATUS(bag->read_times());
  bag->start("");
  return bag;
}

Result<std::unique_ptr<BagSource>> open_at(const std::filesystem::path& path,
                                           std::optional<UnpackedFile> unpacked) {
  EDGESPLAT_TRY(SqliteFile db, open_sqlite(path));
  return Rosbag2Sqlite::open(std::move(db), std::move(unpacked));
}

Result<std::unique_ptr<BagSource>> open_packed(const std::filesystem::path& path) {
  EDGESPLAT_TRY(UnpackedFile unpacked, UnpackedFile::from_zstd(path));
  const std::filesystem::path plain = unpacked.path();
  return open_at(plain, std::move(unpacked));
}

}  // namespace

Result<std::unique_ptr<BagSource>> open_rosbag2_sqlite(const std::filesystem::path& path) {
  auto bag = path.extension() == ".zstd" ? open_packed(path) : open_at(path, std::nullopt);
  if (!bag) return fail(bag.error().code, path.string() + ": " + bag.error().context);
  return bag;
}

Result<std::unique_ptr<BagSource>> rosbag2_sqlite_from_bytes(std::span<const std::byte> bytes) {
  EDGESPLAT_TRY(SqliteFile db, open_sqlite(bytes));
  return Rosbag2Sqlite::open(std::move(db), std::nullopt);
}

}  // namespace edgesplat::io
