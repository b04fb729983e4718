// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

namespace edgesplat::io {
namespace {

std::string system_reason(int error_number) {
  std::string reason = std::generic_category().message(error_number);
  if (error_number == ENOSPC || error_number == EDQUOT) reason += " (free some space or write elsewhere)";
  return reason;
}

tl::unexpected<Error> fail_io(std::string_view what, const std::filesystem::path& path, int error_number) {
  return fail(Errc::kIo, std::string(what) + " " + path.string() + ": " + system_reason(error_number));
}

std::filesystem::path temporary_neighbour(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter{0};  // two writers of one path in one program must not share a file
  return path.string() + ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(counter.fetch_add(1));
}

Status sync_folder_of(const std::filesystem::path& path) {
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const UniqueFd fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!fd.valid()) return fail_io("cannot open the folder", folder, errno);
  // Some file systems (FUSE, 9p) cannot sync a folder and say EINVAL: the rename itself has happened.
  if (::fsync(fd.get()) != 0 && errno != EINVAL) return fail_io("cannot sync the folder", folder, errno);
  return {};
}

template <typename Container>
Result<Container> read_whole(const std::filesystem::path& path, std::uint64_t max_bytes) {
  const UniqueFd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!fd.valid()) {
    if (errno == ENOENT) return fail(Errc::kNotFound, "no file " + path.string());
    return fail_io("cannot open", path, errno);
  }
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) return fail_io("cannot examine", path, errno);
  if (S_ISDIR(status.st_mode)) return fail(Errc::kIo, path.string() + " is a folder, not a file");
  constexpr std::size_t kStep_bytes = std::size_t{1} << 16U;  // of a pipe, whose size nobody knows
  const auto known_bytes = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
  Container content;
  std::size_t filled_bytes = 0;
  if (known_bytes <= max_bytes) content.resize(static_cast<std::size_t>(known_bytes) + 1);
  while (known_bytes <= max_bytes && filled_bytes <= max_bytes) {
    if (filled_bytes == content.size()) content.resize(filled_bytes + kStep_bytes);
    const ssize_t got = ::read(fd.get(), content.data() + filled_bytes, content.size() - filled_bytes);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail_io("cannot read", path, errno);
    if (got == 0) {
      content.resize(filled_bytes);
      return content;
    }
    filled_bytes += static_cast<std::size_t>(got);
  }
  return fail(Errc::kInvalidArgument,
              path.string() + " is larger than the " + std::to_string(max_bytes) + " bytes accepted here");
}

}  // namespace

Status write_all(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return fail_io("cannot write", path, errno);
    if (written == 0) return fail_io("cannot write", path, ENOSPC);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

AtomicFile::AtomicFile(std::filesystem::path path, std::filesystem::path temporary, UniqueFd fd)
    : path_(std::move(path)), temporary_(std::move(temporary)), fd_(std::move(fd)) {}

AtomicFile::~AtomicFile() {
  if (fd_.valid()) ::unlink(temporary_.c_str());
}

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& path) {
  auto temporary = temporary_neighbour(path);
  UniqueFd fd(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (!fd.valid()) return fail_io("cannot create", temporary, errno);
  return AtomicFile(path, std::move(temporary), std::move(fd));
}

Status AtomicFile::append(std::span<const std::byte> bytes) {
  return write_all(fd_.get(), bytes, path_);
}

Status AtomicFile::commit() {
  if (::fsync(fd_.get()) != 0) return fail_io("cannot sync", path_, errno);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) return fail_io("cannot rename to", path_, errno);
  fd_.reset();
  return sync_folder_of(path_);
}

Status write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  EDGESPLAT_TRY(AtomicFile file, AtomicFile::create(path));
  EDGESPLAT_TRY_STATUS(file.append(bytes));
  return file.commit();
}

Status write_file_atomically(const std::filesystem::path& path, std::string_view text) {
  return write_file_atomically(path, std::as_bytes(std::span<const char>(text.data(), text.size())));
}

Result<std::vector<std::byte>> read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  return read_whole<std::vector<std::byte>>(path, max_bytes);
}

Result<std::string> read_text_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  return read_whole<std::string>(path, max_bytes);
}

}  // namespace edgesplat::io
