// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The TBB of a distribution is not built for ThreadSanitizer, which sees neither how its loops fork nor how
// they join and takes every one for a race. In that build loops run on plain threads, so that races between
// bodies are found.
#ifdef __SANITIZE_THREAD__
#define EDGESPLAT_PLAIN_THREADS 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define EDGESPLAT_PLAIN_THREADS 1
#endif
#endif

#ifdef EDGESPLAT_PLAIN_THREADS
#include <atomic>
#include <functional>
#include <thread>
#else
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#endif

namespace edgesplat::thread {

#ifdef EDGESPLAT_PLAIN_THREADS

template <typename Index, typename Body>
void parallel_for(Index first, Index last, const Body& body) {
  std::atomic<Index> next = first;
  const auto work = [&] {
    // Relaxed: the counter must not order the bodies.
    for (Index i = next.fetch_add(1, std::memory_order_relaxed); i < last;
         i = next.fetch_add(1, std::memory_order_relaxed))
      body(i);
  };
  if (last <= first) return;
  const std::jthread other(work);
  work();
}

template <typename... Bodies>
void parallel_invoke(const Bodies&... bodies) {
  const std::jthread others[] = {std::jthread(std::cref(bodies))...};
}

#else

/// Runs body(i) for every i in [first, last) on the threads of the caller's arena, in any order, and returns
/// when all have. Bodies share nothing they write. To get the same bits for any number of threads, keep
/// results by i and sum them in order afterwards.
template <typename Index, typename Body>
void parallel_for(Index first, Index last, const Body& body) {
  tbb::parallel_for(first, last, body);
}

/// Runs every body once, side by side, and returns when all have.
template <typename... Bodies>
void parallel_invoke(const Bodies&... bodies) {
  tbb::parallel_invoke(bodies...);
}

#endif

}  // namespace edgesplat::thread
