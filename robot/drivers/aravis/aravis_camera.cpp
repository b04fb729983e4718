// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/aravis_camera.hpp"

#include "robot/drivers/aravis/aravis_features.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace edgesplat::aravis {
namespace {

constexpr int kDefaultPacketBytes = 1500;
constexpr unsigned kPacketTimeout_us = 10'000;    // before a packet is asked for again
constexpr unsigned kFrameRetention_us = 150'000;  // after its last packet an incomplete frame is given up
// Packets asked for again, over a frame's packets, at most; libaravis' own limit. After a pause of the sender
// it asks for all that have not come yet, so a small limit would leave none for those that are really lost.
constexpr double kResendRatio = 2.0;
constexpr guint kFramesInSocket = 4;
constexpr guint kLeastSocketBytes = 4U << 20U;  // the kernel counts some KB a packet, however small it is
constexpr int kStreamNiceness = -10;

std::optional<double> chunk_number(ArvChunkParser* parser, ArvBuffer* buffer, const char* name) {
  ErrorSlot as_float;
  const double number = arv_chunk_parser_get_float_value(parser, buffer, name, as_float.out());
  if (as_float.status(name)) return number;
  ErrorSlot as_integer;  // some cameras count whole microseconds
  const gint64 whole = arv_chunk_parser_get_integer_value(parser, buffer, name, as_integer.out());
  if (as_integer.status(name)) return static_cast<double>(whole);
  return std::nullopt;
}

std::optional<std::int64_t> chunk_integer(ArvChunkParser* parser, ArvBuffer* buffer, const char* name) {
  ErrorSlot error;
  const gint64 value = arv_chunk_parser_get_integer_value(parser, buffer, name, error.out());
  if (error.status(name)) return value;
  return std::nullopt;
}

/// From the camera's ticks; without a known rate they are taken for ns.
std::int64_t ticks_to_ns(std::int64_t ticks, std::uint64_t ticks_per_second) {
  if (ticks_per_second == 0 || ticks_per_second == 1'000'000'000) return ticks;
  return std::llround(static_cast<long double>(ticks) * 1e9L / static_cast<long double>(ticks_per_second));
}

}  // namespace

class AravisCamera::Device {
 public:
  Device(GObjectPtr<ArvCamera> camera, const Clock& clock)
      : camera_(std::move(camera)), features_(camera_.get()), clock_(clock) {}
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] Status set_up(const GigeCameraConfig& config);
  [[nodiscard]] Status start();
  [[nodiscard]] std::optional<RawFrame> receive(const std::stop_token& stop, nanoseconds timeout);
  [[nodiscard]] Result<ClockReading> read_clock();
  [[nodiscard]] StreamStatistics statistics() const;

