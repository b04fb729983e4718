// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/keyframe_log.hpp"

#include "common/base/bytes.hpp"
#include "common/io/atomic_file.hpp"
#include "server/store/record.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

namespace edgesplat::store {
namespace {

constexpr std::string_view kPrefix = "keyframes-";
constexpr std::string_view kSuffix = ".log";
constexpr std::uint8_t kKeyframeRecord = 16;
constexpr std::size_t kPayloadHeader_bytes = 2 + 8;
constexpr std::uint64_t kMaxSegment_bytes = std::uint64_t{1} << 30U;

tl::unexpected<Error> fail_io(const char* what, const std::filesystem::path& path, int error_number) {
  return fail(Errc::kIo,
              std::string(what) + " " + path.string() + ": " + std::generic_category().message(error_number));
}

/// Number in a segment's file name, or 0.
std::uint32_t number_of(const std::string& name) {
  if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) return 0;
  std::uint32_t number = 0;
  const char* end = name.data() + name.size() - kSuffix.size();
  const auto [stopped, error] = std::from_chars(name.data() + kPrefix.size(), end, number);
  return error == std::errc{} && stopped == end ? number : 0;
}

Status sync_folder(const std::filesystem::path& folder) {
  const UniqueFd fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!fd.valid()) return fail_io("cannot open the folder", folder, errno);
  if (::fsync(fd.get()) != 0 && errno != EINVAL) return fail_io("cannot sync the folder", folder, errno);
  return {};
}

Result<std::vector<std::uint32_t>> segments_in(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::uint32_t> numbers;
  for (std::filesystem::directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error)) {
    if (const std::uint32_t number = number_of(file->path().filename().string()); number > 0)
      numbers.push_back(number);
  }
  if (error) return fail(Errc::kIo, "cannot list " + folder.string() + ": " + error.message());
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::filesystem::path segment_path(const std::filesystem::path& folder, std::uint32_t segment) {
  std::string digits = std::to_string(segment);
  digits.insert(0, digits.size() < 6 ? 6 - digits.size() : 0, '0');
  return folder / (std::string(kPrefix) + digits + std::string(kSuffix));
}

LoggedKeyframe from_payload(std::span<const std::byte> payload) {
  ByteReader in(payload);
  LoggedKeyframe keyframe;
  keyframe.robot.value = in.read<std::uint16_t>();
  keyframe.session = in.read<std::uint64_t>();
  const auto rest = in.take(in.remaining());
  keyframe.bytes.assign(rest.begin(), rest.end());
  return keyframe;
}

bool is_keyframe(const Record& record) {
  return record.type == kKeyframeRecord && record.payload.size() >= kPayloadHeader_bytes;
}

}  // namespace

std::filesystem::path KeyframeLog::path_of(std::uint32_t segment) const {
  return segment_path(folder_, segment);
}

Result<KeyframeLog> KeyframeLog::open(const std::filesystem::path& folder, const KeyframeLogConfig& config) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(Errc::kIo, "cannot make " + folder.string() + ": " + error.message());
  KeyframeLog log(folder, config);
  EDGESPLAT_TRY(const auto numbers, segments_in(folder));
  for (const std::uint32_t number : numbers) EDGESPLAT_TRY_STATUS(log.scan(number, number == numbers.back()));
  if (numbers.empty()) EDGESPLAT_TRY_STATUS(log.begin_segment(1));
  log.drop_oldest_segments();
  return log;
}

