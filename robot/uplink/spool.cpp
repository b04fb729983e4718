// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/spool.hpp"

#include "common/io/atomic_file.hpp"
#include "common/log/log.hpp"

#include <system_error>
#include <utility>

namespace edgesplat::uplink {

Spool::Spool(SpoolConfig config) : config_(std::move(config)) {
  remove_files();
}

Spool::~Spool() {
  remove_files();
}

void Spool::remove_files() {
  if (config_.folder.empty()) return;
  std::error_code ignored;
  std::filesystem::remove_all(config_.folder, ignored);
}

void Spool::put(std::vector<std::byte> bytes) {
  ++counters_.put;
  ++counters_.items;
  counters_.memory_bytes += bytes.size();
  memory_.push_back(std::move(bytes));
  while (counters_.memory_bytes > config_.memory_bytes) move_oldest_to_disk();
}

void Spool::move_oldest_to_disk() {
  std::vector<std::byte> bytes = std::move(memory_.front());
  memory_.pop_front();
  counters_.memory_bytes -= bytes.size();
  if (!config_.folder.empty() && bytes.size() <= config_.disk_bytes) {
    while (counters_.disk_bytes + bytes.size() > config_.disk_bytes) drop_oldest_file();
    std::error_code error;
    std::filesystem::create_directories(config_.folder, error);
    const auto path = config_.folder / (std::to_string(next_file_++) + ".keyframe");
    const Status written = io::write_file_atomically(path, bytes);
    if (written) {
      files_.push_back({path, bytes.size()});
      counters_.disk_bytes += bytes.size();
      return;
    }
    if (++counters_.disk_failures == 1) {
      EDGESPLAT_LOG_WARN("spool", "keyframes cannot be kept on the disk", "why", written.error().context);
    }
  }
  --counters_.items;
  ++counters_.dropped;
}

void Spool::remove_file(const File& file) {
  std::error_code ignored;
  std::filesystem::remove(file.path, ignored);
  counters_.disk_bytes -= file.bytes;
  --counters_.items;
}

void Spool::drop_oldest_file() {
  remove_file(files_.front());
  files_.pop_front();
  ++counters_.dropped;
}

std::optional<std::size_t> Spool::next_bytes() const {
  if (!memory_.empty()) return memory_.back().size();
  if (!files_.empty()) return files_.back().bytes;
  return std::nullopt;
}

std::optional<std::vector<std::byte>> Spool::take() {
  if (!memory_.empty()) {
    std::vector<std::byte> bytes = std::move(memory_.back());
    memory_.pop_back();
    counters_.memory_bytes -= bytes.size();
    --counters_.items;
    ++counters_.taken;
    return bytes;
  }
  while (!files_.empty()) {
    auto bytes = io::read_file(files_.back().path, files_.back().bytes);
    remove_file(files_.back());
    files_.pop_back();
    if (bytes) {
      ++counters_.taken;
      return std::move(*bytes);
    }
    ++counters_.disk_failures;
    ++counters_.dropped;
  }
  return std::nullopt;
}

}  // namespace edgesplat::uplink
