#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>

namespace vibrissa::fem {

/// Numbers that are not set, at the beginning of a cache line, in large pages where the system has
/// them: a page is asked for at its first touch, which takes longer than the work on a small one.
/// Throws std::bad_alloc.
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
