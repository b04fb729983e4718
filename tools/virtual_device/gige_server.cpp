// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/gige_server.hpp"

#include "common/thread/stop_fd.hpp"
#include "tools/simulate/noise.hpp"
#include "tools/virtual_device/pacer.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <utility>

namespace edgesplat::virtual_device {
namespace {

constexpr std::size_t kWaitingExposures = 4;
constexpr int kHeartbeatCheck_ms = 100;
constexpr std::size_t kBurstBytes = std::size_t{32} << 10U;  // sent at once before the pace is looked at
constexpr auto kLinger = std::chrono::milliseconds(300);
constexpr std::uint32_t kMostResent = 4096;  // packets for one request

}  // namespace

Result<std::unique_ptr<GigeServer>> GigeServer::open(const GigeServerOptions& options, const Clock& clock) {
  in_addr address{};
  if (::inet_pton(AF_INET, options.address.c_str(), &address) != 1) {
    return fail(Errc::kInvalidConfig,
                "'" + options.address + "' is no IPv4 address for the camera; give it as 127.0.0.1");
  }
  GigeServerOptions checked = options;
  checked.model.address_ipv4 = ntohl(address.s_addr);
  checked.path_bytes = std::clamp(options.path_bytes, kMinPacketBytes, kMaxPacketBytes);
  if (checked.model.serial.empty()) {
    std::array<char, 16> serial{};
    std::snprintf(serial.data(), serial.size(), "ES-%08X", checked.model.address_ipv4);
    checked.model.serial = serial.data();
  }
  EDGESPLAT_TRY(GigeSockets sockets, GigeSockets::open(checked.model.address_ipv4, options.address));
  return std::unique_ptr<GigeServer>(new GigeServer(checked, std::move(sockets), clock));
}

GigeServer::GigeServer(const GigeServerOptions& options, GigeSockets sockets, const Clock& clock)
    : options_(options),
      sockets_(std::move(sockets)),
      clock_(clock),
      device_(options.model),
      queue_({.items = kWaitingExposures}, thread::Overflow::kDropOldest) {
  control_worker_.emplace("gige-control", [this](const std::stop_token& stop) { return control_step(stop); });
  stream_worker_.emplace(thread::Worker::consume<GigeExposure>(
      "gige-stream", queue_, [this](const GigeExposure& exposure) { send_frame(exposure); }));
}

GigeServer::~GigeServer() {
  finish();
}

void GigeServer::finish() {
  queue_.close();
  if (stream_worker_) stream_worker_->join();
  if (control_worker_) {
    if (frames_sent_ > 0) linger();
    control_worker_->request_stop();
    control_worker_->join();
    control_worker_.reset();
  }
}

/// The last frame's lost packets may still be asked for.
void GigeServer::linger() {
  Pacer pacer(1.0);
  (void)pacer.wait_for(HostTime{}, {});
  (void)pacer.wait_for(HostTime{} + kLinger, {});
}

bool GigeServer::control_step(const std::stop_token& stop) {
  const thread::StopFd stop_fd(stop);
  while (!stop.stop_requested()) {
    std::array<pollfd, 3> fds{pollfd{stop_fd.get(), POLLIN, 0}, pollfd{sockets_.control.get(), POLLIN, 0},
                              pollfd{sockets_.broadcasts.get(), POLLIN, 0}};
    (void)::poll(fds.data(), fds.size(), kHeartbeatCheck_ms);
    if (fds[1].revents != 0) take_command(sockets_.control);
    if (fds[2].revents != 0) take_command(sockets_.broadcasts);
    const std::lock_guard lock(mutex_);
    device_.tick(clock_.now());
  }
  return false;
}

void GigeServer::take_command(const UniqueFd& socket) {
  std::array<std::byte, 2048> datagram{};
  sockaddr_in from{};
  socklen_t length = sizeof(from);
  const ssize_t bytes = ::recvfrom(socket.get(), datagram.data(), datagram.size(), MSG_DONTWAIT,
                                   reinterpret_cast<sockaddr*>(&from), &length);
  if (bytes <= 0) return;
  on_command(std::span(datagram).first(static_cast<std::size_t>(bytes)),
             {ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)});
}

void GigeServer::on_command(std::span<const std::byte> datagram, GigePeer from) {
  const GigeFaults now = faults();
  if (now.silent || wire_loses(now.loss)) return;
  std::vector<std::byte> answer;
  {
    const std::lock_guard lock(mutex_);
    answer = device_.on_datagram(datagram, from, clock_.now());
  }
  acquiring_changed_.notify_all();
  if (!answer.empty() && !wire_loses(now.loss)) send(sockets_.control, answer, from);
  serve_effects();
}

/// What a command set off besides its answer.
void GigeServer::serve_effects() {
  std::unique_lock lock(mutex_);
  const auto test_bytes = device_.take_test_packet_bytes();
  const auto triggered = device_.take_triggered_frame();
  const auto to = device_.stream_to();
  const std::uint32_t packet_bytes = device_.registers().packet_bytes();
  lock.unlock();
  if (test_bytes) send_test_packet(*test_bytes);
  if (triggered && to) stream_frame(*triggered, *to, packet_bytes);
  while (true) {
    lock.lock();
    const auto wanted = device_.take_resend();
    lock.unlock();
    if (!wanted) return;
    resend(*wanted);
  }
}

void GigeServer::send_test_packet(std::uint32_t bytes) {
  if (bytes > options_.path_bytes) return;  // do not fragment: it is lost on the way
  std::optional<GigePeer> to;
  {
    const std::lock_guard lock(mutex_);
    to = device_.stream_to();
  }
  if (to) send(sockets_.stream, std::vector<std::byte>(bytes - kIpUdpHeaderBytes), *to);
}