  [[nodiscard]] Result<PtpReading> read_ptp();
  [[nodiscard]] const CameraAbilities& abilities() const { return abilities_; }
  [[nodiscard]] bool control_lost() const { return control_lost_; }
  [[nodiscard]] int packet_bytes() const { return packet_bytes_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& address() const { return address_; }

 private:
  [[nodiscard]] Status choose_packet_size(int wanted_bytes);
  [[nodiscard]] Status make_stream(const GigeCameraConfig& config);
  void learn_name();
  [[nodiscard]] RawFrame to_frame(ArvBuffer* buffer);
  void read_chunks(ArvBuffer* buffer, RawFrame& frame);
  void return_buffer();
  void wake();
  static void on_stream_event(void* self, ArvStreamCallbackType type, ArvBuffer* buffer);
  static void on_control_lost(ArvDevice* device, void* self);

  GObjectPtr<ArvCamera> camera_;
  AravisFeatures features_;
  std::mutex features_mutex_;  ///< Aravis' nodes are for one thread at a time
  const Clock& clock_;
  CameraAbilities abilities_;
  GObjectPtr<ArvChunkParser> chunk_parser_;
  GObjectPtr<ArvStream> stream_;
  ArvBuffer* borrowed_ = nullptr;  ///< whose bytes the caller holds
  std::uint64_t ticks_per_second_ = 0;
  int packet_bytes_ = 0;
  std::string name_;
  std::string address_;
  gulong control_lost_handler_ = 0;
  std::atomic<bool> control_lost_{false};
  std::mutex mutex_;
  std::condition_variable_any woken_;
  std::uint64_t waiting_ = 0;  ///< frames that are done; under mutex_
};

AravisCamera::Device::~Device() {
  if (control_lost_handler_ != 0)
    g_signal_handler_disconnect(arv_camera_get_device(camera_.get()), control_lost_handler_);
  if (!stream_) return;
  if (!control_lost_) {
    ErrorSlot ignored;
    arv_camera_stop_acquisition(camera_.get(), ignored.out());
  }
  return_buffer();
  stream_.reset();  // ends its thread; then nobody calls back any more
}

Status AravisCamera::Device::set_up(const GigeCameraConfig& config) {
  learn_name();
  ErrorSlot error;
  ArvGvDevice* device = ARV_GV_DEVICE(arv_camera_get_device(camera_.get()));
  ticks_per_second_ = arv_gv_device_get_timestamp_tick_frequency(device, error.out());
  EDGESPLAT_TRY_STATUS(error.status("cannot read the camera's tick frequency"));
  EDGESPLAT_TRY(abilities_, set_up_camera(features_, config));
  for (const char* name : {"GevHeartbeatTimeout", "DeviceLinkHeartbeatTimeout"}) {
    const double unit = std::string_view(name).starts_with("Gev") ? 1e3 : 1e6;
    if (features_.has(name))
      (void)features_.set(name, std::int64_t{std::llround(config.heartbeat_timeout_s * unit)});
  }
  EDGESPLAT_TRY_STATUS(choose_packet_size(config.packet_bytes));
  if (!abilities_.chunks.empty()) chunk_parser_.reset(arv_camera_create_chunk_parser(camera_.get()));
  return make_stream(config);
}

void AravisCamera::Device::learn_name() {
  ErrorSlot ignored;
  const auto add = [this](const char* part) {
    if (part != nullptr && *part != '\0') name_ += name_.empty() ? part : std::string(" ") + part;
  };
  add(arv_camera_get_vendor_name(camera_.get(), ignored.out()));
  add(arv_camera_get_model_name(camera_.get(), ignored.out()));
  add(arv_camera_get_device_serial_number(camera_.get(), ignored.out()));
  ArvGvDevice* device = ARV_GV_DEVICE(arv_camera_get_device(camera_.get()));
  GSocketAddress* socket_address = arv_gv_device_get_device_address(device);
  GInetAddress* address = g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(socket_address));
  const std::unique_ptr<char, decltype(&g_free)> text(g_inet_address_to_string(address), &g_free);
  address_ = text.get();
  name_ += " at " + address_;
}

/// What the camera sends must fit through the network unfragmented: tried with test packets.
Status AravisCamera::Device::choose_packet_size(int wanted_bytes) {
  ErrorSlot error;
  if (wanted_bytes > 0) {
    arv_camera_gv_set_packet_size(camera_.get(), wanted_bytes, error.out());
  } else {
    arv_camera_gv_auto_packet_size(camera_.get(), error.out());
  }
  EDGESPLAT_TRY_STATUS(error.status("cannot set the packet size"));
  packet_bytes_ = static_cast<int>(arv_camera_gv_get_packet_size(camera_.get(), error.out()));
  EDGESPLAT_TRY_STATUS(error.status("cannot read the packet size"));
  if (packet_bytes_ > 0) return {};
  packet_bytes_ = kDefaultPacketBytes;
  arv_camera_gv_set_packet_size(camera_.get(), packet_bytes_, error.out());
  return error.status("cannot set the packet size");
}

