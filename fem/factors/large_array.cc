#include "fem/factors/large_array.h"

#include <sys/mman.h>

#include <new>

namespace vibrissa::fem {

LargeArray::LargeArray(const std::size_t size) : size_(size) {
  constexpr std::size_t line = 64, page = std::size_t{1} << 21;
  const std::size_t bytes = size * sizeof(double);
  const std::size_t unit = bytes < page ? line : page;
  data_.reset(static_cast<double*>(std::aligned_alloc(unit, (bytes / unit + 1) * unit)));
  if (!data_) throw std::bad_alloc();
  // Advice: it does no harm where it is not taken.
  if (unit == page) madvise(data_.get(), (bytes / unit + 1) * unit, MADV_HUGEPAGE);
}

}  // namespace vibrissa::fem