Status KeyframeLog::scan(std::uint32_t segment, bool last) {
  const auto path = path_of(segment);
  EDGESPLAT_TRY(const auto bytes, io::read_file(path, kMaxSegment_bytes));
  RecordReader records(bytes, 0);
  std::uint64_t good_bytes = 0;
  while (const auto record = records.next()) {
    good_bytes = record->end;
    if (!is_keyframe(*record)) continue;
    const auto offset = static_cast<std::uint64_t>(record->payload.data() - bytes.data());
    entries_.push_back({segment, offset, static_cast<std::uint32_t>(record->payload.size())});
  }
  damaged_bytes_ += records.damaged_bytes();
  if (last) {
    fd_.reset(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (!fd_.valid()) return fail_io("cannot open", path, errno);
    if (::ftruncate(fd_.get(), static_cast<off_t>(good_bytes)) != 0 || ::lseek(fd_.get(), 0, SEEK_END) < 0)
      return fail_io("cannot cut the damaged end of", path, errno);
  }
  const std::uint64_t kept_bytes = last ? good_bytes : bytes.size();
  segments_.emplace_back(segment, kept_bytes);
  bytes_ += kept_bytes;
  return {};
}

Status KeyframeLog::begin_segment(std::uint32_t segment) {
  const auto path = path_of(segment);
  UniqueFd fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (!fd.valid()) return fail_io("cannot create", path, errno);
  EDGESPLAT_TRY_STATUS(sync_folder(folder_));
  fd_ = std::move(fd);
  segments_.emplace_back(segment, 0);
  return {};
}

void KeyframeLog::drop_oldest_segments() {
  while (segments_.size() > 1 && bytes_ > config_.max_bytes) {
    const auto [segment, segment_bytes] = segments_.front();
    std::error_code ignored;  // a file that cannot be removed is met again at the next start
    std::filesystem::remove(path_of(segment), ignored);
    bytes_ -= segment_bytes;
    segments_.pop_front();
    while (!entries_.empty() && entries_.front().segment == segment) {
      entries_.pop_front();
      ++dropped_;
    }
  }
}

Status KeyframeLog::append(map::RobotId robot, std::uint64_t session, std::span<const std::byte> keyframe) {
  if (keyframe.size() > kMaxRecord_bytes - kPayloadHeader_bytes)
    return fail(Errc::kInvalidArgument, "a keyframe too large for the log");
  if (segments_.back().second >= config_.segment_bytes)
    EDGESPLAT_TRY_STATUS(begin_segment(segments_.back().first + 1));
  ByteWriter payload;
  payload.write(robot.value);
  payload.write(session);
  payload.write_bytes(keyframe);
  const auto path = path_of(segments_.back().first);
  const std::uint64_t start = segments_.back().second;
  Status written = io::write_all(fd_.get(), record_header(kKeyframeRecord, payload.bytes()), path);
  if (written) written = io::write_all(fd_.get(), payload.bytes(), path);
  if (written && ::fdatasync(fd_.get()) != 0) written = fail_io("cannot sync", path, errno);
  if (!written) {  // whatever of it is there goes again; at worst the next start cuts it off
    (void)::ftruncate(fd_.get(), static_cast<off_t>(start));
    (void)::lseek(fd_.get(), static_cast<off_t>(start), SEEK_SET);
    return written;
  }
  const std::uint64_t record_bytes = kRecordHeader_bytes + payload.size();
  entries_.push_back(
      {segments_.back().first, start + kRecordHeader_bytes, static_cast<std::uint32_t>(payload.size())});
  segments_.back().second += record_bytes;
  bytes_ += record_bytes;
  drop_oldest_segments();
  return {};
}

Result<LoggedKeyframe> KeyframeLog::read(std::size_t index) const {
  if (index >= entries_.size()) return fail(Errc::kNotFound, "no such keyframe in the log");
  const Entry& entry = entries_[index];
  const auto path = path_of(entry.segment);
  const UniqueFd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!fd.valid()) return fail_io("cannot open", path, errno);
  std::vector<std::byte> bytes(kRecordHeader_bytes + entry.length);
  const auto from = static_cast<off_t>(entry.offset - kRecordHeader_bytes);
  for (std::size_t got = 0; got < bytes.size();) {
    const ssize_t part =
        ::pread(fd.get(), bytes.data() + got, bytes.size() - got, from + static_cast<off_t>(got));
    if (part < 0 && errno == EINTR) continue;
    if (part <= 0) return fail_io("cannot read", path, part < 0 ? errno : EIO);
    got += static_cast<std::size_t>(part);
  }
  RecordReader records(bytes, 0);
  const auto record = records.next();
  if (!record || record->payload.size() != entry.length)
    return fail(Errc::kCorrupt, "a keyframe in " + path.string() + " was damaged since it was written");
  return from_payload(record->payload);
}

Result<std::vector<LoggedKeyframe>> read_newest_keyframes(const std::filesystem::path& folder) {
  constexpr std::size_t kSegments = 2;
  std::vector<LoggedKeyframe> keyframes;
  std::error_code error;
  if (!std::filesystem::exists(folder, error)) return keyframes;
  EDGESPLAT_TRY(const auto numbers, segments_in(folder));
  for (std::size_t i = numbers.size() - std::min(kSegments, numbers.size()); i < numbers.size(); ++i) {
    EDGESPLAT_TRY(const auto bytes, io::read_file(segment_path(folder, numbers[i]), kMaxSegment_bytes));
    RecordReader records(bytes, 0);
    while (const auto record = records.next()) {
      if (is_keyframe(*record)) keyframes.push_back(from_payload(record->payload));
    }
  }
  return keyframes;
}

}  // namespace edgesplat::store
