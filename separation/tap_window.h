#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace vibrissa::separation {

/// The last n samples, the newest first and in one piece, for filters that work sample by sample.
class TapWindow {
 public:
  explicit TapWindow(std::size_t n) : n_(n), buffer_(2 * n + 256, 0.) { clear(); }

  void clear() {
    std::fill(buffer_.begin(), buffer_.end(), 0.);
    first_ = buffer_.size() - n_;
  }
  void push(double x) {
    if (first_ == 0) {
      first_ = buffer_.size() - n_;
      std::copy_n(buffer_.begin(), n_, buffer_.begin() + static_cast<std::ptrdiff_t>(first_));
    }
    buffer_[--first_] = x;
  }
  Eigen::Map<const Eigen::VectorXd> samples() const {
    return {buffer_.data() + first_, static_cast<Eigen::Index>(n_)};
  }

 private:
  std::size_t n_;
  std::vector<double> buffer_;
  std::size_t first_ = 0;
};

}  // namespace vibrissa::separation
