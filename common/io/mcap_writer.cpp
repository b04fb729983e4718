// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/mcap_writer.hpp"

#include "common/base/unique_fd.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/mcap_chunk_builder.hpp"
#include "common/io/mcap_summary_writer.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace edgesplat::io {

using mcap::ChunkBuilder;
using mcap::Opcode;

namespace {
constexpr std::size_t kMaxIds = 65535;  // a u16, and schema 0 means none
}  // namespace

/// The open file: what has reached it, the chunk in the making, and what the summary will say.
class McapWriter::File {
 public:
  File(std::filesystem::path path, UniqueFd fd, McapWriterOptions options)
      : path_(std::move(path)),
        fd_(std::move(fd)),
        options_(std::move(options)),
        compressor_(options_.compression, options_.zstd_level),
        chunk_(static_cast<std::size_t>(options_.chunk_bytes)) {}

  Status append(std::span<const std::byte> bytes);
  Status write_start();
  Status flush();
  Status sync();
  Status close();
  Result<McapSchemaId> add_schema(std::string_view name, std::string_view encoding, std::string_view text);
  Result<McapChannelId> add_channel(McapChannel channel);
  Status write(const mcap::MessageHeader& header, std::span<const std::byte> payload);
  Status add_attachment(mcap::AttachmentIndex about, std::span<const std::byte> content);
  Status add_metadata(const McapMetadata& metadata);

  [[nodiscard]] const McapStatistics& statistics() const { return summary_.statistics; }
  [[nodiscard]] std::uint64_t messages_dropped() const { return messages_dropped_; }
  [[nodiscard]] std::uint64_t bytes_written() const { return bytes_written_; }

 private:
  [[nodiscard]] bool chunk_is_due(std::uint64_t log_time_ns) const;

  std::filesystem::path path_;
  UniqueFd fd_;
  McapWriterOptions options_;
  mcap::Compressor compressor_;
  ChunkBuilder chunk_;
  mcap::Summary summary_;
  std::vector<std::byte> outgoing_;  ///< reused between chunks
  std::uint64_t bytes_written_ = 0;
  std::uint64_t messages_dropped_ = 0;
  bool failed_ = false;
  bool closed_ = false;
};

/// All of `bytes` or nothing: a record that did not fit is cut off again, so that the file stays readable.
Status McapWriter::File::append(std::span<const std::byte> bytes) {
  if (auto written = write_all(fd_.get(), bytes, path_); !written) {
    failed_ = true;
    (void)::ftruncate(fd_.get(), static_cast<off_t>(bytes_written_));
    return fail(Errc::kIo, written.error().context + "; the recording holds " +
                               std::to_string(statistics().message_count) +
                               " messages so far and takes no more");
  }
  bytes_written_ += bytes.size();
  return {};
}

Status McapWriter::File::write_start() {
  ByteWriter start;
  start.write_bytes(mcap::kMagic);
  {
    const mcap::RecordScope header(start, Opcode::kHeader);
    mcap::write_string(start, options_.profile);
    mcap::write_string(start, options_.library);
  }
  return append(start.bytes());
}

Status McapWriter::File::flush() {
  if (failed_ || chunk_.message_count() == 0) return {};
  const std::uint64_t messages = chunk_.message_count();
  outgoing_.clear();
  auto finished = chunk_.finish(compressor_, bytes_written_, outgoing_);
  chunk_.clear();
  Status written = finished ? append(outgoing_) : Status(tl::unexpected<Error>(finished.error()));
  if (!written) {
    messages_dropped_ += messages;
    return written;
  }
  summary_.add(std::move(*finished));
  return {};
}

Status McapWriter::File::sync() {
  EDGESPLAT_TRY_STATUS(flush());
  if (failed_ || closed_ || ::fdatasync(fd_.get()) == 0) return {};
  return fail(Errc::kIo, "cannot sync " + path_.string() + ": " + std::generic_category().message(errno));
}

bool McapWriter::File::chunk_is_due(std::uint64_t log_time_ns) const {
  if (chunk_.message_count() == 0) return false;
  return log_time_ns >= chunk_.first_log_time_ns() + static_cast<std::uint64_t>(options_.chunk_span.count());
}

