// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#ifdef __SANITIZE_THREAD__
#define EDGESPLAT_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define EDGESPLAT_THREAD_SANITIZER 1
#endif
#endif
#ifdef EDGESPLAT_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace edgesplat::thread {

/// What a parallel loop orders: all before the fork comes before every body, every body before the join. The
/// TBB of a distribution is not built for ThreadSanitizer, which therefore sees neither; in that build this
/// tells it, so that it looks for races between the bodies and takes none of the loop's own work for one.
/// Nothing in any other build.
class ForkJoin {
 public:
#ifdef EDGESPLAT_THREAD_SANITIZER
  ForkJoin() {
    __tsan_release(&fork_);
  }
  ForkJoin(const ForkJoin&) = delete;
  ForkJoin& operator=(const ForkJoin&) = delete;
  ~ForkJoin() {
    __tsan_acquire(&join_);
  }
  template <typename Body>
  void run(const Body& body) const {
    __tsan_acquire(&fork_);
    body();
    __tsan_release(&join_);
  }

 private:
  mutable char fork_ = 0;
  mutable char join_ = 0;
#else
  template <typename Body>
  void run(const Body& body) const {
    body();
  }
#endif
};

/// Runs body(i) for every i in [first, last) on the threads of the caller's arena, in any order, and returns
/// when all have. Bodies share nothing they write. To get the same bits for any number of threads, keep
/// results by i and sum them in order afterwards.
template <typename Index, typename Body>
void parallel_for(Index first, Index last, const Body& body) {
  const ForkJoin order;
  tbb::parallel_for(first, last, [&](Index i) { order.run([&] { body(i); }); });
}

/// Runs every body once, side by side, and returns when all have.
template <typename... Bodies>
void parallel_invoke(const Bodies&... bodies) {
  const ForkJoin order;
  tbb::parallel_invoke([&order, &bodies] { order.run(bodies); }...);
}

}  // namespace edgesplat::thread
