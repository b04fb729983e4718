// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/dds_entities.hpp"

#include "edgesplat_link.h"

namespace edgesplat::link {
namespace {

constexpr dds_duration_t kMaxBlocking = DDS_MSECS(20);
constexpr std::int32_t kMaxSamples = 256;
constexpr std::int32_t kProbeSamples = 32;

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;
using Listener = std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)>;

Qos qos_of(Lane lane) {
  Qos qos(dds_create_qos(), &dds_delete_qos);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  switch (lane) {
    case Lane::kHeartbeat:
      dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
      dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
      dds_qset_deadline(qos.get(), DDS_MSECS(500));
      break;
    case Lane::kAck:
      dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, kMaxBlocking);
      dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
      break;
    case Lane::kProbe:
      dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
      dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kProbeSamples);
      break;
    case Lane::kRequest:
    case Lane::kDelta:
    case Lane::kKeyframe:
    case Lane::kSpool:
      dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, kMaxBlocking);
      dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
      dds_qset_resource_limits(qos.get(), kMaxSamples, DDS_LENGTH_UNLIMITED, kMaxSamples);
      break;
  }
  return qos;
}

void wake_from(void* wake) {
  (*static_cast<const WakeFunction*>(wake))();
}
void on_data(dds_entity_t, void* wake) {
  wake_from(wake);
}
void on_matched(dds_entity_t, const dds_publication_matched_status_t, void* wake) {
  wake_from(wake);
}

void* as_argument(const WakeFunction* wake) {
  return const_cast<WakeFunction*>(wake);  // the C callback takes void*; wake_from() only calls it
}

Result<DdsEntity> checked(dds_entity_t handle, const std::string& what) {
  if (handle > 0) return DdsEntity(handle);
  return fail(Errc::kUnavailable, "DDS cannot create " + what + ": " + dds_strretcode(handle));
}

Result<dds_entity_t> create_topic(const DdsEntity& participant, Role sender, Lane lane) {
  const std::string name = topic_name(sender, lane);
  // Owned by the participant: Cyclone deletes it with it.
  const dds_entity_t topic =
      dds_create_topic(participant.get(), &edgesplat_link_idl_Sample_desc, name.c_str(), nullptr, nullptr);
  if (topic < 0)
    return fail(Errc::kUnavailable, "DDS cannot create topic " + name + ": " + dds_strretcode(topic));
  return topic;
}

std::byte* bytes_of(std::uint8_t* first) {
  return reinterpret_cast<std::byte*>(first);
}

}  // namespace

std::string topic_name(Role sender, Lane lane) {
  std::string name = sender == Role::kRobot ? "edgesplat/up/" : "edgesplat/down/";
  return name += to_string(lane);
}

Result<DdsEntity> create_participant(int domain) {
  return checked(dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr),
                 "a participant in domain " + std::to_string(domain));
}

Result<DdsEntity> create_writer(const DdsEntity& participant, Role sender, Lane lane,
                                const WakeFunction* wake) {
  EDGESPLAT_TRY(const dds_entity_t topic, create_topic(participant, sender, lane));
  const Listener listener(dds_create_listener(nullptr), &dds_delete_listener);
  (void)dds_lset_publication_matched_arg(listener.get(), &on_matched, as_argument(wake), true);
  const Qos qos = qos_of(lane);
  return checked(dds_create_writer(participant.get(), topic, qos.get(), listener.get()),
                 "the writer of " + topic_name(sender, lane));
}

Result<DdsEntity> create_reader(const DdsEntity& participant, Role sender, Lane lane,
                                const WakeFunction* wake) {
  EDGESPLAT_TRY(const dds_entity_t topic, create_topic(participant, sender, lane));
  const Listener listener(dds_create_listener(nullptr), &dds_delete_listener);
  (void)dds_lset_data_available_arg(listener.get(), &on_data, as_argument(wake), true);
  const Qos qos = qos_of(lane);
  return checked(dds_create_reader(participant.get(), topic, qos.get(), listener.get()),
                 "the reader of " + topic_name(sender, lane));
}

WriteOutcome write_chunk(const DdsEntity& writer, const ChunkHeader& header,
                         std::span<const std::byte> payload) {
  edgesplat_link_idl_Sample sample{};
  sample.robot_id = header.robot.value;
  sample.session = header.session;
  sample.train = header.train;
  sample.chunk_index = header.index;
  sample.attempt = header.attempt;
  sample.chunk_count = header.count;
  sample.total_bytes = header.total_bytes;
  sample.message_crc32c = header.message_crc32c;
  sample.chunk_crc32c = header.chunk_crc32c;
  sample.payload._length = static_cast<std::uint32_t>(payload.size());
  sample.payload._maximum = sample.payload._length;
  // dds_write only reads the sample; the C struct has no const.
  sample.payload._buffer = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(payload.data()));
  const dds_return_t rc = dds_write(writer.get(), &sample);
  if (rc == DDS_RETCODE_OK) return WriteOutcome::kWritten;
  return rc == DDS_RETCODE_TIMEOUT ? WriteOutcome::kBusy : WriteOutcome::kRefused;
}

bool take_chunk(const DdsEntity& reader, const ChunkHandler& handle) {
  void* samples[1] = {nullptr};
  dds_sample_info_t info[1];
  const dds_return_t taken = dds_take(reader.get(), samples, info, 1, 1);
  if (taken <= 0) return false;
  if (info[0].valid_data) {
    const auto& sample = *static_cast<const edgesplat_link_idl_Sample*>(samples[0]);
    ChunkHeader header;
    header.robot.value = sample.robot_id;
    header.session = sample.session;
    header.train = sample.train;
    header.index = sample.chunk_index;
    header.attempt = sample.attempt;
    header.count = sample.chunk_count;
    header.total_bytes = sample.total_bytes;
    header.message_crc32c = sample.message_crc32c;
    header.chunk_crc32c = sample.chunk_crc32c;
    handle(header, {bytes_of(sample.payload._buffer), sample.payload._length});
  }
  (void)dds_return_loan(reader.get(), samples, taken);
  return true;
}

bool has_reader(const DdsEntity& writer) {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer.get(), &status) == DDS_RETCODE_OK &&
         status.current_count > 0;
}

}  // namespace edgesplat::link
