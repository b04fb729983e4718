// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tl/expected.hpp>

#include <source_location>
#include <string>
#include <string_view>
#include <utility>

namespace edgesplat {

/// What kind of thing went wrong; callers switch on this, never on the text.
enum class Errc {
  kInvalidArgument,  ///< the caller broke a documented precondition with data from outside
  kInvalidConfig,    ///< a configuration file or command-line setting is wrong (exit code 2)
  kNotFound,         ///< a file, device, key or record does not exist
  kIo,               ///< the operating system refused: open, read, write, disk full, socket
  kTimeout,          ///< nothing arrived in time
  kBadPacket,        ///< bytes from a device that fail their checks
  kOutOfVram,        ///< the GPU memory budget is used up
  kUnavailable,      ///< a device, backend or peer is not there at present
  kCorrupt,          ///< a file or message fails its checks
};

/// Short stable name of an error code, for logs and JSON ("io", "bad_packet").
[[nodiscard]] std::string_view to_string(Errc code);

/// An error value: a code for programs, a sentence for people (what, why, what to do) and where it arose.
struct Error {
  Errc code;
  std::string context;
  std::source_location where = std::source_location::current();
};

/// Every function that can fail in the field returns this; std::expected once the floor is C++23. Use only
/// and_then, value, error and has_value, so that the switch is an alias change.
template <typename T>
using Result = tl::expected<T, Error>;
using Status = Result<void>;

/// `return fail(Errc::kIo, "cannot open " + path);`
[[nodiscard]] inline tl::unexpected<Error> fail(
    Errc code, std::string context, std::source_location where = std::source_location::current()) {
  return tl::unexpected<Error>(Error{code, std::move(context), where});
}

/// Exit code of a program that ends with this error: 2 for configuration and usage, else 1.
[[nodiscard]] inline int exit_code(const Error& error) {
  return error.code == Errc::kInvalidConfig ? 2 : 1;
}

}  // namespace edgesplat

#define EDGESPLAT_CONCAT_INNER(a, b) a##b
#define EDGESPLAT_CONCAT(a, b) EDGESPLAT_CONCAT_INNER(a, b)
#define EDGESPLAT_TRY_IMPL(tmp, decl, expr)                                      \
  auto tmp = (expr);                                                             \
  if (!tmp) return ::tl::unexpected<::edgesplat::Error>(std::move(tmp).error()); \
  decl = *std::move(tmp)
/// `EDGESPLAT_TRY(const Packet packet, decode(bytes));` unwraps a Result or returns its error.
#define EDGESPLAT_TRY(decl, expr) EDGESPLAT_TRY_IMPL(EDGESPLAT_CONCAT(edgesplat_try_, __LINE__), decl, expr)
/// `EDGESPLAT_TRY_STATUS(file.flush());` returns the error of a Status, if there is one.
#define EDGESPLAT_TRY_STATUS(expr)                                                                           \
  do {                                                                                                       \
    auto edgesplat_status = (expr);                                                                          \
    if (!edgesplat_status) return ::tl::unexpected<::edgesplat::Error>(std::move(edgesplat_status).error()); \
  } while (false)
