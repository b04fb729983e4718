// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/udp_channel.hpp"

#include "common/base/udp_send.hpp"
#include "common/time/clock.hpp"
#include "robot/drivers/livox/port_holder.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <string>
#include <system_error>

namespace edgesplat::livox {
namespace {

constexpr std::int64_t kOldest_ns = 1'000'000'000;  // an older stamp is a wall clock that was set meanwhile

struct KernelNotes {
  std::int64_t wall_ns = 0;  ///< 0 = no stamp
  std::optional<std::uint32_t> drops;
};

KernelNotes read_notes(msghdr& header) {
  KernelNotes notes;
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(c), sizeof(stamp));
      notes.wall_ns = std::int64_t{stamp.tv_sec} * 1'000'000'000 + stamp.tv_nsec;
    } else if (c->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t drops = 0;
      std::memcpy(&drops, CMSG_DATA(c), sizeof(drops));
      notes.drops = drops;
    }
  }
  return notes;
}

std::string channel_name(Channel channel) {
  switch (channel) {
    case Channel::kPoints:
      return "LiDAR point";
    case Channel::kImu:
      return "LiDAR IMU";
    case Channel::kControl:
      return "LiDAR command";
    case Channel::kPush:
      return "LiDAR state";
  }
  return "LiDAR";
}

Endpoint endpoint_of(const sockaddr_in& address) {
  Endpoint endpoint;
  std::memcpy(endpoint.ip.data(), &address.sin_addr, endpoint.ip.size());
  endpoint.port = ntohs(address.sin_port);
  return endpoint;
}

Error port_error(Channel channel, in_addr address, std::uint16_t port, int error) {
  std::array<char, INET_ADDRSTRLEN> text{};
  (void)::inet_ntop(AF_INET, &address, text.data(), text.size());
  const std::string where = std::string(text.data()) + ":" + std::to_string(port);
  std::string context = "cannot listen for " + channel_name(channel) + " packets on UDP " + where + ": " +
                        std::generic_category().message(error);
  if (error == EADDRINUSE) {
    const auto holder = find_port_holder(port);
    context += holder ? "; " + holder->program + " (pid " + std::to_string(holder->pid) +
                            ") holds the port: stop it, or let the LiDAR send to another port"
                      : "; a program of another user holds the port: sudo ss -lunp 'sport = :" +
                            std::to_string(port) + "' names it";
  } else if (error == EADDRNOTAVAIL) {
    context += "; no network card has that address: see ip addr, or bind to 0.0.0.0";
  }
  return Error{Errc::kIo, std::move(context)};
}

}  // namespace

Status UdpChannel::open(in_addr address, std::uint16_t port, int receive_buffer_bytes, bool is_shared) {
  socket_.reset(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!socket_.valid()) return tl::unexpected(port_error(channel_, address, port, errno));
  (void)::setsockopt(fd(), SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes, sizeof(receive_buffer_bytes));
  const int on = 1;
  if (is_shared) (void)::setsockopt(fd(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  if (channel_ == Channel::kControl) (void)::setsockopt(fd(), SOL_SOCKET, SO_BROADCAST, &on, sizeof(on));
  (void)::setsockopt(fd(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof(on));
  (void)::setsockopt(fd(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on));
  sockaddr_in local{};
  local.sin_family = AF_INET;
  local.sin_addr = address;
  local.sin_port = htons(port);
  if (::bind(fd(), reinterpret_cast<const sockaddr*>(&local), sizeof(local)) != 0)
    return tl::unexpected(port_error(channel_, address, port, errno));
  socklen_t length = sizeof(local);
  if (::getsockname(fd(), reinterpret_cast<sockaddr*>(&local), &length) == 0) port_ = ntohs(local.sin_port);
  length = sizeof(granted_buffer_bytes_);
  (void)::getsockopt(fd(), SOL_SOCKET, SO_RCVBUF, &granted_buffer_bytes_, &length);
  granted_buffer_bytes_ /= 2;  // the kernel doubles it for its own bookkeeping and reports the double
  slots_.resize(kBatch);
  return {};
}

void UdpChannel::prepare_slots() {
  for (std::size_t i = 0; i < kBatch; ++i) {
    Slot& slot = slots_[i];
    slot.vector = {slot.bytes.data(), slot.bytes.size()};
    msghdr& header = headers_[i].msg_hdr;
    header = {};
    header.msg_name = &slot.sender;
    header.msg_namelen = sizeof(slot.sender);
    header.msg_iov = &slot.vector;
    header.msg_iovlen = 1;
    header.msg_control = slot.control.data();
    header.msg_controllen = slot.control.size();
  }
}

Result<std::span<const Datagram>> UdpChannel::receive(const Clock& clock, TransportCounters& counters) {
  prepare_slots();
  const int received = ::recvmmsg(fd(), headers_.data(), kBatch, MSG_DONTWAIT, nullptr);
  if (received < 0) {
    if (errno == EAGAIN || errno == EINTR) return std::span<const Datagram>{};
    return fail(Errc::kIo, "cannot read " + channel_name(channel_) +
                               " packets: " + std::generic_category().message(errno));
  }
  const ClockPair now = read_clocks(clock);
  std::size_t count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(received); ++i) {
    const KernelNotes notes = read_notes(headers_[i].msg_hdr);
    if (notes.drops) note_drops(*notes.drops, counters);
    if (only_from_ && slots_[i].sender.sin_addr.s_addr != only_from_->s_addr) {
      ++counters.foreign;
      continue;
    }
    const std::int64_t age_ns = now.wall_ns - notes.wall_ns;
    const bool believable = notes.wall_ns != 0 && age_ns >= 0 && age_ns <= kOldest_ns;
    // In the order of the socket, whatever the clocks say: a recording is replayed in the order of arrivals.
    newest_arrival_ = std::max(newest_arrival_, believable ? now.host_at(notes.wall_ns) : now.host);
    datagrams_[count++] = {channel_, newest_arrival_,
                           std::span<const std::byte>(slots_[i].bytes).first(headers_[i].msg_len),
                           endpoint_of(slots_[i].sender)};
    ++counters.datagrams;
  }
  return std::span<const Datagram>(datagrams_).first(count);
}

bool UdpChannel::send(const Endpoint& to, in_addr source, std::span<const std::byte> bytes) const {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(to.port);
  std::memcpy(&address.sin_addr, to.ip.data(), to.ip.size());
  return send_datagram(fd(), address, source, bytes);
}

void UdpChannel::note_drops(std::uint32_t total, TransportCounters& counters) {
  counters.kernel_dropped += total - drops_seen_;  // the kernel's counter wraps
  drops_seen_ = total;
}

}  // namespace edgesplat::livox
