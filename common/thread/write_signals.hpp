// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace edgesplat::thread {

/// For main(): a file that may not grow further (RLIMIT_FSIZE) and a pipe or socket whose reader is gone
/// become errors of the write (EFBIG, EPIPE), where they would end the process. The setting is the process's.
void make_write_signals_errors();

}  // namespace edgesplat::thread
