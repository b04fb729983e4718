// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"
#include "common/io/bag_source.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// ROS bags made by hand from the formats' descriptions, so that tests need no ROS and no other reader.
namespace edgesplat::io {

/// A message of a ROS recording as it goes into a bag.
struct SampleMessage {
  std::string topic;
  std::string type;  ///< "sensor_msgs/Imu"
  std::int64_t time_ns = 0;
  std::vector<std::byte> payload;
};

/// Fields of ROS messages in either encoding, written field by field as the definitions have them.
class RosWriter {
 public:
  explicit RosWriter(RosEncoding encoding) : encoding_(encoding) {
    if (encoding == RosEncoding::kCdr) bytes_.write_text(std::string("\x00\x01\x00\x00", 4));
  }
  template <typename T>
  RosWriter& put(T value) {
    align(sizeof(T));
    bytes_.write(value);
    return *this;
  }
  RosWriter& text(std::string_view text) {
    const bool cdr = encoding_ == RosEncoding::kCdr;
    put(static_cast<std::uint32_t>(text.size() + (cdr ? 1 : 0)));
    bytes_.write_text(text);
    if (cdr) bytes_.write(std::uint8_t{0});
    return *this;
  }
  RosWriter& blob(std::span<const std::byte> bytes) {
    put(static_cast<std::uint32_t>(bytes.size()));
    bytes_.write_bytes(bytes);
    return *this;
  }
  RosWriter& header(std::int64_t stamp_ns, std::string_view frame = "sensor") {
    if (encoding_ == RosEncoding::kRos1) put(std::uint32_t{7});
    put(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
    put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
    return text(frame);
  }
  [[nodiscard]] std::vector<std::byte> take() { return bytes_.take(); }

 private:
  void align(std::size_t size) {
    if (encoding_ == RosEncoding::kRos1) return;
    constexpr std::size_t kEncapsulationBytes = 4;
    while ((bytes_.size() - kEncapsulationBytes) % size != 0) bytes_.write(std::uint8_t{0});
  }
  RosEncoding encoding_;
  ByteWriter bytes_;
};

enum class BagCompression : std::uint8_t { kNone, kBz2, kLz4 };

namespace rosbag1_sample {

struct Field {
  std::string name;
  std::vector<std::byte> value;
};
template <typename T>
Field number(std::string name, T value) {
  ByteWriter bytes;
  bytes.write(value);
  return {std::move(name), bytes.take()};
}
inline Field words(std::string name, std::string_view value) {
  ByteWriter bytes;
  bytes.write_text(value);
  return {std::move(name), bytes.take()};
}
inline Field time(std::string name, std::int64_t ns) {
  ByteWriter bytes;
  bytes.write(static_cast<std::uint32_t>(ns / 1'000'000'000));
  bytes.write(static_cast<std::uint32_t>(ns % 1'000'000'000));
  return {std::move(name), bytes.take()};
}
inline std::vector<std::byte> fields_bytes(const std::vector<Field>& fields) {
  ByteWriter bytes;
  for (const Field& field : fields) {
    bytes.write(static_cast<std::uint32_t>(field.name.size() + 1 + field.value.size()));
    bytes.write_text(field.name + "=");
    bytes.write_bytes(field.value);
  }
  return bytes.take();
}
inline void append_record(ByteWriter& out, const std::vector<Field>& fields,
                          std::span<const std::byte> data) {
  const auto header = fields_bytes(fields);
  out.write(static_cast<std::uint32_t>(header.size()));
  out.write_bytes(header);
  out.write(static_cast<std::uint32_t>(data.size()));
  out.write_bytes(data);
}

inline std::vector<std::byte> compress(BagCompression compression, std::span<const std::byte> plain) {
  if (compression == BagCompression::kNone) return {plain.begin(), plain.end()};
  if (compression == BagCompression::kLz4) {
    std::vector<std::byte> out(LZ4F_compressFrameBound(plain.size(), nullptr));
    out.resize(LZ4F_compressFrame(out.data(), out.size(), plain.data(), plain.size(), nullptr));
    return out;
  }
  std::vector<std::byte> out(plain.size() + plain.size() / 50 + 1000);
  auto length = static_cast<unsigned>(out.size());
  auto* in = reinterpret_cast<char*>(const_cast<std::byte*>(plain.data()));
  BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(out.data()), &length, in,
                           static_cast<unsigned>(plain.size()), 9, 0, 0);
  out.resize(length);
  return out;
}

}  // namespace rosbag1_sample

/// A ROS 1 bag, format 2.0; a chunk every `chunk_messages` in the order given. `closed` false: as a recorder
/// that was killed leaves it, without index.
inline std::vector<std::byte> rosbag1_bytes(const std::vector<SampleMessage>& messages,
                                            BagCompression compression, std::size_t chunk_messages = 10,
                                            bool closed = true) {
  namespace s = rosbag1_sample;
  std::map<std::string, std::uint32_t> ids;
  const auto connection = [&](ByteWriter& out, const SampleMessage& message, std::uint32_t id) {
    s::append_record(
        out, {s::number("op", std::uint8_t{7}), s::number("conn", id), s::words("topic", message.topic)},
        s::fields_bytes({s::words("topic", message.topic), s::words("type", message.type),
                         s::words("md5sum", "*"), s::words("message_definition", "")}));
  };
  struct Chunk {
    std::uint64_t offset;
    std::int64_t first_ns;
    std::int64_t last_ns;
  };
  std::vector<Chunk> chunks;
  ByteWriter connections;
  ByteWriter body;
  constexpr std::uint64_t kBodyStart = 13 + 4096;
  for (std::size_t at = 0; at < messages.size(); at += chunk_messages) {
    ByteWriter plain;
    Chunk chunk{kBodyStart + body.size(), std::numeric_limits<std::int64_t>::max(), 0};
    for (std::size_t i = at; i < std::min(messages.size(), at + chunk_messages); ++i) {
      const SampleMessage& message = messages[i];
      const auto [id, is_new] = ids.emplace(message.topic, static_cast<std::uint32_t>(ids.size()));
      if (is_new) {
        connection(plain, message, id->second);
        connection(connections, message, id->second);
      }
      s::append_record(
          plain,
          {s::number("op", std::uint8_t{2}), s::number("conn", id->second), s::time("time", message.time_ns)},
          message.payload);
      chunk.first_ns = std::min(chunk.first_ns, message.time_ns);
      chunk.last_ns = std::max(chunk.last_ns, message.time_ns);
    }
    constexpr const char* kNames[] = {"none", "bz2", "lz4"};
    s::append_record(body,
                     {s::number("op", std::uint8_t{5}),
                      s::words("compression", kNames[static_cast<std::size_t>(compression)]),
                      s::number("size", static_cast<std::uint32_t>(plain.size()))},
                     s::compress(compression, plain.bytes()));
    s::append_record(body,
                     {s::number("op", std::uint8_t{4}), s::number("ver", std::uint32_t{1}),
                      s::number("conn", std::uint32_t{0}), s::number("count", std::uint32_t{0})},
                     {});
    chunks.push_back(chunk);
  }
  const std::vector<s::Field> about = {
      s::number("op", std::uint8_t{3}),
      s::number("index_pos", closed ? kBodyStart + body.size() : std::uint64_t{0}),
      s::number("conn_count", static_cast<std::uint32_t>(closed ? ids.size() : 0)),
      s::number("chunk_count", static_cast<std::uint32_t>(closed ? chunks.size() : 0))};
  ByteWriter bag;
  bag.write_text("#ROSBAG V2.0\n");
  const std::vector<std::byte> padding(4096 - 8 - s::fields_bytes(about).size(), std::byte{' '});
  s::append_record(bag, about, padding);
  bag.write_bytes(body.bytes());
  if (!closed) return bag.take();
  bag.write_bytes(connections.bytes());
  for (const Chunk& chunk : chunks)
    s::append_record(bag,
                     {s::number("op", std::uint8_t{6}), s::number("ver", std::uint32_t{1}),
                      s::number("chunk_pos", chunk.offset), s::time("start_time", chunk.first_ns),
                      s::time("end_time", chunk.last_ns), s::number("count", std::uint32_t{0})},
                     {});
  return bag.take();
}

/// A ROS 2 bag as rosbag2's SQLite plugin lays it out.
inline void write_rosbag2_sqlite(const std::filesystem::path& path,
                                 const std::vector<SampleMessage>& messages) {
  sqlite3* db = nullptr;
  sqlite3_open(path.c_str(), &db);
  const auto run = [&](const std::string& sql) { sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr); };
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,serialization_format "
      "TEXT NOT "
      "NULL,offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT "
      "NULL,data BLOB NOT "
      "NULL);CREATE INDEX timestamp_idx ON messages (timestamp ASC);BEGIN");
  std::map<std::string, int> ids;
  for (const SampleMessage& message : messages) {
    const auto [id, is_new] = ids.emplace(message.topic, static_cast<int>(ids.size()) + 1);
    const std::string package = message.type.substr(0, message.type.find('/'));
    if (is_new)
      run("INSERT INTO topics VALUES(" + std::to_string(id->second) + ",'" + message.topic + "','" + package +
          "/msg" + message.type.substr(package.size()) + "','cdr','')");
    sqlite3_stmt* insert = nullptr;
    sqlite3_prepare_v2(db, "INSERT INTO messages(topic_id,timestamp,data) VALUES(?,?,?)", -1, &insert,
                       nullptr);
    sqlite3_bind_int(insert, 1, id->second);
    sqlite3_bind_int64(insert, 2, message.time_ns);
    sqlite3_bind_blob(insert, 3, message.payload.data(), static_cast<int>(message.payload.size()),
                      SQLITE_STATIC);
    sqlite3_step(insert);
    sqlite3_finalize(insert);
  }
  run("COMMIT");
  sqlite3_close(db);
}

/// Two topics, every 10 ms in turn, the odd ones 15 ms late in the file: order and content can be checked.
inline std::vector<SampleMessage> numbered_messages(int count) {
  std::vector<SampleMessage> messages;
  for (int i = 0; i < count; ++i) {
    ByteWriter payload;
    payload.write_text("message " + std::to_string(i));
    const std::int64_t late_ns = i % 2 == 0 ? 0 : -15'000'000;
    messages.push_back({i % 2 == 0 ? "/even" : "/odd", "test/Text",
                        1'700'000'000'000'000'000 + std::int64_t{i} * 10'000'000 + late_ns, payload.take()});
  }
  return messages;
}

}  // namespace edgesplat::io
