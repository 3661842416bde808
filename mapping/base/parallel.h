#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace gonio {

/// Calls function(k) for k = 0 ... count - 1 on all cores, each k once, in no fixed order. The first
/// exception is rethrown after all threads have stopped; the remaining k are then skipped.
/// (Threads of the standard library: a renderer that links gonio::brdf needs no thread pool package.)
template <class Function>
void parallel_for(std::size_t count, const Function& function) {
  const std::size_t threads = std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), count);
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t k; (k = next++) < count;) {
      try {
        function(k);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> pool;
  for (std::size_t t = 1; t < threads; ++t) pool.emplace_back(work);
  work();
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace gonio
