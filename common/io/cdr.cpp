// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/cdr.hpp"

#include <array>

namespace edgesplat::io {
namespace {

constexpr std::size_t kEncapsulationBytes = 4;
constexpr std::array<std::byte, 2> kLittleEndianCdr = {std::byte{0x00}, std::byte{0x01}};

std::size_t aligned(std::size_t position, std::size_t alignment) {
  return (position + alignment - 1) / alignment * alignment;
}

}  // namespace

CdrWriter::CdrWriter(std::size_t expected_bytes) {
  bytes_.reserve(expected_bytes + kEncapsulationBytes);
  bytes_.assign(kLittleEndianCdr.begin(), kLittleEndianCdr.end());
  bytes_.resize(kEncapsulationBytes);
}

void CdrWriter::align(std::size_t size) {
  bytes_.resize(kEncapsulationBytes + aligned(bytes_.size() - kEncapsulationBytes, size));
}

void CdrWriter::write_string(std::string_view text) {
  write(static_cast<std::uint32_t>(text.size() + 1));
  const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  bytes_.push_back(std::byte{0});
}

void CdrWriter::write_byte_sequence(std::span<const std::byte> bytes) {
  write(static_cast<std::uint32_t>(bytes.size()));
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

CdrReader::CdrReader(std::span<const std::byte> bytes) {
  ok_ = bytes.size() >= kEncapsulationBytes && bytes[0] == kLittleEndianCdr[0] &&
        bytes[1] == kLittleEndianCdr[1];
  if (ok_) bytes_ = bytes.subspan(kEncapsulationBytes);
}

std::span<const std::byte> CdrReader::take(std::size_t count, std::size_t alignment) {
  const std::size_t start = aligned(position_, alignment);
  if (!ok_ || start > bytes_.size() || count > bytes_.size() - start) {
    ok_ = false;
    return {};
  }
  position_ = start + count;
  return bytes_.subspan(start, count);
}

std::string CdrReader::read_string() {
  const auto length = read<std::uint32_t>();  // with the closing zero
  const auto text = take(length, 1);
  if (length == 0 || text.empty()) return {};  // some writers send 0 for an empty string
  if (text.back() != std::byte{0}) ok_ = false;
  return {reinterpret_cast<const char*>(text.data()), text.size() - 1};
}

std::span<const std::byte> CdrReader::read_byte_sequence() {
  return take(read<std::uint32_t>(), 1);
}

}  // namespace edgesplat::io
