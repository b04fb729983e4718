// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/in_process_path.hpp"
#include "common/link/link_end.hpp"

#include <algorithm>
#include <functional>
#include <memory>

namespace edgesplat::test {

/// A robot's end of a link that outlives one server's end after another, in virtual time.
class RestartableLink {
 public:
  RestartableLink(const link::LinkEndOptions& robot, const link::LinkEndOptions& server)
      : clock(HostTime(from_seconds(100.0))), server_options_(server), robot_(robot, clock) {
    server_options_.role = link::Role::kServer;
    robot_.attach(std::make_unique<Way>(way_));
  }

  [[nodiscard]] link::LinkEnd& robot() { return robot_; }
  /// Null while there is none.
  [[nodiscard]] link::LinkEnd* server() { return server_.get(); }

  void start_server() {
    ++server_options_.session;
    server_ = std::make_unique<link::LinkEnd>(server_options_, clock);
    auto paths = link::make_in_process_paths();
    server_->attach(std::move(paths.server));
    *way_ = std::move(paths.robot);
  }
  /// What it had received or had to send is gone, and so is what was under way.
  void kill_server() {
    server_.reset();
    way_->reset();
  }
  /// Lets `seconds` pass; `each_ms` is called every millisecond.
  void run(double seconds, const std::function<void()>& each_ms) {
    const HostTime end = clock.now() + from_seconds(seconds);
    while (clock.now() < end) {
      each_ms();
      (void)robot_.step();
      if (server_) (void)server_->step();
      (void)robot_.step();
      clock.advance_to(clock.now() + std::chrono::milliseconds(1));
    }
  }

  VirtualClock clock;

 private:
  using SharedPath = std::shared_ptr<std::unique_ptr<link::ChunkPath>>;
  /// Leads to whichever server is there.
  class Way final : public link::ChunkPath {
   public:
    explicit Way(SharedPath to) : to_(std::move(to)) {}
    link::WriteOutcome write(link::Lane lane, const link::ChunkHeader& header,
                             std::span<const std::byte> payload) override {
      return *to_ ? (*to_)->write(lane, header, payload) : link::WriteOutcome::kRefused;
    }
    bool take(link::Lane lane, const link::ChunkHandler& handle) override {
      return *to_ && (*to_)->take(lane, handle);
    }
    [[nodiscard]] bool has_reader(link::Lane lane) const override { return *to_ && (*to_)->has_reader(lane); }

   private:
    const SharedPath to_;
  };

  link::LinkEndOptions server_options_;
  SharedPath way_ = std::make_shared<std::unique_ptr<link::ChunkPath>>();
  link::LinkEnd robot_;
  std::unique_ptr<link::LinkEnd> server_;
};

}  // namespace edgesplat::test
