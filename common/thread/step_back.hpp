// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace edgesplat::thread {

/// For the thread that calls it, and for good: where cores are scarce, threads of normal priority go first
/// (nice +5, a third of their weight). Threads it starts later inherit that. Linux only counts
/// niceness by thread.
void step_back();

}  // namespace edgesplat::thread
