// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/camera_input.hpp"

#include "common/log/log.hpp"
#include "robot/app/picture_recording.hpp"
#include "robot/drivers/aravis/gige_camera.hpp"
#include "robot/drivers/frame_socket/frame_client.hpp"
#include "robot/drivers/frame_socket/frame_source.hpp"

#include <utility>

namespace edgesplat::app {
namespace {

constexpr nanoseconds kReceiveTimeout = std::chrono::milliseconds(500);

class SocketCamera final : public CameraInput {
 public:
  SocketCamera(frame_socket::FrameClient client, frame_socket::PictureSize size)
      : client_(std::move(client)), source_(size) {}

  void receive(const std::stop_token& stop, const Sink& sink, replay::Recorder* recorder) override {
    bool was_connected = false;
    while (!stop.stop_requested()) {
      const auto received = client_.receive(stop, kReceiveTimeout);
      if (client_.connected() != was_connected) {
        was_connected = !was_connected;
        if (was_connected) {
          EDGESPLAT_LOG_INFO("camera", "connected");
        } else {
          EDGESPLAT_LOG_WARN("camera", "connection lost", "why", client_.why_not_connected());
        }
      }
      if (!received) continue;
      if (recorder != nullptr) recorder->on_frame(received->frame, received->arrival, received->arrival);
      auto measurement = source_.on_frame(received->frame, received->arrival);
      if (measurement) sink(std::move(*measurement));
    }
  }

  void publish_counters(metrics::Registry& metrics) const override {
    const frame_socket::FrameCounters& c = source_.counters();
    metrics.counter("camera.frames").add(c.frames);
    metrics.counter("camera.lost").add(c.lost);
    metrics.counter("camera.bad_pictures").add(c.bad_pictures);
    metrics.counter("camera.wrong_size").add(c.wrong_size);
    metrics.counter("camera.disconnects").add(client_.counters().disconnects);
    metrics.counter("camera.bad_payloads").add(client_.assembler_counters().bad_payloads);
  }

 private:
  frame_socket::FrameClient client_;
  frame_socket::FrameSource source_;
};

void publish_pulses(const sync::TriggerCounters& c, metrics::Registry& metrics) {
  metrics.counter("trigger.matched").add(c.matched);
  metrics.counter("trigger.searching").add(c.searching);
  metrics.counter("trigger.unmatched").add(c.unmatched);
  metrics.counter("trigger.lost_frames").add(c.lost_frames);
  metrics.counter("trigger.missed_pulses").add(c.missed_pulses);
  metrics.counter("trigger.slips").add(c.slips);
  metrics.counter("trigger.locks").add(c.locks);
}

class GigeCameraInput final : public CameraInput {
 public:
  GigeCameraInput(std::unique_ptr<aravis::GigeCamera> camera, sync::TriggeredStamps* pulses,
                  const Clock& clock)
      : camera_(std::move(camera)), pulses_(pulses), clock_(clock) {}

  void receive(const std::stop_token& stop, const Sink& sink, replay::Recorder* recorder) override {
    while (!stop.stop_requested()) {
      auto measurement = camera_->receive(stop, kReceiveTimeout);
      if (!measurement) continue;
      auto& frame = std::get<sensor::CameraFrame>(*measurement);
      if (pulses_ != nullptr && !pulses_->stamp(frame)) continue;
      const HostTime handed_on = clock_.now();
      const sensor::CameraFrame recorded = frame;  // shares the picture
      sink(std::move(*measurement));
      if (recorder != nullptr) record_picture(recorded, handed_on, *recorder);
    }
  }

  void publish_counters(metrics::Registry& metrics) const override {
    const aravis::GigeCounters& c = camera_->counters();
    metrics.counter("camera.frames").add(c.frames);
    metrics.counter("camera.lost").add(c.lost);
    metrics.counter("camera.incomplete").add(c.incomplete);
    metrics.counter("camera.missed_pulses").add(c.missed_pulses);
    metrics.counter("camera.duplicate").add(c.duplicate);
    metrics.counter("camera.restarts").add(c.restarts);
    metrics.counter("camera.bad_pictures").add(c.bad_pictures);
    metrics.counter("camera.wrong_size").add(c.wrong_size);
    const aravis::SessionCounters& s = camera_->session_counters();
    metrics.counter("camera.opens").add(s.opens);
    metrics.counter("camera.failed_opens").add(s.failed_opens);
    metrics.counter("camera.silences").add(s.silences);
    metrics.counter("camera.control_losses").add(s.control_losses);
    metrics.counter("camera.recoveries").add(s.recoveries);
    metrics.counter("camera.moves").add(s.moves);
    metrics.gauge("camera.longest_outage_s").set(to_seconds(s.longest_outage));
    const aravis::StreamStatistics t = camera_->statistics();
    metrics.counter("camera.underruns").add(t.underruns);
    metrics.counter("camera.packets_resent").add(t.packets_resent);
    metrics.counter("camera.packets_missing").add(t.packets_missing);
    if (pulses_ != nullptr) publish_pulses(pulses_->counters(), metrics);
  }

 private:
  std::unique_ptr<aravis::GigeCamera> camera_;
  sync::TriggeredStamps* pulses_;
  const Clock& clock_;
};

}  // namespace

Result<std::unique_ptr<CameraInput>> open_camera(const robot_config::CameraSettings& config,
                                                 const sensor::CameraMount& mount, const Clock& clock,
                                                 sync::TriggeredStamps* pulses) {
  const int width_px = mount.model.width_px, height_px = mount.model.height_px;
  if (config.source == robot_config::CameraSource::kGige) {
    EDGESPLAT_TRY(auto camera, aravis::GigeCamera::create(config.gige, {width_px, height_px}, clock));
    return std::make_unique<GigeCameraInput>(std::move(camera), pulses, clock);
  }
  frame_socket::FrameClientConfig socket;
  socket.host = config.host;
  socket.port = config.port;
  EDGESPLAT_TRY(frame_socket::FrameClient client, frame_socket::FrameClient::create(socket, clock));
  return std::make_unique<SocketCamera>(std::move(client), frame_socket::PictureSize{width_px, height_px});
}

}  // namespace edgesplat::app
