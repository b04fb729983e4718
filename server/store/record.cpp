// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/record.hpp"

#include "common/base/bytes.hpp"
#include "common/base/crc32c.hpp"

#include <algorithm>

namespace edgesplat::store {

std::array<std::byte, kRecordHeader_bytes> record_header(std::uint8_t type,
                                                         std::span<const std::byte> payload) {
  ByteWriter out;
  out.write(kRecordMarker);
  out.write(type);
  out.write(static_cast<std::uint32_t>(payload.size()));
  out.write(crc32c(payload));
  out.write(crc32c(out.bytes()));
  std::array<std::byte, kRecordHeader_bytes> header{};
  std::copy(out.bytes().begin(), out.bytes().end(), header.begin());
  return header;
}

std::optional<Record> RecordReader::record_at(std::size_t position) const {
  const auto rest = bytes_.subspan(position);
  ByteReader in(rest);
  Record record;
  const auto marker = in.read<std::uint32_t>();
  record.type = in.read<std::uint8_t>();
  const std::size_t length = in.read<std::uint32_t>();
  const auto payload_crc = in.read<std::uint32_t>();
  const auto header_crc = in.read<std::uint32_t>();
  if (!in.ok() || marker != kRecordMarker || length > kMaxRecord_bytes ||
      header_crc != crc32c(rest.first(kRecordHeader_bytes - sizeof(header_crc))))
    return std::nullopt;
  record.payload = in.take(length);
  if (!in.ok()) return std::nullopt;
  record.whole = crc32c(record.payload) == payload_crc;
  record.end = position + kRecordHeader_bytes + length;
  return record;
}

std::optional<Record> RecordReader::next() {
  constexpr std::byte kFirst{kRecordMarker & 0xFFU};
  std::size_t at = position_;
  while (at < bytes_.size()) {
    const auto record = bytes_[at] == kFirst ? record_at(at) : std::nullopt;
    if (record && record->whole) {
      damaged_bytes_ += at - position_;
      position_ = record->end;
      return record;
    }
    at = record ? record->end : at + 1;  // a whole header can be believed: past the damaged payload
  }
  damaged_bytes_ += bytes_.size() - std::min(position_, bytes_.size());
  position_ = bytes_.size();
  return std::nullopt;
}

}  // namespace edgesplat::store
