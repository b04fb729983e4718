// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_reader.hpp"

#include "common/io/byte_source.hpp"
#include "common/io/mcap_merge.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::io {

/// The opened file: where things are, and how far reading has come.
class McapReader::File {
 public:
  File(std::unique_ptr<ByteSource> source, mcap::Index index)
      : source_(std::move(source)),
        index_(std::move(index)),
        merge_(std::in_place, *source_, index_, McapSelection{}) {}

  static Result<std::unique_ptr<File>> open(std::unique_ptr<ByteSource> source);

  [[nodiscard]] const ByteSource& source() const { return *source_; }
  [[nodiscard]] const mcap::Index& index() const { return index_; }
  [[nodiscard]] mcap::MessageMerge& merge() { return *merge_; }
  void select(McapSelection selection) { merge_.emplace(*source_, index_, std::move(selection)); }

 private:
  std::unique_ptr<ByteSource> source_;
  mcap::Index index_;
  std::optional<mcap::MessageMerge> merge_;
};

Result<std::unique_ptr<McapReader::File>> McapReader::File::open(std::unique_ptr<ByteSource> source) {
  const auto start = source->read(0, std::min<std::uint64_t>(source->size_bytes(), mcap::kMagic.size()));
  if (!start) return tl::unexpected<Error>(start.error());
  if (!std::ranges::equal(*start, mcap::kMagic)) return fail(Errc::kCorrupt, "not an MCAP file");
  auto from_summary = mcap::index_from_summary(*source);
  if (from_summary) return std::make_unique<File>(std::move(source), std::move(*from_summary));
  auto index = mcap::index_by_scanning(*source);
  if (from_summary.error().code != Errc::kNotFound && index.report.complete) {
    mcap::add_problem(index.report, from_summary.error().context + ": kept " +
                                        std::to_string(index.statistics.message_count) + " messages");
  }
  return std::make_unique<File>(std::move(source), std::move(index));
}

McapReader::McapReader(std::unique_ptr<File> file) : file_(std::move(file)) {}
McapReader::McapReader(McapReader&&) noexcept = default;
McapReader::~McapReader() = default;

Result<McapReader> McapReader::open(const std::filesystem::path& path) {
  EDGESPLAT_TRY(auto source, open_byte_source(path));
  auto file = File::open(std::move(source));
  if (!file) return fail(file.error().code, path.string() + ": " + file.error().context);
  return McapReader(std::move(*file));
}

Result<McapReader> McapReader::from_bytes(std::span<const std::byte> bytes) {
  EDGESPLAT_TRY(auto file, File::open(make_byte_source(bytes)));
  return McapReader(std::move(file));
}

const std::map<McapChannelId, McapChannel>& McapReader::channels() const {
  return file_->index().channels;
}
const std::map<McapSchemaId, McapSchema>& McapReader::schemas() const {
  return file_->index().schemas;
}
const McapStatistics& McapReader::statistics() const {
  return file_->index().statistics;
}

const McapChannel* McapReader::find_channel(std::string_view topic) const {
  for (const auto& [id, channel] : channels()) {
    if (channel.topic == topic) return &channel;
  }
  return nullptr;
}

std::vector<std::string> McapReader::attachment_names() const {
  std::vector<std::string> names;
  for (const auto& attachment : file_->index().attachments) names.push_back(attachment.name);
  return names;
}

Result<McapAttachment> McapReader::attachment(std::string_view name) const {
  const auto& attachments = file_->index().attachments;
  const auto place = std::ranges::find(attachments, name, &mcap::AttachmentIndex::name);
  if (place == attachments.end()) {
    return fail(Errc::kNotFound, "the recording has no attachment " + std::string(name));
  }
  if (place->length > kMaxMcapRecordBytes) return fail(Errc::kCorrupt, "an attachment is too large");
  EDGESPLAT_TRY(const auto record, file_->source().read(place->offset, place->length));
  if (record[0] != static_cast<std::byte>(mcap::Opcode::kAttachment)) {
    return fail(Errc::kCorrupt, "there is no attachment where the summary says");
  }
  return mcap::read_attachment(std::span(record).subspan(mcap::kPrefixBytes));
}

Result<std::vector<McapMetadata>> McapReader::metadata() const {
  std::vector<McapMetadata> all;
  for (const auto& place : file_->index().metadata) {
    if (place.length > kMaxMcapRecordBytes) return fail(Errc::kCorrupt, "a metadata record is too large");
    EDGESPLAT_TRY(const auto record, file_->source().read(place.offset, place.length));
    if (record[0] != static_cast<std::byte>(mcap::Opcode::kMetadata)) {
      return fail(Errc::kCorrupt, "there is no metadata where the summary says");
    }
    EDGESPLAT_TRY(auto metadata, mcap::read_metadata(std::span(record).subspan(mcap::kPrefixBytes)));
    all.push_back(std::move(metadata));
  }
  return all;
}

void McapReader::select(McapSelection selection) {
  file_->select(std::move(selection));
}
std::optional<McapMessage> McapReader::next() {
  return file_->merge().next();
}
const McapReadReport& McapReader::report() const {
  return file_->merge().report();
}

}  // namespace edgesplat::io