Status AravisCamera::Device::make_stream(const GigeCameraConfig& config) {
  arv_camera_gv_set_packet_size_adjustment(camera_.get(), ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
  ErrorSlot error;
  stream_.reset(arv_camera_create_stream(camera_.get(), &Device::on_stream_event, this, error.out()));
  EDGESPLAT_TRY_STATUS(error.status("cannot make the camera's stream"));
  const guint payload = arv_camera_get_payload(camera_.get(), error.out());
  EDGESPLAT_TRY_STATUS(error.status("cannot read the size of a frame"));
  g_object_set(stream_.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size",
               static_cast<int>(std::max(payload * kFramesInSocket, kLeastSocketBytes)), "packet-timeout",
               kPacketTimeout_us, "frame-retention", kFrameRetention_us, "packet-request-ratio", kResendRatio,
               nullptr);
  for (int i = 0; i < config.buffers; ++i)
    arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(payload));
  control_lost_handler_ = g_signal_connect(arv_camera_get_device(camera_.get()), "control-lost",
                                           G_CALLBACK(&Device::on_control_lost), this);
  return {};
}

Status AravisCamera::Device::start() {
  const std::lock_guard lock(features_mutex_);
  ErrorSlot error;
  arv_camera_start_acquisition(camera_.get(), error.out());
  return error.status("cannot start the camera");
}

void AravisCamera::Device::on_stream_event(void* self, ArvStreamCallbackType type, ArvBuffer*) {
  if (type == ARV_STREAM_CALLBACK_TYPE_INIT && !arv_make_thread_high_priority(kStreamNiceness)) return;
  if (type == ARV_STREAM_CALLBACK_TYPE_BUFFER_DONE) static_cast<Device*>(self)->wake();
}

void AravisCamera::Device::on_control_lost(ArvDevice*, void* self) {
  auto* device = static_cast<Device*>(self);
  device->control_lost_ = true;
  device->wake();
}

void AravisCamera::Device::wake() {
  {
    const std::lock_guard lock(mutex_);
    ++waiting_;
  }
  woken_.notify_one();
}

void AravisCamera::Device::return_buffer() {
  if (borrowed_ != nullptr) arv_stream_push_buffer(stream_.get(), std::exchange(borrowed_, nullptr));
}

std::optional<RawFrame> AravisCamera::Device::receive(const std::stop_token& stop, nanoseconds timeout) {
  return_buffer();
  {
    std::unique_lock lock(mutex_);
    if (!woken_.wait_for(lock, stop, timeout, [this] { return waiting_ > 0; })) return std::nullopt;
    --waiting_;
  }
  borrowed_ = arv_stream_try_pop_buffer(stream_.get());
  if (borrowed_ == nullptr) return std::nullopt;  // woken by the loss of control
  return to_frame(borrowed_);
}

RawFrame AravisCamera::Device::to_frame(ArvBuffer* buffer) {
  RawFrame frame;
  frame.number = static_cast<std::uint16_t>(arv_buffer_get_frame_id(buffer));
  // Aravis notes the wall clock when the first packet comes; its age carries it to the program's clock.
  const ClockPair now = read_clocks(clock_);
  const std::int64_t age_ns =
      now.wall_ns - static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer));
  frame.arrival = now.host - nanoseconds(std::clamp<std::int64_t>(age_ns, 0, 1'000'000'000));
  frame.complete = arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS;
  if (!frame.complete) return frame;
  const auto payload = arv_buffer_get_payload_type(buffer);
  if (payload != ARV_BUFFER_PAYLOAD_TYPE_IMAGE && payload != ARV_BUFFER_PAYLOAD_TYPE_EXTENDED_CHUNK_DATA)
    return frame;  // no picture: refused by its size
  frame.stamp = sensor_time_from_ns(static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer)));
  frame.pixel_format = arv_buffer_get_image_pixel_format(buffer);
  frame.width_px = arv_buffer_get_image_width(buffer);
  frame.height_px = arv_buffer_get_image_height(buffer);
  std::size_t bytes = 0;
  const auto* data = static_cast<const std::byte*>(arv_buffer_get_image_data(buffer, &bytes));
  frame.pixels = {data, bytes};
  if (chunk_parser_ && arv_buffer_has_chunks(buffer)) read_chunks(buffer, frame);
  return frame;
}

