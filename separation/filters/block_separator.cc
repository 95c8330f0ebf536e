#include "separation/filters/block_separator.h"

#include <algorithm>
#include <cassert>

#include "signals/base/error.h"

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
      wind_(block_length, 0.),
      next_wind_(block_length, 0.) {}

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
    auto acceleration = base_acceleration.subspan(done, n);
    auto moment = base_moment.subspan(done, n);
    const auto late = std::span(wind_).subspan(filled_ + 1);
    if (n < length) {
      std::ranges::copy(acceleration, acceleration_.begin() + filled_);
      std::ranges::copy(moment, moment_.begin() + filled_);
      acceleration = acceleration_;
      moment = moment_;
    }
    filled_ += n;
    // The inputs are read before anything is given out: wind_moment may be one of them.
    const bool full = filled_ == length;
    if (full) process_block(acceleration, moment, next_wind_);
    std::ranges::copy(late.first(full ? n - 1 : n), wind_moment.subspan(done).begin());
    done += n;
    if (!full) continue;
    wind_moment[done - 1] = next_wind_[0];
    std::swap(wind_, next_wind_);
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