Status McapWriter::File::write(const mcap::MessageHeader& header, std::span<const std::byte> payload) {
  if (closed_) return fail(Errc::kInvalidArgument, path_.string() + " is closed");
  if (header.channel.value >= summary_.channels.size()) {
    return fail(Errc::kInvalidArgument, "message for a channel that was not added");
  }
  if (payload.size() > kMaxMcapRecordBytes / 4) return fail(Errc::kInvalidArgument, "message above 64 MiB");
  if (!failed_ && chunk_is_due(header.log_time_ns)) {
    if (auto flushed = flush(); !flushed) {
      ++messages_dropped_;
      return flushed;
    }
  }
  if (failed_) {
    ++messages_dropped_;
    return {};
  }
  if (!chunk_.uses(header.channel)) {
    // Every chunk defines what it uses: a chunk lost from a file without summary takes no other with it.
    const McapChannel& channel = summary_.channels[header.channel.value];
    if (channel.schema_id.value != 0) chunk_.add(summary_.schemas[channel.schema_id.value - 1U]);
    chunk_.add(channel);
  }
  chunk_.add(header, payload);
  return chunk_.size_bytes() >= options_.chunk_bytes ? flush() : Status{};
}

Result<McapSchemaId> McapWriter::File::add_schema(std::string_view name, std::string_view encoding,
                                                  std::string_view text) {
  for (const auto& known : summary_.schemas) {
    if (known.name == name && known.encoding == encoding && known.text == text) return known.id;
  }
  if (summary_.schemas.size() == kMaxIds) return fail(Errc::kInvalidArgument, "too many schemas");
  const McapSchemaId id{static_cast<std::uint16_t>(summary_.schemas.size() + 1)};
  summary_.schemas.push_back({id, std::string(name), std::string(encoding), std::string(text)});
  return id;
}

Result<McapChannelId> McapWriter::File::add_channel(McapChannel channel) {
  if (channel.schema_id.value > summary_.schemas.size()) {
    return fail(Errc::kInvalidArgument, "channel " + channel.topic + " has a schema that was not added");
  }
  if (summary_.channels.size() == kMaxIds) return fail(Errc::kInvalidArgument, "too many channels");
  channel.id.value = static_cast<std::uint16_t>(summary_.channels.size());
  summary_.channels.push_back(std::move(channel));
  return summary_.channels.back().id;
}

Status McapWriter::File::add_attachment(mcap::AttachmentIndex about, std::span<const std::byte> content) {
  if (closed_ || content.size() > kMaxMcapRecordBytes / 2) {
    return fail(Errc::kInvalidArgument,
                "attachment " + about.name + " comes after close() or is above 128 MiB");
  }
  EDGESPLAT_TRY_STATUS(flush());
  ByteWriter out;
  {
    const mcap::RecordScope record(out, Opcode::kAttachment);
    out.write(about.log_time_ns);
    out.write(std::uint64_t{0});  // create time: not known
    mcap::write_string(out, about.name);
    mcap::write_string(out, about.media_type);
    out.write(static_cast<std::uint64_t>(content.size()));
    out.write_bytes(content);
    out.write(mcap::crc32(out.bytes().subspan(mcap::kPrefixBytes)));
  }
  about.offset = bytes_written_;
  about.length = out.size();
  about.content_bytes = content.size();
  EDGESPLAT_TRY_STATUS(append(out.bytes()));
  summary_.attachments.push_back(std::move(about));
  ++summary_.statistics.attachment_count;
  return {};
}

Status McapWriter::File::add_metadata(const McapMetadata& metadata) {
  if (closed_) return fail(Errc::kInvalidArgument, path_.string() + " is closed");
  EDGESPLAT_TRY_STATUS(flush());
  ByteWriter out;
  mcap::write_record(out, metadata);
  const mcap::MetadataIndex index{bytes_written_, out.size(), metadata.name};
  EDGESPLAT_TRY_STATUS(append(out.bytes()));
  summary_.metadata.push_back(index);
  ++summary_.statistics.metadata_count;
  return {};
}

