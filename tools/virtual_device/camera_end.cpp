// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/camera_end.hpp"

#include "common/io/image_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"
#include "tools/virtual_device/frame_server.hpp"
#include "tools/virtual_device/gige_player.hpp"

#include <string>
#include <utility>

namespace edgesplat::virtual_device {
namespace {

class SocketEnd final : public CameraEnd {
 public:
  explicit SocketEnd(std::unique_ptr<FrameServer> frames) : frames_(std::move(frames)) {}
  bool wait_for_robot(std::chrono::milliseconds timeout, const std::stop_token& stop) override {
    return frames_->wait_for_robot(timeout, stop);
  }
  void push(const FrameMessage& frame, std::vector<std::byte> encoded) override {
    frames_->push(frame, std::move(encoded));
  }
  void finish(StreamReport& report) override {
    frames_->finish();
    report.frames_sent = frames_->sent();
    report.frames_lost = frames_->lost();
  }

 private:
  std::unique_ptr<FrameServer> frames_;
};

class GigeEnd final : public CameraEnd {
 public:
  GigeEnd(std::unique_ptr<GigePlayer> player, double loss) : player_(std::move(player)), loss_(loss) {}
  bool wait_for_robot(std::chrono::milliseconds timeout, const std::stop_token& stop) override {
    const bool came = player_->camera().wait_for_robot(timeout, stop);
    player_->camera().set_faults({.loss = loss_});  // in mid-run: setting up a camera takes 100 commands
    return came;
  }
  void push(const FrameMessage& frame, std::vector<std::byte> encoded) override {
    player_->push(frame, std::move(encoded));
  }
  void finish(StreamReport& report) override {
    player_->finish();
    const GigeServerCounters counters = player_->camera().counters();
    report.frames_sent = counters.frames_sent;
    report.frames_lost = player_->lost();
    report.camera_packets = counters.packets_sent;
    report.camera_packets_lost = counters.packets_lost;
    report.camera_packets_resent = counters.packets_resent;
  }

 private:
  std::unique_ptr<GigePlayer> player_;
  double loss_;
};

// What a recording's camera is, from its first picture.
struct FirstPicture {
  io::ImageHeader header;
  bool ptp = false;
};
Result<FirstPicture> find_first_picture(const std::filesystem::path& recording) {
  EDGESPLAT_TRY(io::McapReader reader, io::McapReader::open(recording));
  reader.select({.topics = {std::string(io::kCameraMetaTopic), std::string(io::kCameraImageTopic)}});
  FirstPicture first;
  while (const auto message = reader.next()) {
    if (message->channel->topic == io::kCameraMetaTopic) {
      const auto meta = io::decode_frame_meta(message->payload);
      first.ptp = meta && meta->stamp_source == sensor::StampSource::kPtp;
      continue;
    }
    const auto image = io::decode_compressed_image(message->payload);
    if (!image) continue;
    if (const auto header = io::read_image_header(image->encoded)) {
      first.header = *header;
      return first;
    }
  }
  return fail(Errc::kNotFound, recording.string() + " has no picture for a GigE Vision camera");
}

}  // namespace

Result<std::unique_ptr<CameraEnd>> open_camera(const StreamOptions& options, const Clock& clock) {
  if (options.camera == CameraKind::kFrameSocket) {
    EDGESPLAT_TRY(auto frames, FrameServer::listen(options.frame_port));
    return std::make_unique<SocketEnd>(std::move(frames));
  }
  EDGESPLAT_TRY(const FirstPicture first, find_first_picture(options.recording));
  GigeServerOptions gige = options.gige;
  gige.model.width_px = static_cast<std::uint32_t>(first.header.width_px);
  gige.model.height_px = static_cast<std::uint32_t>(first.header.height_px);
  gige.seed = options.seed;
  EDGESPLAT_TRY(auto player, GigePlayer::open(gige, clock));
  player->camera().set_ptp(first.ptp);
  return std::make_unique<GigeEnd>(std::move(player), options.gige_loss);
}

}  // namespace edgesplat::virtual_device
