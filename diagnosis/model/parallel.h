#pragma once

#include <cstddef>
#include <functional>

namespace vibrissa::diagnosis {

/// Number of threads that work on this thread may use: 1 unless AvailableThreads says otherwise.
std::size_t available_threads();

/// Sets this number while it lives. Proven by tests/diagnosis/model/parallel_test.cc.
class AvailableThreads {
 public:
  explicit AvailableThreads(std::size_t n);
  ~AvailableThreads();
  AvailableThreads(const AvailableThreads&) = delete;
  AvailableThreads& operator=(const AvailableThreads&) = delete;

 private:
  std::size_t before_;
};

/// Calls work(0) .. work(n - 1) on up to n_threads threads; rethrows the first exception. Where
/// there are several, each has itself alone as available thread.
void for_each_parallel(std::size_t n, std::size_t n_threads,
                       const std::function<void(std::size_t)>& work);

}  // namespace vibrissa::diagnosis
