#include "separation/block_separator.h"

#include <algorithm>
#include <cassert>

#include "signals/error.h"

namespace vibrissa::separation {

namespace {

std::size_t checked_length(std::size_t block_length) {
  if (block_length == 0) throw signals::UserError("separation: block_length must be at least 1");
  return block_length;
}

}  // namespace

BlockSeparator::BlockSeparator(std::size_t block_length)
    : acceleration_(checked_length(block_length), 0.),
      moment_(block_length, 0.),
      wind_(block_length, 0.) {}

void BlockSeparator::process(std::span<const double> base_acceleration,
                             std::span<const double> base_moment, std::span<double> wind_moment) {
  assert(base_acceleration.size() == wind_moment.size());
  assert(base_moment.size() == wind_moment.size());
  // wind_ holds the results of the last block; place i is given out when place i - 1 of the next
  // block has arrived, place 0 at once.
  const std::size_t length = block_length();
  std::size_t done = 0;
  while (done < wind_moment.size()) {
    const std::size_t n = std::min(length - filled_, wind_moment.size() - done);
    std::ranges::copy(base_acceleration.subspan(done, n), acceleration_.begin() + filled_);
    std::ranges::copy(base_moment.subspan(done, n), moment_.begin() + filled_);
    const bool full = filled_ + n == length;
    const std::size_t n_old = full ? n - 1 : n;
    std::copy_n(wind_.begin() + static_cast<std::ptrdiff_t>(filled_) + 1, n_old,
                wind_moment.begin() + static_cast<std::ptrdiff_t>(done));
    filled_ += n;
    done += n;
    if (!full) continue;
    process_block(acceleration_, moment_, wind_);
    wind_moment[done - 1] = wind_[0];
    filled_ = 0;
  }
}

void BlockSeparator::reset() {
  std::ranges::fill(acceleration_, 0.);
  std::ranges::fill(moment_, 0.);
  std::ranges::fill(wind_, 0.);
  filled_ = 0;
  reset_blocks();
}

}  // namespace vibrissa::separation