void AravisCamera::Device::read_chunks(ArvBuffer* buffer, RawFrame& frame) {
  ArvChunkParser* parser = chunk_parser_.get();
  if (abilities_.has(Chunk::kTimestamp)) {
    if (const auto ticks = chunk_integer(parser, buffer, "ChunkTimestamp"))
      frame.chunk_stamp = sensor_time_from_ns(ticks_to_ns(*ticks, ticks_per_second_));
  }
  if (abilities_.has(Chunk::kExposureTime))
    frame.exposure_us = chunk_number(parser, buffer, "ChunkExposureTime");
  if (abilities_.has(Chunk::kGain)) frame.gain_db = chunk_number(parser, buffer, "ChunkGain");
  if (abilities_.has(Chunk::kCounter)) frame.counter = chunk_integer(parser, buffer, "ChunkCounterValue");
}

Result<PtpReading> AravisCamera::Device::read_ptp() {
  const std::lock_guard lock(features_mutex_);
  return aravis::read_ptp(features_, abilities_);
}

Result<AravisCamera::ClockReading> AravisCamera::Device::read_clock() {
  const std::lock_guard lock(features_mutex_);
  const HostTime before = clock_.now();
  EDGESPLAT_TRY_STATUS(features_.execute(abilities_.clock_latch));
  const HostTime after = clock_.now();
  EDGESPLAT_TRY(const std::int64_t ticks, features_.integer(abilities_.clock_value));
  return ClockReading{sensor_time_from_ns(ticks_to_ns(ticks, ticks_per_second_)),
                      before + (after - before) / 2, after - before};
}

StreamStatistics AravisCamera::Device::statistics() const {
  guint64 completed = 0, failed = 0, underruns = 0, resent = 0, missing = 0;
  arv_stream_get_statistics(stream_.get(), &completed, &failed, &underruns);
  arv_gv_stream_get_statistics(ARV_GV_STREAM(stream_.get()), &resent, &missing);
  return {completed, failed, underruns, resent, missing};
}

Result<std::unique_ptr<AravisCamera>> AravisCamera::open(const GigeCameraConfig& config, const Clock& clock) {
  arv_debug_enable("all:0");  // what matters is in the results; its own lines would mix with the program's
  ErrorSlot error;
  GObjectPtr<ArvCamera> camera(arv_camera_new(config.address.c_str(), error.out()));
  EDGESPLAT_TRY_STATUS(error.status("cannot open the camera " + config.address));
  if (!camera)
    return fail(Errc::kUnavailable, "no camera " + config.address + " answers; is it powered and cabled?");
  if (!arv_camera_is_gv_device(camera.get()))
    return fail(Errc::kInvalidConfig, "the camera " + config.address + " is no GigE Vision camera");
  if (!arv_gv_device_is_controller(ARV_GV_DEVICE(arv_camera_get_device(camera.get()))))
    return fail(Errc::kUnavailable, "the camera " + config.address + " is in use by another program");
  auto device = std::make_unique<Device>(std::move(camera), clock);
  EDGESPLAT_TRY_STATUS(device->set_up(config));
  return std::unique_ptr<AravisCamera>(new AravisCamera(std::move(device)));
}

AravisCamera::AravisCamera(std::unique_ptr<Device> device) : device_(std::move(device)) {}
AravisCamera::~AravisCamera() = default;

Status AravisCamera::start() {
  return device_->start();
}
std::optional<RawFrame> AravisCamera::receive(const std::stop_token& stop, nanoseconds timeout) {
  return device_->receive(stop, timeout);
}
bool AravisCamera::control_lost() const {
  return device_->control_lost();
}
const CameraAbilities& AravisCamera::abilities() const {
  return device_->abilities();
}
Result<PtpReading> AravisCamera::read_ptp() {
  return device_->read_ptp();
}
Result<AravisCamera::ClockReading> AravisCamera::read_clock() {
  return device_->read_clock();
}
StreamStatistics AravisCamera::statistics() const {
  return device_->statistics();
}
int AravisCamera::packet_bytes() const {
  return device_->packet_bytes();
}
const std::string& AravisCamera::name() const {
  return device_->name();
}
const std::string& AravisCamera::address() const {
  return device_->address();
}
bool has_aravis() {
  return true;
}

}  // namespace edgesplat::aravis
