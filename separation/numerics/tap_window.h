#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace vibrissa::separation {

/// The last n samples, contiguous and the newest first, for filters that work sample by sample.
class TapWindow {
 public:
  explicit TapWindow(std::size_t n) : n_(static_cast<Eigen::Index>(n)), buffer_(2 * n_ + 256) {
    clear();
  }

  void clear() {
    buffer_.setZero();
    first_ = buffer_.size() - n_;
  }
  void push(double x) {
    if (first_ == 0) {
      first_ = buffer_.size() - n_;
      buffer_.tail(n_) = buffer_.head(n_);
    }
    buffer_[--first_] = x;
  }
  auto samples() const { return buffer_.segment(first_, n_); }

 private:
  Eigen::Index n_;
  Eigen::VectorXd buffer_;  // aligned, so that sums round equally in every object
  Eigen::Index first_ = 0;
};

}  // namespace vibrissa::separation
