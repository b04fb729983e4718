// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/gige_gvcp.hpp"

#include "tools/virtual_device/big_endian.hpp"

#include <type_traits>

namespace edgesplat::virtual_device {
namespace {

constexpr std::uint8_t kCommandKey = 0x42;
constexpr std::uint8_t kAnswerWanted = 0x01;
constexpr std::uint8_t kExtendedIds = 0x10;
constexpr std::uint32_t kPacketIdMask = 0x00FF'FFFF;

enum Code : std::uint16_t {
  kDiscovery = 0x0002,
  kResend = 0x0040,
  kReadReg = 0x0080,
  kWriteReg = 0x0082,
  kReadMem = 0x0084,
  kWriteMem = 0x0086,
};

// Every ack has its command's code plus one.
ByteWriter begin_answer(std::uint16_t status, std::uint16_t ack_code, std::size_t payload_bytes,
                        std::uint16_t id) {
  ByteWriter out;
  write_be16(out, status);
  write_be16(out, ack_code);
  write_be16(out, static_cast<std::uint16_t>(payload_bytes));
  write_be16(out, id);
  return out;
}

std::vector<std::byte> error_answer(GvcpStatus status, std::uint16_t command, std::uint16_t id) {
  return begin_answer(static_cast<std::uint16_t>(status), static_cast<std::uint16_t>(command + 1), 0, id)
      .take();
}

std::uint16_t code_of(const GvcpCommand& command) {
  return std::visit(
      [](const auto& what) -> std::uint16_t {
        using T = std::decay_t<decltype(what)>;
        if constexpr (std::is_same_v<T, GvcpDiscovery>) return kDiscovery;
        if constexpr (std::is_same_v<T, GvcpReadRegister>) return kReadReg;
        if constexpr (std::is_same_v<T, GvcpWriteRegister>) return kWriteReg;
        if constexpr (std::is_same_v<T, GvcpReadMemory>) return kReadMem;
        if constexpr (std::is_same_v<T, GvcpWriteMemory>) return kWriteMem;
        if constexpr (std::is_same_v<T, GvcpPacketResend>) return kResend;
      },
      command.what);
}

GvcpPacketResend decode_resend(ByteReader& in, bool extended) {
  GvcpPacketResend resend;
  if (!extended) {
    resend.frame = read_be32(in) & 0xFFFFU;  // above: the stream channel
    resend.first_packet = read_be32(in) & kPacketIdMask;
    resend.last_packet = read_be32(in) & kPacketIdMask;
    return resend;
  }
  in.skip(sizeof(std::uint32_t));
  resend.first_packet = read_be32(in);
  resend.last_packet = read_be32(in);
  resend.frame = read_be64(in);
  return resend;
}

/// False where the payload does not have the form of this command.
bool decode_payload(std::uint16_t code, bool extended, std::span<const std::byte> payload,
                    GvcpCommand& command) {
  ByteReader in(payload);
  switch (code) {
    case kDiscovery:
      command.what = GvcpDiscovery{};
      return true;
    case kResend:
      command.what = decode_resend(in, extended);
      return in.ok();
    case kReadReg: {
      GvcpReadRegister read;
      while (in.remaining() >= sizeof(std::uint32_t)) read.addresses.push_back(read_be32(in));
      const bool good = !read.addresses.empty() && in.remaining() == 0;
      command.what = std::move(read);
      return good;
    }
    case kWriteReg: {
      GvcpWriteRegister write;
      while (in.remaining() >= 2 * sizeof(std::uint32_t)) {
        const std::uint32_t address = read_be32(in);
        write.writes.emplace_back(address, read_be32(in));
      }
      const bool good = !write.writes.empty() && in.remaining() == 0;
      command.what = std::move(write);
      return good;
    }
    case kReadMem: {
      GvcpReadMemory read;
      read.address = read_be32(in);
      read.count_bytes = static_cast<std::uint16_t>(read_be32(in) & 0xFFFFU);
      command.what = read;
      return in.ok() && read.count_bytes > 0 && read.count_bytes <= kGvcpMaxPayloadBytes - 4;
    }
    case kWriteMem: {
      GvcpWriteMemory write;
      write.address = read_be32(in);
      write.data = in.take(in.remaining());
      command.what = write;
      return in.ok() && !write.data.empty();
    }
    default:
      return false;
  }
}

bool is_known(std::uint16_t code) {
  return code == kDiscovery || code == kResend || code == kReadReg || code == kWriteReg || code == kReadMem ||
         code == kWriteMem;
}

}  // namespace

GvcpDecoded decode_gvcp(std::span<const std::byte> datagram) {
  ByteReader in(datagram);
  const auto key = in.read<std::uint8_t>();
  const auto flags = in.read<std::uint8_t>();
  const std::uint16_t code = read_be16(in);
  const std::uint16_t payload_bytes = read_be16(in);
  GvcpCommand command;
  command.id = read_be16(in);
  command.wants_answer = (flags & kAnswerWanted) != 0;
  if (!in.ok() || key != kCommandKey || command.id == 0) return GvcpFault{};
  const auto refuse = [&](GvcpStatus status) -> GvcpFault {
    if (!command.wants_answer) return {};
    return {error_answer(status, code, command.id)};
  };
  if (!is_known(code)) return refuse(GvcpStatus::kNotImplemented);
  if (payload_bytes != in.remaining() || payload_bytes > kGvcpMaxPayloadBytes)
    return refuse(GvcpStatus::kInvalidParameter);
  if (!decode_payload(code, (flags & kExtendedIds) != 0, in.take(payload_bytes), command))
    return refuse(GvcpStatus::kInvalidParameter);
  return command;
}

std::vector<std::byte> gvcp_discovery_ack(std::uint16_t id, std::span<const std::byte> bootstrap) {
  ByteWriter out = begin_answer(0, kDiscovery + 1, bootstrap.size(), id);
  out.write_bytes(bootstrap);
  return out.take();
}

std::vector<std::byte> gvcp_read_register_ack(std::uint16_t id, std::span<const std::uint32_t> values) {
  ByteWriter out = begin_answer(0, kReadReg + 1, values.size_bytes(), id);
  for (const std::uint32_t value : values) write_be32(out, value);
  return out.take();
}

std::vector<std::byte> gvcp_write_register_ack(std::uint16_t id, std::uint16_t done) {
  ByteWriter out = begin_answer(0, kWriteReg + 1, 4, id);
  write_be32(out, done);
  return out.take();
}

std::vector<std::byte> gvcp_read_memory_ack(std::uint16_t id, std::uint32_t address,
                                            std::span<const std::byte> data) {
  ByteWriter out = begin_answer(0, kReadMem + 1, 4 + data.size(), id);
  write_be32(out, address);
  out.write_bytes(data);
  return out.take();
}

std::vector<std::byte> gvcp_write_memory_ack(std::uint16_t id, std::uint16_t count_bytes) {
  ByteWriter out = begin_answer(0, kWriteMem + 1, 4, id);
  write_be32(out, count_bytes);
  return out.take();
}

std::vector<std::byte> gvcp_error(const GvcpCommand& command, GvcpStatus status) {
  return error_answer(status, code_of(command), command.id);
}

}  // namespace edgesplat::virtual_device
