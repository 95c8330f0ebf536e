#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace vibrissa::fem {

/// Uninitialised numbers, aligned to a cache line, in large pages if the system has them: the first
/// access to a small page takes longer than the work on it. Throws std::bad_alloc.
class LargeArray {
 public:
  LargeArray() = default;
  explicit LargeArray(std::size_t size);
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  std::size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(double* data) const { std::free(data); }
  };
  std::unique_ptr<double[], Free> data_;
  std::size_t size_ = 0;
};

}  // namespace vibrissa::fem
