// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/virtual_device/virtual_unit.hpp"

namespace edgesplat::virtual_device {

/// A virtual Avia (../shared/design/sensor-protocols.md, 2): announces itself once a second until a host
/// shakes hands, drops a host that sends no heartbeat for 3 s, forgets its settings when it is restarted.
/// Its points go out as data type 2.
class Sdk1Unit final : public VirtualUnit {
 public:
  Sdk1Unit(VirtualUnitConfig config, std::int64_t now_ns);

  [[nodiscard]] std::optional<Outgoing> points(std::span<const std::byte> recorded,
                                               std::int64_t true_ns) override;
  [[nodiscard]] std::optional<Outgoing> imu(std::span<const std::byte> recorded,
                                            std::int64_t true_ns) override;
  [[nodiscard]] std::vector<std::uint16_t> command_ports() const override;
  [[nodiscard]] std::vector<std::uint16_t> sending_ports() const override { return {}; }
  [[nodiscard]] bool is_measuring(std::int64_t now_ns) const override;

 private:
  struct Host {
    UnitAddress commands;
    UnitAddress points;
    UnitAddress imu;
  };

  void answer(std::uint16_t port, const UnitAddress& from, std::span<const std::byte> datagram,
              std::int64_t now_ns) override;
  void act(std::int64_t now_ns) override;
  void forget(std::int64_t now_ns) override;
  void acknowledge(std::uint16_t sequence, std::uint16_t command, const UnitAddress& to,
                   std::span<const std::byte> content);
  void set(std::uint16_t command, std::uint8_t value, std::int64_t now_ns);
  [[nodiscard]] std::uint32_t status_word(std::int64_t now_ns) const;
  [[nodiscard]] std::optional<Outgoing> data(std::uint8_t type, const UnitAddress& to,
                                             std::span<const std::byte> records, std::int64_t true_ns) const;

  std::optional<Host> host_;
  std::int64_t heard_ns_ = 0;  ///< the host, last
  std::int64_t next_announcement_ns_ = 0;
  bool measures_ = false;
  bool sends_imu_ = false;
  std::int64_t measures_from_ns_ = 0;
  std::uint16_t next_sequence_ = 0;
};

}  // namespace edgesplat::virtual_device
