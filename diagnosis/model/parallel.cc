#include "diagnosis/model/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace vibrissa::diagnosis {
namespace {

thread_local std::size_t n_available = 1;

}  // namespace

std::size_t available_threads() {
  return n_available;
}

AvailableThreads::AvailableThreads(const std::size_t n) : before_(n_available) {
  n_available = n;
}

AvailableThreads::~AvailableThreads() {
  n_available = before_;
}

void for_each_parallel(const std::size_t n, const std::size_t n_threads,
                       const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const std::size_t n_used = std::min(n_threads, n);
  const auto run = [&] {
    const AvailableThreads alone(n_used > 1 ? 1 : n_available);
    for (std::size_t i = next++; i < n; i = next++) try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
      }
  };
  std::vector<std::thread> threads;
  for (std::size_t t = 1; t < n_used; ++t) threads.emplace_back(run);
  run();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace vibrissa::diagnosis
