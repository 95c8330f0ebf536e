#pragma once

#include <cstddef>
#include <functional>

namespace vibrissa::diagnosis {

/// Calls work(0) .. work(n - 1) on up to n_threads threads; rethrows the first exception.
void for_each_parallel(std::size_t n, std::size_t n_threads,
                       const std::function<void(std::size_t)>& work);

}  // namespace vibrissa::diagnosis
