// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"
#include "common/io/byte_compression.hpp"
#include "common/io/spz_packed.hpp"

#include <string>

namespace edgesplat::io::spz {
namespace {

constexpr std::uint32_t kMagic = 0x5053474E;  // "NGSP"
constexpr std::size_t kHeaderBytes = 32;      // of version 4
constexpr int kZstdLevel = 12;
/// A file may expand this much; real ones expand three to five times. The floor lets small, uniform clouds
/// pass.
constexpr std::size_t kPlausibleRatio = 64;
constexpr std::size_t kPlausibleFloorBytes = std::size_t{8} << 20U;

tl::unexpected<Error> corrupt(const std::string& why) {
  return fail(Errc::kCorrupt, "SPZ: " + why);
}

std::size_t plausible_bytes(std::size_t file_bytes) {
  return kPlausibleFloorBytes + kPlausibleRatio * file_bytes;
}

Status check_header(const Packed& packed, std::size_t plausible) {
  if (packed.sh_degree > 4) return corrupt("SH degree " + std::to_string(packed.sh_degree));
  if (packed.fractional_bits > 24) return corrupt("too many fractional bits");
  std::size_t each = 0;
  for (std::size_t i = 0; i < kStreamCount; ++i) each += packed.bytes_each(static_cast<Stream>(i));
  if (packed.count > plausible / each) {
    return corrupt(std::to_string(packed.count) + " Gaussians are implausible for the size of the file");
  }
  return {};
}

void read_fields(ByteReader& reader, Packed& packed) {
  packed.count = reader.read<std::uint32_t>();
  packed.sh_degree = reader.read<std::uint8_t>();
  packed.fractional_bits = reader.read<std::uint8_t>();
  packed.flags = reader.read<std::uint8_t>();
}

/// Versions 1 to 3: header of 16 bytes, then the streams one after the other.
Result<Packed> open_gzip(std::span<const std::byte> file) {
  EDGESPLAT_TRY(const auto plain, gunzip(file, plausible_bytes(file.size())));
  ByteReader reader(plain);
  Packed packed;
  if (reader.read<std::uint32_t>() != kMagic) return corrupt("the gzip stream does not hold it");
  packed.version = reader.read<std::uint32_t>();
  if (packed.version < 1 || packed.version > 3) {
    return corrupt("version " + std::to_string(packed.version) + " in a gzip stream");
  }
  read_fields(reader, packed);
  reader.skip(1);
  EDGESPLAT_TRY_STATUS(check_header(packed, plain.size()));
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    const auto part = reader.take(packed.count * packed.bytes_each(static_cast<Stream>(i)));
    packed.streams[i].assign(part.begin(), part.end());
  }
  if (!reader.ok()) return corrupt("truncated");
  return packed;
}

struct StreamLength {
  std::uint64_t compressed_bytes = 0;
  std::uint64_t plain_bytes = 0;
};

/// Version 4: plain header, extension records, a table of lengths, the zstd streams that are not empty.
Result<Packed> open_zstd(std::span<const std::byte> file) {
  ByteReader reader(file);
  Packed packed;
  reader.skip(4);
  packed.version = reader.read<std::uint32_t>();
  if (packed.version != 4) return corrupt("unknown version " + std::to_string(packed.version));
  read_fields(reader, packed);
  const auto stream_count = reader.read<std::uint8_t>();
  const auto table_begin = reader.read<std::uint32_t>();
  if (!reader.ok() || table_begin < kHeaderBytes || table_begin > file.size()) return corrupt("truncated");
  EDGESPLAT_TRY_STATUS(check_header(packed, plausible_bytes(file.size())));
  reader.skip(table_begin - reader.position());
  std::vector<StreamLength> lengths(stream_count);
  for (StreamLength& length : lengths) {
    length.compressed_bytes = reader.read<std::uint64_t>();
    length.plain_bytes = reader.read<std::uint64_t>();
  }
  std::size_t next = 0;
  for (std::size_t i = 0; i < kStreamCount; ++i) {
    const std::size_t expected = packed.count * packed.bytes_each(static_cast<Stream>(i));
    if (expected == 0) continue;  // writers leave empty streams out
    if (next == lengths.size()) return corrupt("streams are missing");
    const StreamLength& length = lengths[next++];
    if (length.plain_bytes != expected) return corrupt("a stream has another length than its count asks for");
    const auto part = reader.take(static_cast<std::size_t>(length.compressed_bytes));
    if (!reader.ok()) return corrupt("truncated");
    EDGESPLAT_TRY(packed.streams[i], zstd_decompress(part, expected));
  }
  if (next != lengths.size()) return corrupt("more streams than it should have");
  return packed;
}

void write_fields(ByteWriter& writer, const Packed& packed) {
  writer.write(kMagic);
  writer.write(packed.version);
  writer.write(packed.count);
  writer.write(packed.sh_degree);
  writer.write(packed.fractional_bits);
  writer.write(packed.flags);
}

Result<std::vector<std::byte>> close_zstd(const Packed& packed) {
  std::vector<std::vector<std::byte>> compressed;
  std::vector<StreamLength> lengths;
  for (const auto& stream : packed.streams) {
    if (stream.empty()) continue;
    EDGESPLAT_TRY(auto bytes, zstd_compress(stream, kZstdLevel));
    lengths.push_back({bytes.size(), stream.size()});
    compressed.push_back(std::move(bytes));
  }
  ByteWriter writer;
  write_fields(writer, packed);
  writer.write(static_cast<std::uint8_t>(lengths.size()));
  writer.write(static_cast<std::uint32_t>(kHeaderBytes));
  for (int i = 0; i < 12; ++i) writer.write(std::uint8_t{0});
  for (const StreamLength& length : lengths) {
    writer.write(length.compressed_bytes);
    writer.write(length.plain_bytes);
  }
  for (const auto& bytes : compressed) writer.write_bytes(bytes);
  return writer.take();
}

}  // namespace

std::size_t Packed::bytes_each(Stream stream) const {
  switch (stream) {
    case kPositions:
      return version == 1 ? 6 : 9;
    case kAlphas:
      return 1;
    case kRotations:
      return version < 3 ? 3 : 4;
    case kSh:
      return 3 * ((sh_degree + std::size_t{1}) * (sh_degree + std::size_t{1}) - 1);
    case kColours:
    case kScales:
      break;
  }
  return 3;
}

Result<Packed> open(std::span<const std::byte> file) {
  ByteReader reader(file);
  if (reader.read<std::uint32_t>() == kMagic) return open_zstd(file);
  if (file.size() >= 2 && file[0] == std::byte{0x1F} && file[1] == std::byte{0x8B}) return open_gzip(file);
  return corrupt("neither \"NGSP\" nor a gzip stream");
}

Result<std::vector<std::byte>> close(const Packed& packed) {
  if (packed.version == 4) return close_zstd(packed);
  if (packed.version != 2 && packed.version != 3) {
    return fail(Errc::kInvalidArgument, "SPZ is written as version 2, 3 or 4");
  }
  ByteWriter writer;
  write_fields(writer, packed);
  writer.write(std::uint8_t{0});
  for (const auto& stream : packed.streams) writer.write_bytes(stream);
  return gzip(writer.bytes());
}

}  // namespace edgesplat::io::spz
