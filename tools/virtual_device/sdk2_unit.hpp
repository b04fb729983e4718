// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/virtual_device/virtual_unit.hpp"

#include <map>

namespace edgesplat::virtual_device {

/// A virtual Mid-360 (../shared/design/sensor-protocols.md, 1): discovery, parameters, work states, state
/// pushes once a second, UTC for its pulses. Parameters are stored, as in the real one.
class Sdk2Unit final : public VirtualUnit {
 public:
  Sdk2Unit(VirtualUnitConfig config, std::int64_t now_ns);

  [[nodiscard]] std::optional<Outgoing> points(std::span<const std::byte> recorded,
                                               std::int64_t true_ns) override;
  [[nodiscard]] std::optional<Outgoing> imu(std::span<const std::byte> recorded,
                                            std::int64_t true_ns) override;
  [[nodiscard]] std::vector<std::uint16_t> command_ports() const override;
  [[nodiscard]] std::vector<std::uint16_t> sending_ports() const override;
  [[nodiscard]] bool is_measuring(std::int64_t now_ns) const override { return state(now_ns) == kSampling; }

 private:
  enum State : std::uint8_t { kSampling = 1, kIdle = 2, kMotorStart = 6, kReady = 9 };
  struct Request {
    std::uint32_t sequence = 0;
    std::uint16_t command = 0;
    std::span<const std::byte> content;
  };

  void answer(std::uint16_t port, const UnitAddress& from, std::span<const std::byte> datagram,
              std::int64_t now_ns) override;
  void act(std::int64_t now_ns) override;
  void forget(std::int64_t now_ns) override;

  void discover(const Request& request, const UnitAddress& from);
  void set_parameters(const Request& request, const UnitAddress& from, std::int64_t now_ns);
  void query(const Request& request, const UnitAddress& from, std::int64_t now_ns);
  void acknowledge(const Request& request, const UnitAddress& to, std::span<const std::byte> content);
  /// A return code for a parameter somebody wants to write; 0 = good.
  [[nodiscard]] std::uint8_t judge(std::uint16_t key, std::span<const std::byte> value) const;
  [[nodiscard]] std::optional<std::vector<std::byte>> value_of(std::uint16_t key, std::int64_t now_ns) const;
  [[nodiscard]] State state(std::int64_t now_ns) const;
  [[nodiscard]] std::optional<UnitAddress> host(std::uint16_t key) const;
  [[nodiscard]] std::optional<Outgoing> restamp(std::span<const std::byte> recorded, std::uint16_t host_key,
                                                std::uint16_t from_port, std::int64_t true_ns);

  std::map<std::uint16_t, std::vector<std::byte>> stored_;
  std::int64_t measures_from_ns_ = 0;  ///< where the work mode is to measure
  std::int64_t next_push_ns_ = 0;
  std::uint32_t next_sequence_ = 0;
  std::uint16_t points_sent_ = 0;
  std::uint16_t imu_sent_ = 0;
};

}  // namespace edgesplat::virtual_device
