// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/attribute_stream.hpp"

#include "common/map/varint.hpp"

#include <zstd.h>

#include <algorithm>
#include <string>

namespace edgesplat::map {
namespace {

constexpr int kZstdLevel = 3;
constexpr std::size_t kWorthTrying_bytes = 24;                       // a zstd frame alone takes about 12
enum Form : std::uint8_t { kPlain = 0, kFolded = 1, kStepped = 2 };  // on the wire

/// Differences modulo mask + 1 of either sign as small numbers: 0, -1, 1, -2 ... become 0, 1, 2, 3 ...
std::uint16_t fold(std::uint32_t difference, std::uint32_t mask) {
  difference &= mask;
  return static_cast<std::uint16_t>(difference > mask / 2 ? 2 * (mask - difference) + 1 : 2 * difference);
}

std::uint32_t unfold(std::uint32_t value, std::uint32_t mask) {
  return (value & 1U) != 0 ? mask - value / 2 : value / 2;
}

/// Each value less the one before it in its column (kStepped) or as it is (kFolded), folded.
std::vector<std::uint16_t> folded(std::span<const std::uint16_t> values, std::size_t columns, unsigned bits,
                                  Form form) {
  const std::size_t rows = values.size() / columns;
  const std::uint32_t mask = (1U << bits) - 1;
  std::vector<std::uint16_t> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint32_t before = form == kFolded || i % rows == 0 ? 0U : values[i - 1];
    result[i] = fold(values[i] - before, mask);
  }
  return result;
}

void undo(std::span<std::uint16_t> values, std::size_t columns, unsigned bits, Form form) {
  if (form == kPlain) return;
  const std::size_t rows = values.size() / columns;
  const std::uint32_t mask = (1U << bits) - 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint32_t before = form == kFolded || i % rows == 0 ? 0U : values[i - 1];
    values[i] = static_cast<std::uint16_t>((before + unfold(values[i], mask)) & mask);
  }
}

tl::unexpected<Error> fail_attribute(const char* why) {
  return fail(Errc::kCorrupt, std::string("an attribute's bytes are refused: ") + why);
}

}  // namespace

struct AttributeWriter::Context {
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> zstd{ZSTD_createCCtx(), &ZSTD_freeCCtx};
  std::vector<std::byte> packed;
};

AttributeWriter::AttributeWriter(ByteWriter& out) : out_(out), context_(std::make_unique<Context>()) {}
AttributeWriter::~AttributeWriter() = default;

void AttributeWriter::block(std::span<const std::byte> raw, ByteWriter& out) {
  std::size_t packed_bytes = raw.size();
  if (raw.size() >= kWorthTrying_bytes && context_->zstd) {
    context_->packed.resize(ZSTD_compressBound(raw.size()));
    const std::size_t got = ZSTD_compressCCtx(context_->zstd.get(), context_->packed.data(),
                                              context_->packed.size(), raw.data(), raw.size(), kZstdLevel);
    if (ZSTD_isError(got) == 0) packed_bytes = std::min(packed_bytes, got);
  }
  const bool packed = packed_bytes < raw.size();
  write_varint(out, (static_cast<std::uint64_t>(packed_bytes) << 1U) | (packed ? 1U : 0U));
  out.write_bytes(packed ? std::span<const std::byte>(context_->packed).first(packed_bytes) : raw);
}

void AttributeWriter::bytes(std::span<const std::byte> raw) {
  block(raw, out_);
}

void AttributeWriter::sized_bytes(std::span<const std::byte> raw) {
  write_varint(out_, raw.size());
  block(raw, out_);
}

void AttributeWriter::planes(std::span<const std::uint16_t> values, unsigned bits, ByteWriter& out) {
  std::vector<std::byte> plane(values.size());
  for (unsigned shift = 0; shift < bits; shift += 8) {
    for (std::size_t i = 0; i < values.size(); ++i)
      plane[i] = static_cast<std::byte>((std::uint32_t{values[i]} >> shift) & 0xFFU);
    block(plane, out);
  }
}

void AttributeWriter::integers(std::span<const std::uint16_t> values, std::size_t columns, unsigned bits,
                               Values kind) {
  const Form first_form = kind == Values::kDifferences ? kFolded : kPlain;
  ByteWriter first;
  ByteWriter stepped;
  planes(first_form == kPlain ? std::vector<std::uint16_t>(values.begin(), values.end())
                              : folded(values, columns, bits, kFolded),
         bits, first);
  planes(folded(values, columns, bits, kStepped), bits, stepped);
  const bool use_steps = stepped.size() < first.size();
  out_.write(static_cast<std::uint8_t>(use_steps ? kStepped : first_form));
  out_.write_bytes(use_steps ? stepped.bytes() : first.bytes());
}

Result<std::vector<std::byte>> AttributeReader::bytes(std::size_t count) {
  const std::uint64_t head = read_varint(in_);
  const auto body = in_.take(static_cast<std::size_t>(head >> 1U));
  if (!in_.ok()) return fail_attribute("they are cut short");
  if ((head & 1U) == 0) {
    if (body.size() != count) return fail_attribute("their number is wrong");
    return std::vector<std::byte>(body.begin(), body.end());
  }
  if (ZSTD_getFrameContentSize(body.data(), body.size()) != count)
    return fail_attribute("they do not unpack to their number");
  std::vector<std::byte> raw(count);
  if (ZSTD_decompress(raw.data(), raw.size(), body.data(), body.size()) != count)
    return fail_attribute("they do not unpack");
  return raw;
}

Result<std::vector<std::byte>> AttributeReader::sized_bytes(std::size_t max_count) {
  const std::uint64_t count = read_varint(in_);
  if (!in_.ok() || count > max_count) return fail_attribute("there are too many");
  return bytes(static_cast<std::size_t>(count));
}

Result<std::vector<std::uint16_t>> AttributeReader::integers(std::size_t rows, std::size_t columns,
                                                             unsigned bits) {
  const auto form = in_.read<std::uint8_t>();
  if (!in_.ok() || form > kStepped) return fail_attribute("unknown form");
  std::vector<std::uint16_t> values(rows * columns, std::uint16_t{0});
  for (unsigned shift = 0; shift < bits; shift += 8) {
    EDGESPLAT_TRY(const auto plane, bytes(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<std::uint16_t>(values[i] | (std::to_integer<unsigned>(plane[i]) << shift));
  }
  const std::uint32_t mask = (1U << bits) - 1;
  for (const std::uint16_t value : values) {
    if (value > mask) return fail_attribute("a value is out of its range");
  }
  undo(values, columns, bits, static_cast<Form>(form));
  return values;
}

}  // namespace edgesplat::map
