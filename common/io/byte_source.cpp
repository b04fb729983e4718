// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace edgesplat::io {
namespace {

class FileSource final : public ByteSource {
 public:
  FileSource(UniqueFd fd, std::uint64_t size) : fd_(std::move(fd)), size_bytes_(size) {}
  [[nodiscard]] std::uint64_t size_bytes() const override { return size_bytes_; }
  [[nodiscard]] Status read(std::uint64_t offset, std::span<std::byte> into) const override {
    EDGESPLAT_TRY_STATUS(check_range(offset, into.size()));
    while (!into.empty()) {
      const ssize_t got = ::pread(fd_.get(), into.data(), into.size(), static_cast<off_t>(offset));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return fail(Errc::kIo, "cannot read: " + std::generic_category().message(errno));
      if (got == 0) return fail(Errc::kIo, "the file became shorter while it was read");
      into = into.subspan(static_cast<std::size_t>(got));
      offset += static_cast<std::uint64_t>(got);
    }
    return {};
  }

 private:
  UniqueFd fd_;
  std::uint64_t size_bytes_;
};

class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::span<const std::byte> bytes) : bytes_(bytes) {}
  [[nodiscard]] std::uint64_t size_bytes() const override { return bytes_.size(); }
  [[nodiscard]] Status read(std::uint64_t offset, std::span<std::byte> into) const override {
    EDGESPLAT_TRY_STATUS(check_range(offset, into.size()));
    if (!into.empty()) std::memcpy(into.data(), bytes_.data() + offset, into.size());
    return {};
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace

Status ByteSource::check_range(std::uint64_t offset, std::uint64_t length) const {
  if (offset > size_bytes() || length > size_bytes() - offset) {
    return fail(Errc::kCorrupt, "bytes " + std::to_string(offset) + " + " + std::to_string(length) +
                                    " lie beyond the end of the file");
  }
  return {};
}

Result<std::vector<std::byte>> ByteSource::read(std::uint64_t offset, std::uint64_t length) const {
  EDGESPLAT_TRY_STATUS(check_range(offset, length));
  std::vector<std::byte> bytes(static_cast<std::size_t>(length));
  EDGESPLAT_TRY_STATUS(read(offset, std::span(bytes)));
  return bytes;
}

Result<std::unique_ptr<ByteSource>> open_byte_source(const std::filesystem::path& path) {
  UniqueFd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!fd.valid()) {
    const int reason = errno;
    return fail(reason == ENOENT ? Errc::kNotFound : Errc::kIo,
                "cannot open " + path.string() + ": " + std::generic_category().message(reason));
  }
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return fail(Errc::kIo, path.string() + " is not a regular file");
  }
  return std::make_unique<FileSource>(std::move(fd), static_cast<std::uint64_t>(status.st_size));
}

std::unique_ptr<ByteSource> make_byte_source(std::span<const std::byte> bytes) {
  return std::make_unique<MemorySource>(bytes);
}

}  // namespace edgesplat::io