Status McapWriter::File::close() {
  if (std::exchange(closed_, true)) return {};
  Status result = flush();
  const bool failed_before = failed_;
  // Also after a failure: the short summary may fit where a chunk did not.
  const Status end = append(mcap::encode_file_end(summary_, bytes_written_));
  if (result) result = end;
  if (result && ::fsync(fd_.get()) != 0) {
    result = fail(Errc::kIo, "cannot sync " + path_.string() + ": " + std::generic_category().message(errno));
  }
  fd_.reset();
  if (result && failed_before) {
    result = fail(Errc::kIo, path_.string() + " lacks " + std::to_string(messages_dropped_) +
                                 " messages that came after a failed write");
  }
  return result;
}

Result<McapWriter> McapWriter::create(const std::filesystem::path& path, McapWriterOptions options) {
  if (options.chunk_bytes < 1 || options.chunk_bytes > kMaxMcapRecordBytes / 2) {
    return fail(Errc::kInvalidArgument, "chunk_bytes must be between 1 and 128 Mi");
  }
  if (options.zstd_level < 1 || options.zstd_level > 19 || options.chunk_span.count() < 0) {
    return fail(Errc::kInvalidArgument, "zstd_level must be between 1 and 19, chunk_span not negative");
  }
  UniqueFd fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (!fd.valid()) {
    return fail(Errc::kIo, "cannot create " + path.string() + ": " + std::generic_category().message(errno));
  }
  (void)::flock(fd.get(), LOCK_EX | LOCK_NB);  // so that nobody repairs what is being written
  auto file = std::make_unique<File>(path, std::move(fd), std::move(options));
  EDGESPLAT_TRY_STATUS(file->write_start());
  return McapWriter(std::move(file));
}

McapWriter::McapWriter(std::unique_ptr<File> file) : file_(std::move(file)) {}
McapWriter::McapWriter(McapWriter&&) noexcept = default;
McapWriter::~McapWriter() {
  if (file_) (void)file_->close();
}

Result<McapSchemaId> McapWriter::add_schema(std::string_view name, std::string_view encoding,
                                            std::string_view text) {
  return file_->add_schema(name, encoding, text);
}

Result<McapChannelId> McapWriter::add_channel(std::string_view topic, McapSchemaId schema,
                                              std::string_view message_encoding,
                                              std::map<std::string, std::string> metadata) {
  return file_->add_channel(
      {McapChannelId{}, schema, std::string(topic), std::string(message_encoding), std::move(metadata)});
}

Status McapWriter::write(McapChannelId channel, std::uint32_t sequence, HostTime log_time,
                         SensorTime publish_time, std::span<const std::byte> payload) {
  if (to_ns(log_time) < 0) return fail(Errc::kInvalidArgument, "MCAP cannot hold a negative log time");
  return file_->write({channel, sequence, static_cast<std::uint64_t>(to_ns(log_time)),
                       static_cast<std::uint64_t>(to_ns(publish_time))},
                      payload);
}

Status McapWriter::add_attachment(std::string_view name, std::string_view media_type,
                                  std::span<const std::byte> content, HostTime log_time) {
  mcap::AttachmentIndex about;
  about.name = name;
  about.media_type = media_type;
  about.log_time_ns = static_cast<std::uint64_t>(to_ns(log_time));
  return file_->add_attachment(std::move(about), content);
}

Status McapWriter::add_metadata(std::string_view name, const std::map<std::string, std::string>& entries) {
  return file_->add_metadata({std::string(name), entries});
}

Status McapWriter::flush() {
  return file_->flush();
}
Status McapWriter::sync() {
  return file_->sync();
}
Status McapWriter::close() {
  return file_->close();
}
const McapStatistics& McapWriter::statistics() const {
  return file_->statistics();
}
std::uint64_t McapWriter::messages_dropped() const {
  return file_->messages_dropped();
}
std::uint64_t McapWriter::bytes_written() const {
  return file_->bytes_written();
}

}  // namespace edgesplat::io
