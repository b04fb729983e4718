// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/bag_source.hpp"
#include "tools/desk/gap_statistics.hpp"
#include "tools/desk/inspection.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <vector>

namespace edgesplat::desk {

Result<Inspection> inspect_bag(const std::filesystem::path& path) {
  struct TopicContent {
    GapStatistics arrivals;
    std::uint64_t bytes = 0;
  };
  EDGESPLAT_TRY(const auto bag, io::open_bag(path));
  std::vector<TopicContent> content(bag->topics().size());
  while (const auto message = bag->next()) {
    content[message->topic].arrivals.add(message->time);
    content[message->topic].bytes += message->payload.size();
  }
  const io::BagReport report = bag->report();
  const double duration_s = to_seconds(bag->end() - bag->begin());
  nlohmann::json json = {{"kind", "bag"},
                         {"duration_s", duration_s},
                         {"messages", report.messages_read},
                         {"complete", report.complete},
                         {"why", report.why},
                         {"bytes_skipped", report.bytes_skipped},
                         {"channels", nlohmann::json::array()}};
  std::string text = fmt::format("ROS recording of {:.2f} s, {} messages, {}\n\n", duration_s,
                                 report.messages_read, report.complete ? "complete" : report.why);
  text += fmt::format("{:<32} {:<30} {:>9}{:>10}{:>10}{:>9}{:>11}\n", "topic", "type", "messages", "rate Hz",
                      "length s", "gap s", "MB");
  for (std::size_t i = 0; i < content.size(); ++i) {
    const io::BagTopic& topic = bag->topics()[i];
    const GapStatistics& arrivals = content[i].arrivals;
    json["channels"].push_back({{"topic", topic.name},
                                {"schema", topic.type},
                                {"messages", arrivals.count()},
                                {"bytes", content[i].bytes},
                                {"rate_hz", arrivals.rate_hz()},
                                {"duration_s", arrivals.duration_s()},
                                {"largest_gap_s", arrivals.largest_gap_s()}});
    text += fmt::format("{:<32} {:<30} {:>9}{:>10.2f}{:>10.2f}{:>9.3f}{:>11.2f}\n", topic.name, topic.type,
                        arrivals.count(), arrivals.rate_hz(), arrivals.duration_s(), arrivals.largest_gap_s(),
                        static_cast<double>(content[i].bytes) / 1e6);
  }
  return Inspection{text, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

}  // namespace edgesplat::desk