void GigeServer::resend(const GvcpPacketResend& wanted) {
  std::shared_ptr<const GvspFrame> frame;
  std::optional<GigePeer> to;
  std::uint32_t packet_bytes = 0;
  {
    const std::lock_guard lock(mutex_);
    frame = device_.find_frame(wanted.frame);
    to = device_.stream_to();
    packet_bytes = device_.registers().packet_bytes();
  }
  const GigeFaults now = faults();
  if (!to || now.half_open) return;
  const std::uint32_t count = frame ? gvsp_packet_count(frame->payload.size(), packet_bytes) : 0;
  std::vector<std::byte> packet;
  for (std::uint32_t i = 0; i < kMostResent && wanted.first_packet + i <= wanted.last_packet; ++i) {
    const std::uint32_t index = wanted.first_packet + i;
    if (index >= count) {
      ++packets_unavailable_;
      send(sockets_.stream, gvsp_unavailable(static_cast<std::uint16_t>(wanted.frame), index), *to);
      return;
    }
    encode_gvsp_packet(*frame, index, packet_bytes, GvspStatus::kResent, packet);
    ++packets_resent_;
    if (!wire_loses(now.loss)) send(sockets_.stream, packet, *to);
  }
}

void GigeServer::push(GigeExposure exposure) {
  queue_.push(std::move(exposure));
}

void GigeServer::miss_pulse() {
  const std::lock_guard lock(mutex_);
  device_.miss_pulse();
}

void GigeServer::send_frame(const GigeExposure& exposure) {
  std::shared_ptr<const GvspFrame> frame;
  std::optional<GigePeer> to;
  std::uint32_t packet_bytes = 0;
  {
    const std::lock_guard lock(mutex_);
    frame = device_.expose(exposure);
    to = device_.stream_to();
    packet_bytes = device_.registers().packet_bytes();
  }
  const GigeFaults now = faults();
  if (!frame || !to || now.silent || now.half_open) {
    ++frames_unsent_;
    return;
  }
  stream_frame(*frame, *to, packet_bytes);
  ++frames_sent_;
}

void GigeServer::stream_frame(const GvspFrame& frame, GigePeer to, std::uint32_t packet_bytes) {
  const GigeFaults now = faults();
  const std::uint32_t count = gvsp_packet_count(frame.payload.size(), packet_bytes);
  Pacer wire(1.0);
  (void)wire.wait_for(HostTime{}, {});  // begins now
  std::vector<std::byte> packet;
  std::size_t sent_bytes = 0, burst_bytes = 0;
  for (std::uint32_t index = 0; index < count; ++index) {
    encode_gvsp_packet(frame, index, packet_bytes, GvspStatus::kFirst, packet);
    ++packets_sent_;
    if (!wire_loses(now.loss)) send(sockets_.stream, packet, to);
    if (index == count / 4 && now.held_up_s > 0.0)
      (void)wire.wait_for(HostTime{} + from_seconds(now.held_up_s), {});
    sent_bytes += packet.size();
    burst_bytes += packet.size();
    if (burst_bytes < kBurstBytes) continue;
    burst_bytes = 0;
    const double due_s = static_cast<double>(sent_bytes) / options_.link_bytes_per_s;
    (void)wire.wait_for(HostTime{} + from_seconds(due_s), {});
  }
}

GigeFaults GigeServer::faults() const {
  const std::lock_guard lock(mutex_);
  return faults_;
}

bool GigeServer::wire_loses(double share) {
  if (share <= 0.0) return false;
  const bool loses =
      simulate::NoiseStream(options_.seed, simulate::NoisePurpose::kStreamFault, draws_++).uniform() < share;
  if (loses) ++packets_lost_;
  return loses;
}

bool GigeServer::send(const UniqueFd& socket, std::span<const std::byte> packet, GigePeer to) {
  const sockaddr_in address = to_sockaddr(to);
  const ssize_t sent = ::sendto(socket.get(), packet.data(), packet.size(), MSG_NOSIGNAL,
                                reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  if (sent >= 0) return true;
  ++packets_refused_;
  return false;
}

bool GigeServer::wait_for_robot(std::chrono::milliseconds timeout, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  return acquiring_changed_.wait_for(lock, stop, timeout, [this] { return device_.acquiring(); });
}

void GigeServer::set_faults(const GigeFaults& faults) {
  const std::lock_guard lock(mutex_);
  faults_ = faults;
}

void GigeServer::set_clock(GigeDevice::DeviceTime clock) {
  const std::lock_guard lock(mutex_);
  device_.set_clock(std::move(clock));
}

void GigeServer::set_ptp(bool master_present, std::int64_t offset_ns) {
  const std::lock_guard lock(mutex_);
  device_.set_ptp(master_present, offset_ns);
}

void GigeServer::reboot() {
  const std::lock_guard lock(mutex_);
  device_.reboot();
}

GigeServerCounters GigeServer::counters() const {
  GigeServerCounters all;
  all.frames_sent = frames_sent_;
  all.frames_unsent = frames_unsent_ + queue_.stats().dropped;
  all.packets_sent = packets_sent_;
  all.packets_lost = packets_lost_;
  all.packets_resent = packets_resent_;
  all.packets_unavailable = packets_unavailable_;
  all.packets_refused = packets_refused_;
  const std::lock_guard lock(mutex_);
  all.control_losses = device_.control_losses();
  return all;
}

}  // namespace edgesplat::virtual_device
