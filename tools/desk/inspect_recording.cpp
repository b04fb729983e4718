// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/atomic_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "tools/desk/gap_statistics.hpp"
#include "tools/desk/inspection.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>

namespace edgesplat::desk {
namespace {

struct ChannelContent {
  std::string schema;
  GapStatistics arrivals;
  std::uint64_t bytes = 0;
};

using ContentByTopic = std::map<std::string, ChannelContent>;

ContentByTopic read_channels(io::McapReader& reader) {
  ContentByTopic content;
  for (const auto& [id, channel] : reader.channels()) {
    const auto schema = reader.schemas().find(channel.schema_id);
    content[channel.topic].schema = schema == reader.schemas().end() ? "-" : schema->second.name;
  }
  while (const auto message = reader.next()) {
    ChannelContent& channel = content[message->channel->topic];
    channel.arrivals.add(message->log_time);
    channel.bytes += message->payload.size();
  }
  return content;
}

nlohmann::json channel_json(const std::string& topic, const ChannelContent& channel) {
  return {{"topic", topic},
          {"schema", channel.schema},
          {"messages", channel.arrivals.count()},
          {"bytes", channel.bytes},
          {"rate_hz", channel.arrivals.rate_hz()},
          {"duration_s", channel.arrivals.duration_s()},
          {"largest_gap_s", channel.arrivals.largest_gap_s()}};
}

std::string channel_row(const std::string& topic, const ChannelContent& channel) {
  return fmt::format("{:<24}{:<34}{:>9}{:>10.2f}{:>10.2f}{:>9.3f}{:>11.2f}\n", topic, channel.schema,
                     channel.arrivals.count(), channel.arrivals.rate_hz(), channel.arrivals.duration_s(),
                     channel.arrivals.largest_gap_s(), static_cast<double>(channel.bytes) / 1e6);
}

}  // namespace

Result<Inspection> inspect_recording(const std::filesystem::path& path) {
  EDGESPLAT_TRY(io::McapReader reader, io::McapReader::open(path));
  const ContentByTopic content = read_channels(reader);
  const io::McapReadReport& report = reader.report();
  const io::McapStatistics& statistics = reader.statistics();
  const double duration_s = to_seconds(statistics.last_log_time - statistics.first_log_time);

  nlohmann::json json = {{"kind", "recording"},
                         {"duration_s", duration_s},
                         {"messages", report.messages_read},
                         {"complete", report.complete},
                         {"why", report.why},
                         {"bytes_skipped", report.bytes_skipped},
                         {"channels", nlohmann::json::array()},
                         {"attachments", reader.attachment_names()}};
  std::string text = fmt::format("recording of {:.2f} s, {} messages, {}\n\n", duration_s,
                                 report.messages_read, report.complete ? "complete" : report.why);
  text += fmt::format("{:<24}{:<34}{:>9}{:>10}{:>10}{:>9}{:>11}\n", "topic", "schema", "messages", "rate Hz",
                      "length s", "gap s", "MB");
  for (const auto& [topic, channel] : content) {
    json["channels"].push_back(channel_json(topic, channel));
    text += channel_row(topic, channel);
  }
  text += "\nattachments:";
  for (const std::string& name : reader.attachment_names()) text += " " + name;
  text += reader.attachment_names().empty() ? " none\n" : "\n";
  return Inspection{text, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

Status extract_attachment(const std::filesystem::path& recording, const std::string& name,
                          const std::filesystem::path& target) {
  EDGESPLAT_TRY(const io::McapReader reader, io::McapReader::open(recording));
  const auto attachment = reader.attachment(name);
  if (!attachment && attachment.error().code == Errc::kNotFound) {
    std::string known;
    for (const std::string& other : reader.attachment_names()) known += " " + other;
    return fail(Errc::kNotFound, recording.string() + " has no attachment " + name +
                                     "; it has:" + (known.empty() ? " none" : known));
  }
  if (!attachment) return tl::unexpected<Error>(attachment.error());
  return io::write_file_atomically(target, attachment->content);
}

}  // namespace edgesplat::desk
