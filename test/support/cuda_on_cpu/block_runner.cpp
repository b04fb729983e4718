// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/cuda_on_cpu/block_runner.hpp"

// longjmp between stacks is what this file is about; the fortified one refuses it.
#undef _FORTIFY_SOURCE
#include <setjmp.h>
#include <ucontext.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

namespace edgesplat::test {
namespace {

constexpr unsigned kLanes = 32;
constexpr std::size_t kStackBytes = std::size_t{128} << 10U;

enum class State { kReady, kAtBarrier, kAtExchange, kDone };

/// One thread of the block: a stack of its own that is used again for block after block.
struct Fiber {
  std::unique_ptr<unsigned char[]> stack;
  ucontext_t start{};
  jmp_buf place{};
  bool begun = false;
  State state = State::kDone;
  unsigned mask = 0;  ///< of the exchange it waits at
  std::uint64_t given = 0;
};

struct Warp {
  std::array<std::uint64_t, kLanes> exchanged{};
};

[[noreturn]] void stop(const char* why, unsigned thread) {
  std::fprintf(stderr, "cuda_on_cpu: %s (block %u, thread %u)\n", why, blockIdx.x, thread);
  std::abort();
}

class Runner {
 public:
  void run(unsigned blocks, unsigned threads, const std::function<void()>& kernel) {
    threads_ = threads;
    blockDim.x = threads;
    gridDim.x = blocks;
    kernel_ = &kernel;
    warps_.resize(threads / kLanes);
    for (blockIdx.x = 0; blockIdx.x < blocks; ++blockIdx.x) run_block();
  }

  unsigned wait_at_barrier(bool counts) {
    counting_ += counts ? 1U : 0U;
    leave(State::kAtBarrier);
    return counted_;
  }
  const std::array<std::uint64_t, kLanes>& exchange(unsigned mask, std::uint64_t value) {
    Fiber& fiber = fibers_[threadIdx.x];
    if ((mask >> threadIdx.x % kLanes & 1U) == 0)
      stop("a lane outside the mask of its exchange", threadIdx.x);
    fiber.mask = mask;
    fiber.given = value;
    leave(State::kAtExchange);
    return warps_[threadIdx.x / kLanes].exchanged;
  }
  void seed(std::uint64_t value) { random_ = value; }

  /// What every fiber does, for ever: the kernel, once each time it is called.
  void live() {
    for (;;) {
      (*kernel_)();
      leave(State::kDone);
    }
  }

 private:
  void run_block() {
    for (unsigned t = 0; t < threads_; ++t) fibers_[t].state = State::kReady;
    std::vector<unsigned> order(threads_ / kLanes);
    std::iota(order.begin(), order.end(), 0U);
    for (;;) {
      shuffle(order);
      for (const unsigned warp : order) run_warp(warp);
      if (!pass_barrier()) return;
    }
  }

  /// Until each of its lanes is at the barrier or done.
  void run_warp(unsigned warp) {
    do {
      const unsigned first = below(kLanes);
      for (unsigned i = 0; i < kLanes; ++i) {
        const unsigned t = warp * kLanes + (first + i) % kLanes;
        if (fibers_[t].state == State::kReady) enter(t);
      }
    } while (pass_exchange(warp));
  }

  /// Lets go the lanes whose whole mask has come. False where no lane waits for an exchange.
  bool pass_exchange(unsigned warp) {
    Fiber* const lanes = &fibers_[warp * kLanes];
    bool waiting = false;
    for (unsigned lane = 0; lane < kLanes; ++lane) {
      if (lanes[lane].state != State::kAtExchange) continue;
      waiting = true;
      const unsigned mask = lanes[lane].mask;
      unsigned come = 0;
      for (unsigned l = 0; l < kLanes; ++l) {
        if (lanes[l].state == State::kAtExchange && lanes[l].mask == mask) come |= 1U << l;
      }
      if (come != mask) continue;
      for (unsigned l = 0; l < kLanes; ++l) {
        if ((mask >> l & 1U) == 0) continue;
        warps_[warp].exchanged[l] = lanes[l].given;
        lanes[l].state = State::kReady;
      }
      return true;
    }
    if (waiting) stop("a warp waits for lanes that do not come to the exchange", warp * kLanes);
    return false;
  }

  /// False when all threads are done.
  bool pass_barrier() {
    const auto count = [this](State state) {
      return std::count_if(fibers_.begin(), fibers_.begin() + threads_,
                           [state](const Fiber& fiber) { return fiber.state == state; });
    };
    const auto waiting = count(State::kAtBarrier);
    if (waiting == 0) return false;
    if (waiting != static_cast<std::ptrdiff_t>(threads_)) stop("a barrier that not all threads reach", 0);
    counted_ = std::exchange(counting_, 0);
    for (unsigned t = 0; t < threads_; ++t) fibers_[t].state = State::kReady;
    return true;
  }

  void enter(unsigned t);
  void leave(State state);

  unsigned below(unsigned count) {
    random_ = random_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<unsigned>(random_ >> 33U) % count;
  }
  void shuffle(std::vector<unsigned>& order) {
    for (unsigned i = static_cast<unsigned>(order.size()); i > 1; --i)
      std::swap(order[i - 1], order[below(i)]);
  }

  unsigned threads_ = 0;
  unsigned counting_ = 0, counted_ = 0;
  const std::function<void()>* kernel_ = nullptr;
  std::vector<Fiber> fibers_{1024};  ///< a block's most; they stay where they are
  std::vector<Warp> warps_;
  std::uint64_t random_ = 1;
  jmp_buf scheduler_{};
};

Runner& runner() {
  static Runner instance;
  return instance;
}

void fiber_main() {
  runner().live();
}

void Runner::enter(unsigned t) {
  threadIdx.x = t;
  Fiber& fiber = fibers_[t];
  if (_setjmp(scheduler_) != 0) return;
  if (fiber.begun) _longjmp(fiber.place, 1);
  fiber.begun = true;
  fiber.stack = std::make_unique<unsigned char[]>(kStackBytes);
  getcontext(&fiber.start);
  fiber.start.uc_stack.ss_sp = fiber.stack.get();
  fiber.start.uc_stack.ss_size = kStackBytes;
  makecontext(&fiber.start, fiber_main, 0);
  setcontext(&fiber.start);
}

void Runner::leave(State state) {
  Fiber& fiber = fibers_[threadIdx.x];
  fiber.state = state;
  if (_setjmp(fiber.place) == 0) _longjmp(scheduler_, 1);
}

std::mutex one_launch;

}  // namespace

void run_blocks(unsigned blocks, unsigned threads, const std::function<void()>& kernel) {
  const std::lock_guard lock(one_launch);
  runner().run(blocks, threads, kernel);
}
void set_order_seed(std::uint64_t seed) {
  runner().seed(seed);
}
unsigned block_barrier(bool counts) {
  return runner().wait_at_barrier(counts);
}
const std::array<std::uint64_t, 32>& warp_exchange(unsigned mask, std::uint64_t value) {
  return runner().exchange(mask, value);
}

}  // namespace edgesplat::test
